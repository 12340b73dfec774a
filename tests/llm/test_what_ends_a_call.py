"""Calls that end otherwise than by an answer: plugins that end the process, answers without a text."""

import json

import pytest

LOOSE = """
import sys, time
from proc3s import LLM, LLMSpec, Candidate, Completion, hookimpl

class Quitter(LLM):
    def __init__(self, path, options):
        if path == "made":
            sys.exit(0)
        self.where = path

    def prepare(self):
        if self.where == "prepared":
            sys.exit(0)

    @property
    def price(self):
        return sys.exit(0)

    def complete(self, request):
        if self.where == "first" or request.candidate:
            {what}
        time.sleep(0.05)
        return Completion(candidates=(Candidate(text=TEXT),), model="quitter")

TEXT = {text!r}

@hookimpl
def register_llms(register):
    register(LLMSpec(name="quitter", summary="", usage="", target="quitter:Quitter"))
"""


@pytest.fixture
def quitter(here, texts):
    """`--llm` and `--plugin` of a backend that ends the process, there and by these words."""

    def write(where, what="sys.exit(0)"):
        (here / "quitter.py").write_text(LOOSE.format(what=what, text=texts.star))
        return ("--llm", f"quitter:{where}", "--plugin", "quitter.py")

    return write


ENDS = ["sys.exit(0)", "sys.exit()", "raise GeneratorExit", "raise BaseException('done')", "1 / 0"]


@pytest.mark.parametrize("what", ENDS)
def test_a_backend_does_not_end_the_process(cli, quitter, what):
    result = cli("run", "drawing/star", *quitter("first", what), "--json")
    assert (result.code, result.json["stopped"]) == (3, "llm")
    assert "llm quitter:first" in result.json["error"]
    assert "quitter.py:" in result.json["error"]


@pytest.mark.slow
@pytest.mark.parametrize("jobs", [1, 3])
@pytest.mark.parametrize("what", ENDS)
def test_nor_a_thread_that_somebody_waits_for(cli, quitter, what, jobs):
    args = ("--candidates", 4, "--llm-jobs", jobs)
    result = cli("run", "drawing/star", *quitter("later", what), *args)
    assert result.code == 0
    assert result.stderr.count("is missing: ") == 3
    assert "llm quitter:later" in result.stderr


def test_ctrl_c_in_a_thread_ends_the_run(cli, quitter):
    args = ("--candidates", 2, "--json")
    result = cli("run", "drawing/star", *quitter("later", "raise KeyboardInterrupt"), *args)
    assert (result.code, result.json["stopped"]) == (130, "interrupted")


@pytest.mark.parametrize(("where", "code"), [("made", 2), ("prepared", 3)])
def test_nor_does_it_while_it_is_made(cli, quitter, here, where, code):
    result = cli("run", "drawing/star", *quitter(where), "--out", "r", "--json")
    assert result.code == code
    assert "quitter" in result.json["error"]
    assert not (here / "r").exists()


def test_nor_when_it_is_asked_for_its_price(cli, quitter):
    result = cli("run", "drawing/star", *quitter("later"), "--max-cost", 1, "--json")
    assert result.code == 2
    assert "quitter" in result.json["error"]


USAGE = {"prompt_tokens": 1000, "completion_tokens": 500}
NOTHING = [
    {"texts": []},
    {"texts": [""]},
    {"texts": [""], "finish": "content_filter"},
    {"texts": ["def gen_plan(initial):"], "finish": "content_filter"},
    {"texts": [""], "finish": "tool_calls"},
]


@pytest.mark.parametrize("entry", NOTHING, ids=json.dumps)
def test_an_answer_without_a_text_has_cost_what_it_cost(cli, script, texts, entry, monkeypatch):
    monkeypatch.setattr("tenacity.nap.time.sleep", lambda seconds: None)
    usage = {"usage": USAGE, "cost": 0.25}
    result = cli(
        "run", "drawing/star", *script({**entry, **usage}, {"texts": [texts.star], **usage}), "--json"
    )
    spent = result.json["usage"]
    calls = spent["calls"]
    assert (spent["prompt_tokens"], spent["completion_tokens"]) == (1000 * calls, 500 * calls)
    assert spent["cost"] == 0.25 * calls
    assert calls == (2 if result.code == 0 else 1)


@pytest.mark.parametrize("finish", ["content_filter", "tool_calls", "function_call"])
def test_what_will_not_pass_is_named_and_not_tried_again(cli, script, texts, asked, finish):
    entry = {"texts": ["def gen_plan(initial):" if finish == "content_filter" else ""], "finish": finish}
    result = cli("run", "drawing/star", *script(entry, texts.star), "--json")
    assert (result.code, len(asked())) == (3, 1)
    assert ("filter" if finish == "content_filter" else "tool") in result.json["error"]


@pytest.mark.parametrize("kind", ["timeout", "broken", "empty", "filtered", "other"])
def test_what_a_failed_call_cost_is_unknown_and_not_nothing(cli, script, texts, kind):
    fault = {"fault": kind, "message": "no", "retry_after": 0.01}
    result = cli("run", "drawing/star", *script(fault, {"texts": [texts.star], "cost": 0.5}), "--json")
    assert result.json["usage"]["cost"] is None
    assert result.json["usage"]["prompt_tokens"] is None


def test_an_unknown_price_is_nowhere_nothing(cli, script, texts, events, here):
    result = cli("run", "drawing/star", *script({"texts": [texts.star], "usage": USAGE}), "--out", "r")
    assert "cost unknown" in result.stdout
    assert events(here / "r", "charged")[-1]["ledger"]["cost"] is None
    assert events(here / "r", "run_ended")[0]["summary"]["usage"]["cost"] is None


def test_a_limit_in_dollars_after_calls_of_unknown_price_is_refused(cli, script, texts):
    fault = {"fault": "auth", "message": "no"}
    args = script({"texts": [texts.outside], "usage": USAGE}, fault, texts.star)
    assert cli("run", "drawing/star", *args, "--samples", 20, "--out", "r").code == 3
    price = ("-L", "prompt_price=1", "-L", "completion_price=1", "--max-cost", 1)
    result = cli("run", "--resume", "r", *price, "--json")
    assert result.code == 2
    assert "nobody knows what the calls so far have cost" in result.json["error"]


def test_what_is_prepared_is_no_second_of_the_model(cli, here, texts):
    (here / "slow.py").write_text(
        "import time\n"
        "from proc3s import LLM, LLMSpec, answer, hookimpl\n"
        "class Slow(LLM):\n"
        "    def __init__(self, path, options): self.ready = False\n"
        "    def prepare(self):\n"
        "        if not self.ready: time.sleep(0.6)\n"
        "        self.ready = True\n"
        f"    def complete(self, request): return answer({texts.star!r}, 'slow')\n"
        "@hookimpl\n"
        "def register_llms(register):\n"
        "    register(LLMSpec(name='slow', summary='', usage='', target='slow:Slow'))\n"
    )
    args = ("--llm", "slow:x", "--plugin", "slow.py", "-L", "patience=0.1", "--json")
    result = cli("run", "drawing/star", *args)
    assert result.code == 0
    assert result.json["seconds"]["llm"] < 0.5
    assert result.json["usage"]["latency"] < 0.3


def refuses(*names, **more):
    return {"fault": "parameter", "message": f"no {names}", "parameters": names, **more}


def test_a_parameter_that_is_refused_is_left_out_from_then_on(cli, script, texts, asked, events, here):
    args = script(refuses("temperature"), refuses("seed"), texts.outside, texts.star)
    result = cli("run", "drawing/star", *args, "--samples", 20, "--out", "r")
    assert result.code == 0
    sent = [(r["sampling"]["temperature"], r["sampling"]["seed"]) for r in asked()]
    assert sent == [(0.0, 0), (None, 0), (None, None), (None, None)]
    assert result.stderr.count("does not support temperature") == 1
    assert result.stderr.count("does not support seed") == 1
    for event in events(here / "r", "answer_received"):
        assert event["completion"]["dropped"] == ["temperature", "seed"]
        assert event["completion"]["sampling"]["temperature"] is None
    assert events(here / "r", "answer_received")[0]["completion"]["attempts"] == 3
    assert events(here / "r", "run_ended")[0]["summary"]["usage"]["calls"] == 4


def test_a_backend_that_refuses_everything_ends_the_run(cli, script, asked):
    result = cli("run", "drawing/star", *script(*[refuses("seed")] * 9), "--json")
    assert (result.code, len(asked())) == (3, 2)
    result = cli("run", "drawing/star", *script(*[refuses()] * 20), "--json")
    assert result.code == 3
    assert len(asked()) <= 9


def test_candidates_one_by_one_where_several_are_refused(cli, script, texts, asked):
    args = script(refuses("n"), texts.hopeless, texts.star)
    assert cli("run", "drawing/star", *args, "--candidates", 2).code == 0
    assert [request["sampling"]["n"] for request in asked()] == [2, 1, 1]


@pytest.mark.parametrize("name", ["temperature", "seed", "max_tokens"])
def test_a_parameter_is_left_out_on_demand(cli, script, texts, asked, name):
    args = script(texts.star)
    assert cli("run", "drawing/star", *args, "-L", f"{name}=none").code == 0
    assert asked()[0]["sampling"][name] is None


def test_the_parameters_in_effect_are_recorded(cli, script, texts, here):
    args = script(refuses("temperature"), texts.star)
    assert cli("run", "drawing/star", *args, "--record", "tape.jsonl").code == 0
    (entry,) = [line for line in (here / "tape.jsonl").read_text().splitlines() if "entry" in line]
    completion = json.loads(entry)["entry"]["completion"]
    assert completion["sampling"] == {
        "temperature": None,
        "seed": 0,
        "n": 1,
        "max_tokens": None,
        "reasoning_effort": None,
    }


def test_a_prompt_that_was_cut_is_said(cli, script, texts, here):
    args = script({"texts": [texts.star], "usage": {"prompt_tokens": 64, "completion_tokens": 9}})
    result = cli("run", "drawing/star", *args, "--out", "r")
    assert "the server counted 64 tokens of a prompt of about" in result.stderr
    assert "raise its context length" in result.stderr
    page = cli("report", "r")
    assert page.code == 0
    assert "the server counted 64 tokens" in next((here / "r").glob("*.html")).read_text()
    assert "the server counted 64 tokens" in cli("explain", "r").stdout
