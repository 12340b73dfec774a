"""Whole runs against a real server on this machine, through the real litellm."""

import json
import os
import time
from pathlib import Path

import pytest

from provider import CLOSES, CUTS, DRIPS, HANGS, refuses, says, sends

# The import of litellm takes seconds, in every process anew.
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("litellm")]

ANSWERS = Path(__file__).parents[2] / "domains/proc3s_drawing/answers"
STAR = (ANSWERS / "star.proc3s.md").read_text().split("---\n")[2]
SECRET = "sk-planted-7f3a9c51e2"


@pytest.fixture
def local(provider, monkeypatch):
    """`--llm` of a local model that answers with a star."""
    monkeypatch.delenv("OPENAI_API_KEY", raising=False)
    provider.text = STAR
    return ("--llm", "openai/tiny", "-L", f"api_base={provider.address}")


def test_a_local_server(cli, local, provider, events, here):
    result = cli("run", "drawing/star", *local, "--out", "r", "--json")
    assert (result.code, result.json["llm_source"], result.json["goal_reached"]) == (0, "live", True)
    assert provider.keys == ["none"]
    asked = provider.asked[0].body
    assert (asked["temperature"], asked["seed"]) == (0, 0)
    completion = events(here / "r", "answer_received")[0]["completion"]
    assert (completion["model_asked"], completion["model"]) == ("openai/tiny", "tiny-2026")
    assert completion["usage"]["prompt_tokens"] == 11
    assert (completion["cost"], completion["attempts"]) == (None, 1)
    assert 0 < completion["latency"] < 30
    assert result.json["usage"]["cost"] is None


def test_candidates_in_one_call(cli, local, provider):
    result = cli("run", "drawing/star", *local, "--candidates", 3, "--json")
    assert (result.code, len(provider.asked)) == (0, 1)
    assert (provider.asked[0].body["n"], provider.asked[0].body["temperature"]) == (3, 0.7)


def test_a_provider_without_n_or_seed(cli, provider, monkeypatch):
    """Anthropic's protocol: candidates one by one, and what is lost is said aloud."""
    monkeypatch.setenv("ANTHROPIC_API_KEY", SECRET)
    provider.text = STAR
    llm = ("--llm", "anthropic/claude-sonnet-4-5", "-L", f"api_base={provider.root}")
    result = cli("run", "drawing/star", *llm, "--candidates", 2, "--llm-jobs", 2)
    assert result.code == 0, result.stderr
    assert len(provider.asked) == 2
    assert "does not support seed: this run cannot be reproduced" in result.stderr


def test_the_stable_part_is_marked_and_the_same_for_every_task(cli, provider, monkeypatch):
    monkeypatch.setenv("ANTHROPIC_API_KEY", SECRET)
    provider.text = "no program"
    llm = ("--llm", "anthropic/claude-sonnet-4-5", "-L", f"api_base={provider.root}", "--feedback", 0)
    for task, seed in (("star", 0), ("arrow", 0), ("star", 5)):
        cli("run", f"drawing/{task}", "--seed", seed, *llm)
    stable = []
    for request in provider.asked:
        messages = [*request.body["system"], *request.body["messages"]]
        marks = [i for i, m in enumerate(messages) if "cache_control" in json.dumps(m)]
        assert len(marks) == 1
        stable.append(json.dumps(messages[: marks[0] + 1]))
        assert len(messages) > marks[0] + 1
    assert len(set(stable)) == 1


@pytest.mark.parametrize(
    ("reply", "word"),
    [
        (refuses(401, "Incorrect API key provided: none"), "key"),
        (refuses(429, "You exceeded your current quota", code="insufficient_quota"), "pay"),
        (refuses(404, "The model `tiny` does not exist", code="model_not_found"), "no such model"),
        (refuses(400, "maximum context length is 8 tokens", code="context_length_exceeded"), "too long"),
        (says(None, finish="content_filter"), "filter"),
    ],
    ids=["auth", "quota", "model", "context", "filter"],
)
def test_a_fault_that_stays_is_exit_code_3_after_one_call(cli, local, provider, here, reply, word):
    provider.script(reply)
    result = cli("run", "drawing/star", *local, "--out", "r", "--json")
    assert (result.code, len(provider.asked)) == (3, 1)
    assert word in result.json["error"]
    assert "openai/tiny" in result.json["error"]
    assert json.loads((here / "r/summary.json").read_text())["error"] == result.json["error"]


@pytest.mark.parametrize(
    "reply",
    [
        refuses(429, "slow down", Retry_After="0"),
        refuses(500, "oh"),
        refuses(503, "overloaded"),
        sends("<html><body>Bad gateway</body></html>"),
        sends({"id": "1", "choices": []}),
        says(None),
        CLOSES,
        CUTS,
        HANGS,
    ],
    ids=["rate", "500", "503", "html", "no choices", "null", "closes", "cuts", "hangs"],
)
def test_a_fault_that_passes_costs_one_more_call(cli, local, provider, reply, monkeypatch):
    monkeypatch.setattr("tenacity.nap.time.sleep", lambda seconds: None)
    provider.script(reply)
    result = cli("run", "drawing/star", *local, "-L", "timeout=2", "--json")
    assert (result.code, len(provider.asked)) == (0, 2)
    assert result.json["usage"]["calls"] == 2


def test_a_server_that_is_not_there(cli, here, monkeypatch):
    monkeypatch.setattr("tenacity.nap.time.sleep", lambda seconds: None)
    llm = ("--llm", "openai/tiny", "-L", "api_base=http://127.0.0.1:9/v1")
    result = cli("run", "drawing/star", *llm, "--out", "r", "--json")
    assert result.code == 3
    assert "start the server" in result.json["error"]
    assert "(6 attempts)" in result.json["error"]


def test_a_cut_answer(cli, local, provider):
    provider.script(says(STAR[:200], finish="length"))
    result = cli("run", "drawing/star", *local, "-L", "max_tokens=300", "--json")
    assert result.code == 0
    limits = [r.body.get("max_tokens") or r.body.get("max_completion_tokens") for r in provider.asked]
    assert limits == [300, 600]


def test_a_missing_key_is_found_before_anything_else(cli, here, monkeypatch):
    monkeypatch.delenv("ANTHROPIC_API_KEY", raising=False)
    begun = time.monotonic()
    result = cli("run", "drawing/star", "--llm", "anthropic/claude-x", "--out", "r", "--json")
    assert (result.code, "ANTHROPIC_API_KEY" in result.json["error"]) == (3, True)
    assert not (here / "r").exists()
    assert time.monotonic() - begun < 3


def test_a_recording_plays_without_the_server(cli, local, provider, here):
    live = cli("run", "drawing/star", *local, "--record", "tape.jsonl", "--json")
    again = cli("run", "drawing/star", "--llm", "replay:tape.jsonl", "--json")
    assert (again.code, again.json["plan"], len(provider.asked)) == (0, live.json["plan"], 1)
    assert (again.json["llm_source"], again.json["usage"]) == ("recorded", live.json["usage"])
    assert again.json["seconds"]["llm"] < 1
    assert "def gen_plan(" in (here / "tape.jsonl").read_text()


def test_a_price_that_litellm_knows_keeps_a_limit(cli, monkeypatch):
    monkeypatch.setenv("OPENAI_API_KEY", SECRET)
    result = cli("run", "drawing/star", "--llm", "openai/gpt-4o", "--max-cost", 0.000001, "--json")
    assert result.code == 1
    assert result.json["error"].startswith("budget: 0 of 0.000001 US dollars")


def everything(folder):
    return b"".join(path.read_bytes() for path in folder.rglob("*") if path.is_file())


def test_a_key_is_nowhere(background, eventually, provider, here, monkeypatch):
    """Not in files, not on the terminal, not in `ps`, not in the environment of any worker."""
    monkeypatch.setenv("OPENAI_API_KEY", SECRET)
    provider.text = STAR
    provider.script(refuses(503, f"key {SECRET} is fine"), says(STAR.replace("radius", "r"), after=1))
    flags = ("--jobs", 2, "--no-screens", "--preset", "paper", "--samples", 200_000, "--record", "tape")
    llm = ("--llm", "openai/tiny", "-L", f"api_base={provider.address}")
    with background("run", "drawing/letters", *llm, *flags, "--out", "r") as process:
        listed, seen, forked = set(), set(), set()

        def children():
            own = Path(f"/proc/{process.pid}/cmdline").read_bytes()
            for path in Path(f"/proc/{process.pid}/task").glob("*/children"):
                listed.update(map(int, path.read_text().split()))
            for pid in listed:
                try:
                    command = Path(f"/proc/{pid}/cmdline").read_bytes()
                    environ = Path(f"/proc/{pid}/environ").read_bytes()
                except OSError:
                    continue
                # until it starts a program, a child is a copy of the run itself; it must not stay one
                (forked.add if command == own else forked.discard)(pid)
                assert command == own or SECRET.encode() not in environ + command
                if b"spawn_main" in command:
                    seen.add(pid)
            return process.poll() is not None or len(seen) >= 2

        eventually(children, 60)
        eventually(lambda: children() and not any(Path(f"/proc/{pid}").exists() for pid in forked))
        assert SECRET.encode() not in Path(f"/proc/{process.pid}/cmdline").read_bytes()
        process.terminate()
        stdout, stderr = process.communicate(timeout=60)
    assert provider.keys[0] == SECRET
    assert len(seen) >= 2
    assert SECRET not in stdout + stderr
    assert SECRET.encode() not in everything(here)
    assert "call_failed" in (here / "r/events.jsonl").read_text()
    assert os.environ["OPENAI_API_KEY"] == SECRET


@pytest.mark.parametrize("option", [f"api_key={SECRET}", f"key={SECRET}", f"api_base=http://u:{SECRET}@h/v1"])
def test_a_key_is_no_option(cli, here, option):
    result = cli("run", "drawing/star", "--llm", "openai/x", "-L", option, "--out", "r", "--json")
    assert result.code == 2
    assert SECRET not in result.stdout + result.stderr
    assert not (here / "r").exists()


@pytest.mark.slow
@pytest.mark.skipif("PROC3S_TEST_LLM" not in os.environ, reason="PROC3S_TEST_LLM names no model to ask")
def test_a_real_model(cli):
    """For a model of one's own, e.g. PROC3S_TEST_LLM="openai/qwen -L api_base=http://localhost:11434/v1"."""
    llm = os.environ["PROC3S_TEST_LLM"].split()
    result = cli("run", "drawing/star", "--llm", *llm, "--json")
    assert result.code in (0, 1), result.stderr
    assert result.json["llm_source"] == "live"


def test_a_server_that_knows_few_parameters(cli, local, provider, events, here):
    provider.script(refuses(400, "temperature is not supported"), refuses(422, "unknown field `seed`"))
    result = cli("run", "drawing/star", *local, "--out", "r")
    assert result.code == 0
    assert [sorted({"temperature", "seed"} & asked.body.keys()) for asked in provider.asked] == [
        ["seed", "temperature"],
        ["seed"],
        [],
    ]
    assert "the provider refuses temperature (HTTP 400: temperature is not supported)" in result.stderr
    assert result.stderr.count("does not support seed: this run cannot be reproduced") == 1
    completion = events(here / "r", "answer_received")[0]["completion"]
    assert (completion["dropped"], completion["attempts"]) == (["temperature", "seed"], 3)
    assert completion["sampling"]["temperature"] is None


@pytest.mark.parametrize(
    ("sent", "word"),
    [
        ({"content": None, "refusal": "I cannot help with stars"}, "I cannot help with stars"),
        ({"content": "", "tool_calls": [{"id": "1", "type": "function", "function": {"name": "f"}}]}, "tool"),
    ],
    ids=["refusal", "tool"],
)
def test_why_there_is_no_answer_is_said_at_once_and_what_it_cost(cli, local, provider, sent, word):
    choice = {"index": 0, "message": {"role": "assistant", **sent}, "finish_reason": "stop"}
    usage = {"prompt_tokens": 1000, "completion_tokens": 7, "total_tokens": 1007}
    provider.script(sends({"id": "1", "model": "m", "choices": [choice], "usage": usage}))
    result = cli("run", "drawing/star", *local, "--json")
    assert (result.code, len(provider.asked)) == (3, 1)
    assert word in result.json["error"]
    spent = result.json["usage"]
    assert (spent["calls"], spent["prompt_tokens"], spent["completion_tokens"]) == (1, 1000, 7)
    assert spent["cost"] is None


def test_an_answer_in_parts_is_run(cli, local, provider):
    parts = [{"type": "reasoning", "text": "def gen_plan"}, {"type": "text", "text": STAR}]
    choice = {"index": 0, "message": {"role": "assistant", "content": parts}, "finish_reason": "stop"}
    provider.script(sends({"id": "1", "model": "m", "choices": [choice]}))
    result = cli("run", "drawing/star", *local, "--json")
    assert (result.code, len(provider.asked)) == (0, 1)


def test_a_server_that_drips(cli, local, provider):
    provider.script(DRIPS[0])
    begun = time.monotonic()
    result = cli("run", "drawing/star", *local, "-L", "timeout=0.5", "-L", "patience=0", "--json")
    assert (result.code, "no answer within 0.5 s" in result.json["error"]) == (3, True)
    assert time.monotonic() - begun < 20


def test_importing_litellm_is_not_the_models_time(shell, local):
    """In a process of its own, where litellm is not imported yet."""
    result = shell("run", "drawing/star", *local, "--json", timeout=120)
    assert result.code == 0, result.stderr
    assert result.json["usage"]["latency"] < 1
    assert result.json["seconds"]["llm"] < 4


@pytest.mark.parametrize("path", ["", "/", "/v1/chat/completions", "/chat/completions"])
def test_the_right_address_is_said(cli, provider, path, monkeypatch):
    monkeypatch.delenv("OPENAI_API_KEY", raising=False)
    provider.under = "/v1/chat/completions"
    address = f"{provider.root}{path}"
    if path == "/v1/chat/completions":
        provider.under = "/v1/chat/completions?"  # nothing is where two such paths lead
    result = cli("run", "drawing/star", "--llm", "openai/tiny", "-L", f"api_base={address}", "--json")
    assert result.code == 3
    assert f"is -L api_base={provider.address} meant?" in result.json["error"]


@pytest.mark.parametrize(
    ("model", "word"), [("foo/bar", "no provider 'foo'"), ("veniceai/m", "VENICE_AI_API_KEY")]
)
def test_what_only_litellm_knows_is_found_before_the_run_too(cli, here, monkeypatch, model, word):
    monkeypatch.delenv("VENICE_AI_API_KEY", raising=False)
    result = cli("run", "drawing/star", "--llm", model, "--out", "r", "--json")
    assert (result.code, word in result.json["error"]) == (3, True)
    assert not (here / "r").exists()
