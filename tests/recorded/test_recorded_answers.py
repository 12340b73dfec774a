"""The answers of a model that come with proc3s: where they are from, and that every one reaches its goal."""

import json

import pytest

from proc3s import Request
from proc3s.runs.recordings import read_recordings
from proc3s_replay.recorded import FOLDER

RECORDINGS = read_recordings(FOLDER)
TASKS = sorted({recording.task for recording in RECORDINGS})
SEEDS = range(3)


def test_there_are_three_answers_to_each_of_nineteen_tasks():
    assert sorted((r.task, r.seed) for r in RECORDINGS) == [(task, seed) for task in TASKS for seed in SEEDS]
    assert len(TASKS) == 19


@pytest.mark.parametrize("suite", ["paper", "hard"])
def test_every_task_of_the_suites_has_answers(suite):
    from proc3s.plugins.registry import open_registry
    from proc3s.specs.suite import SuiteSpec

    assert set(open_registry().get(SuiteSpec, suite).tasks) <= set(TASKS)


def test_their_origin_is_told_as_it_was():
    for recording in RECORDINGS:
        given = recording.completion
        assert (given.source, given.model, given.answered) == ("recorded", "Claude", "2026-11-30")
        assert given.model_asked == "manual:answers"
        assert given.cost is None
        assert recording.sampling is None


def test_a_run_shows_and_keeps_the_origin(cli, here, events):
    done = cli("run", "drawing/star", "--llm", "recorded", "--out", "run", "-L", "stale=accept")
    assert done.code == 0
    assert "a recorded answer from Claude" in done.stderr
    (answer,) = events(here / "run", "answer_received")
    assert answer["completion"]["answered"] == "2026-11-30"


def test_a_name_behind_it_is_refused(cli):
    done = cli("run", "drawing/star", "--llm", "recorded:there")
    assert done.code == 3
    assert "--llm replay:there" in done.stderr


def test_recording_anew_does_not_write_into_the_installation():
    from proc3s import LLMError
    from proc3s_replay.recorded import recorded
    from proc3s_replay.replay import Options

    one = RECORDINGS[0]
    asked = Request(
        messages=one.messages[:1], task=one.task, method=one.method, template=one.method, seed=one.seed
    )
    with pytest.raises(LLMError) as refused:
        recorded("", Options()).complete(asked)
    assert f"--record {FOLDER}" not in str(refused.value)
    assert "--record" in str(refused.value)
    assert "-L stale=accept" in str(refused.value)


@pytest.mark.slow
@pytest.mark.parametrize("task", TASKS)
def test_every_answer_reaches_its_goal(task, cli):
    """With stale=accept, since it is the programs that are on trial here: prompts may change."""
    for seed in SEEDS:
        done = cli(
            "run", task, "--seed", seed, "--llm", "recorded", "-L", "stale=accept", "--json", "--out", seed
        )
        summary = json.loads(done.stdout)
        reached = (done.code, summary["solved"], summary["goal_reached"], summary["llm_source"])
        assert reached == (0, True, True, "recorded"), (seed, summary["error"], summary["goal_reason"])
