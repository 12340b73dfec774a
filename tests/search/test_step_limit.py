"""A step that takes for ever breaks the run off, names the skill, and says nothing of the plan."""

import signal
import threading
import time
from pathlib import Path

import pytest

from proc3s import OutOfTime
from proc3s.search.watch import watch

PLUGIN = Path(__file__).with_name("slow_steps.py")
EXECUTORS = [("--executor", "serial"), ("--executor", "processes", "--jobs", "1")]


def command(here, *skills, task="tar/cross", limit=0.3, executor=()):
    """Solves with a plan of these steps."""
    actions = ", ".join(f'Action("wade", ["{how}"])' for how in skills)
    (here / "plan.py").write_text(
        f"def gen_plan(initial, x):\n    return [{actions}]\n\n"
        'def gen_domain(initial):\n    return {"x": ContinuousSampler(0, 1)}\n'
    )
    options = ("--plugin", PLUGIN, "--limit", f"step={limit}", *executor, "--json", "--out", "run")
    return ("solve", task, "--sketch", "plan.py", *options)


@pytest.mark.slow
@pytest.mark.parametrize("executor", EXECUTORS, ids=["serial", "processes"])
@pytest.mark.parametrize("how", ["asleep", "busy", "deaf"])
def test_a_skill_that_hangs_is_named_and_no_verdict(cli, here, how, executor):
    result = cli(*command(here, "on", how, executor=executor))
    summary = result.json
    assert result.code == 1
    assert summary["error"] == "skill wade (step 1) did not end within 0.3 s (--limit step=0.3)"
    assert (summary["solved"], summary["samples"], summary["violations"]) == (False, 0, [])
    assert summary["program_errors"] == []
    assert summary["error"] in (here / "run/summary.json").read_text()


@pytest.mark.slow
@pytest.mark.parametrize("executor", EXECUTORS, ids=["serial", "processes"])
def test_a_skill_that_hangs_in_c_is_named_too(shell, here, executor):
    """Nothing in its process can say so any more."""
    result = shell(*command(here, "on", "in_c", executor=executor))
    words = "skill wade (step 1) did not end within 0.3 s (--limit step=0.3), nor when it was interrupted"
    if "processes" in executor:
        assert result.code == 1
        assert result.json["error"] == words
        assert (result.json["samples"], result.json["violations"]) == (0, [])
    else:
        assert result.code == -signal.SIGKILL
        assert f"error: {words}; the process is ended" in result.stderr


@pytest.mark.parametrize(
    ("task", "skills", "what"),
    [
        ("tar/sink", ["on"], "the reset of the world"),
        ("tar/cross", ["on", "on", "on"], "judge slow_steps:judge of tar/cross"),
    ],
)
def test_a_reset_or_a_judge_that_hangs_is_named(cli, here, task, skills, what):
    summary = cli(*command(here, *skills, task=task)).json
    assert f"{what} did not end within 0.3 s" in summary["error"]


def test_what_ends_in_time_is_not_disturbed(cli, here):
    assert cli(*command(here, "on", "on", limit=60)).json["solved"]


def test_an_alarm_of_someone_else_is_left_alone():
    rang = []
    before = signal.signal(signal.SIGALRM, lambda *_: rang.append(True))
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        with watch().within(0.01, "a nap"):
            time.sleep(0.2)
    finally:
        signal.signal(signal.SIGALRM, before)
    assert rang == [True]


def test_handler_and_alarm_are_as_before():
    before = signal.getsignal(signal.SIGALRM)
    with pytest.raises(OutOfTime, match="a nap did not end"), watch().within(0.01, "a nap"):
        time.sleep(5)
    assert signal.getsignal(signal.SIGALRM) is before
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)


def test_another_thread_has_no_limit():
    ended = []

    def nap():
        with watch().within(0.01, "a nap"):
            time.sleep(0.05)
            ended.append(True)

    thread = threading.Thread(target=nap)
    thread.start()
    thread.join()
    assert ended == [True]
