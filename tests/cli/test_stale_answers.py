"""Answers to earlier prompts, and call options that a replay cannot follow: said wherever a run is shown."""

import json

import pytest

from proc3s.llm.recorder import Recording
from proc3s.runs.recordings import read_recordings

STALE = ("--llm", "replay:old.jsonl", "-L", "stale=accept")


@pytest.fixture
def old(cli, here, answers):
    """A cassette with an answer to drawing/star, seed 0, of an earlier prompt."""
    from proc3s.llm.cassette import Cassette
    from proc3s.llm.types import digest

    (here / "first.json").write_text(json.dumps([answers.star]))
    done = cli("run", "drawing/star", "--llm", "stub:first.json", "--record", "new.jsonl", "--out", "first")
    assert done.code == 0, done.stderr
    (one,) = read_recordings(here / "new.jsonl")
    earlier = [m.model_copy(update={"text": f"Please. {m.text}"}) for m in one.messages]
    changed = one.model_copy(update={"messages": tuple(earlier), "sha256": digest(earlier)})
    Cassette(here / "old.jsonl").append(Recording.model_validate(changed.model_dump()).model_dump())
    return here / "old.jsonl"


def test_a_stale_answer_is_refused_with_both_ways_out(cli, old):
    done = cli("run", "drawing/star", "--llm", "replay:old.jsonl")
    assert done.code == 3
    assert "-L stale=accept" in done.stderr
    assert "--record" in done.stderr


def test_a_run_of_a_stale_answer_says_so_everywhere(cli, old, here, events):
    done = cli("run", "drawing/star", *STALE, "--out", "run")
    assert done.code == 0
    assert "another prompt (stale=accept)" in done.stderr
    assert "answer   stale" in done.stdout
    assert json.loads((here / "run/summary.json").read_text())["stale"]
    assert events(here / "run", "answer_received")[0]["completion"]["stale"]
    assert "The answer is stale" in cli("explain", "run").stdout
    assert cli("explain", "run", "--json").json["rounds"][0]["stale"]
    assert cli("report", "run").code == 0
    assert ", stale: to another prompt" in (here / "run/report.html").read_text()


def test_it_stays_stale_when_the_run_is_replayed(cli, old):
    assert cli("run", "drawing/star", *STALE, "--out", "run", "--json").json["stale"]
    assert cli("replay", "run", "--json", "--out", "again").json["stale"]
    by_answer = cli("run", "drawing/star", "--llm", "replay:run", "--json", "--out", "third")
    assert (by_answer.code, by_answer.json["stale"]) == (0, True)


def test_a_fresh_answer_is_not_marked(cli, old):
    done = cli("run", "drawing/star", "--llm", "replay:new.jsonl", "-L", "stale=accept", "--out", "run")
    assert done.code == 0
    assert "stale" not in done.stdout + done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("llm", ["replay", "stub:first.json", "replay:new.jsonl"])
def test_call_options_do_nothing_for_answers_of_which_nobody_knows_how_they_were_drawn(cli, old, llm):
    done = cli("run", "drawing/star", "--llm", llm, "-L", "temperature=1.5", "-L", "max_tokens=7")
    assert done.code == 0
    assert "nothing was asked, so -L max_tokens, temperature changed nothing" in done.stderr
    silent = cli("run", "drawing/star", "--llm", llm)
    assert "changed nothing" not in silent.stderr
