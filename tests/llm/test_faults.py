"""Faults of a backend, as the command line deals with them."""

import time

import pytest

PASSING = ["rate_limit", "timeout", "connection", "server", "broken", "empty"]
FINAL = ["missing_key", "auth", "quota", "unknown_model", "filtered", "other", "no_answer"]


def fault(kind, **more):
    return {"fault": kind, "message": f"it was {kind}", **more}


@pytest.mark.parametrize("kind", PASSING)
def test_a_passing_fault_is_tried_again(cli, script, texts, asked, kind):
    result = cli("run", "drawing/star", *script(fault(kind, retry_after=0.01), texts.star), "--out", "r")
    assert result.code == 0, result.stderr
    assert len(asked()) == 2
    assert f"it was {kind}; trying again in 0.0 s" in result.stderr


@pytest.mark.parametrize("kind", FINAL)
def test_a_final_fault_is_not(cli, script, texts, asked, kind):
    result = cli("run", "drawing/star", *script(fault(kind), texts.star), "--out", "r", "--json")
    assert (result.code, result.json["error"]) == (3, f"it was {kind}")
    assert len(asked()) == 1


def test_patience_ends(cli, script, asked):
    begun = time.monotonic()
    faults = [fault("server", retry_after=0.1)] * 9
    result = cli("run", "drawing/star", *script(*faults), "-L", "patience=0.25", "--json")
    assert (result.code, time.monotonic() - begun < 5) == (3, True)
    assert 2 <= len(asked()) <= 3
    assert result.json["error"] == f"it was server ({len(asked())} attempts)"


def test_nobody_waits_longer_than_patience_allows(cli, script, texts, asked):
    """A provider that asks for an hour is not asked again."""
    begun = time.monotonic()
    result = cli("run", "drawing/star", *script(fault("rate_limit", retry_after=3600), texts.star))
    assert (result.code, len(asked())) == (3, 1)
    assert time.monotonic() - begun < 20


def test_the_attempts_end_without_advice_too(cli, script, asked, monkeypatch):
    """Without a word from the provider: six attempts, ever further apart."""
    waits = []
    monkeypatch.setattr("tenacity.nap.time.sleep", waits.append)
    assert cli("run", "drawing/star", *script(*[fault("server")] * 9)).code == 3
    assert len(asked()) == 6
    waits = [seconds for seconds in waits if seconds]
    assert len(waits) == 5
    assert sorted(waits) == waits
    assert sum(waits) < 60


def test_retry_after_is_kept(cli, script, texts, events, here):
    args = script(fault("rate_limit", retry_after=0.3), texts.star)
    begun = time.monotonic()
    assert cli("run", "drawing/star", *args, "--out", "r").code == 0
    assert time.monotonic() - begun >= 0.3
    (failed,) = events(here / "r", "call_failed")
    assert (failed["fault"], failed["wait"]) == ("rate_limit", 0.3)
    assert events(here / "r", "answer_received")[0]["completion"]["attempts"] == 2


def cut(text, **more):
    return {"texts": [text[: len(text) // 2]], "finish": "length", **more}


def test_a_cut_answer_gets_twice_the_room_once(cli, script, texts, asked, here):
    args = script(cut(texts.star), texts.star)
    assert cli("run", "drawing/star", *args, "-L", "max_tokens=100", "--out", "r").code == 0
    assert [request["sampling"]["max_tokens"] for request in asked()] == [100, 200]
    assert (here / "r/answer-0.md").read_text() == texts.star


def test_the_room_of_an_answer_without_a_limit_is_what_it_took(cli, script, texts, asked):
    usage = {"prompt_tokens": 1, "completion_tokens": 77}
    cli("run", "drawing/star", *script(cut(texts.star, usage=usage), texts.star))
    assert [request["sampling"]["max_tokens"] for request in asked()] == [None, 154]


def test_an_answer_that_is_cut_twice_is_never_run(cli, script, texts, here):
    args = script(cut(texts.star), cut(texts.star))
    result = cli("run", "drawing/star", *args, "-L", "max_tokens=100", "--out", "r", "--json")
    assert result.code == 3
    assert "cut off" in result.json["error"]
    assert "max_tokens" in result.json["error"]
    assert not list((here / "r").glob("program-*"))


@pytest.mark.parametrize("text", ["", "  \n "])
def test_an_empty_answer_is_asked_for_again(cli, script, texts, asked, text, monkeypatch):
    monkeypatch.setattr("tenacity.nap.time.sleep", lambda seconds: None)
    assert cli("run", "drawing/star", *script(text, [], texts.star)).code == 0
    assert len(asked()) == 3


def test_an_answer_that_a_filter_held_back(cli, script):
    result = cli("run", "drawing/star", *script({"texts": [""], "finish": "content_filter"}), "--json")
    assert result.code == 3
    assert "content filter" in result.json["error"]


def test_what_a_backend_raises_unasked_names_its_line(cli, script):
    result = cli("run", "drawing/star", *script({"nonsense": 1}), "--json")
    assert result.code == 3
    assert "talker.py:" in result.json["error"]
    assert "KeyError" in result.json["error"]


def test_a_conversation_that_is_too_long_is_shortened_once(cli, script, texts, asked):
    entries = (texts.outside, texts.outside, fault("context"), texts.star)
    result = cli("run", "drawing/star", *script(*entries), "--samples", 60, "--preset", "paper")
    assert result.code == 0, result.stderr
    kinds = [[m["kind"] for m in request["messages"]].count("feedback") for request in asked()]
    assert kinds == [0, 1, 2, 1]
    assert "only its latest round was shown" in result.stderr


def test_a_first_question_that_is_too_long_ends_the_run(cli, script, texts, asked):
    result = cli("run", "drawing/star", *script(fault("context"), texts.star), "--json")
    assert (result.code, len(asked())) == (3, 1)


def test_a_conversation_that_was_shortened_can_be_replayed(cli, script, texts):
    entries = (texts.outside, texts.outside, fault("context"), texts.star)
    args = ("--samples", 60, "--preset", "paper", "--json")
    live = cli("run", "drawing/star", *script(*entries), *args, "--out", "live")
    again = cli("run", "drawing/star", "--llm", "replay:live", *args)
    assert (again.code, again.json["plan"]) == (0, live.json["plan"])


def test_a_cut_answer_is_paid_for_and_said(cli, script, texts, events, here):
    usage = {"prompt_tokens": 1000, "completion_tokens": 2000}
    first = cut(texts.star, usage=usage, cost=0.5)
    second = {"texts": [texts.star], "usage": usage, "cost": 0.25}
    result = cli("run", "drawing/star", *script(first, second), "--out", "r")
    assert "the answer was cut off after 2,000 tokens" in result.stderr
    usage = events(here / "r", "run_ended")[0]["summary"]["usage"]
    assert (usage["calls"], usage["cost"], usage["completion_tokens"]) == (2, 0.75, 4000)


@pytest.mark.parametrize("entry", [{"wrong": "a text"}, {"wrong": None}])
def test_nonsense_from_a_backend_is_said(cli, script, entry):
    result = cli("run", "drawing/star", *script(entry), "--json")
    assert result.code == 3
    assert "no Completion" in result.json["error"]


def test_a_negative_wait_is_none(cli, script, texts):
    assert cli("run", "drawing/star", *script(fault("server", retry_after=-5), texts.star)).code == 0


def test_a_backend_that_cannot_be_made(cli, here):
    (here / "broken.py").write_text(
        "from proc3s import LLM, LLMSpec, hookimpl\n"
        "class Broken(LLM):\n"
        "    def __init__(self, path, options):\n"
        "        raise RuntimeError('no such thing')\n"
        "    def complete(self, request):\n"
        "        return None\n"
        "@hookimpl\n"
        "def register_llms(register):\n"
        "    register(LLMSpec(name='broken', summary='', usage='', target='broken:Broken'))\n"
    )
    result = cli("run", "drawing/star", "--llm", "broken:x", "--plugin", "broken.py", "--json")
    assert result.code == 2
    assert "broken.py:4" in result.json["error"]
