"""A domain may have a second world, in which plans are executed before the judge looks."""

from pathlib import Path

import pytest

LOOSE = [part for name in ("walk.py", "slip.py") for part in ("--plugin", Path(__file__).with_name(name))]
PLAN = "gen_plan = [Action('hop', [{by}])]\n"


@pytest.fixture
def executed(cli, here):
    """Solves with a plan of one hop."""

    def run(by, *options):
        (here / "plan.py").write_text(PLAN.format(by=by))
        return cli("solve", "slip/far", *LOOSE, "--sketch", "plan.py", "--method", "llm3", "--json", *options)

    return run


def test_both_verdicts_are_kept(executed):
    result = executed(3.0)
    assert (result.code, result.json["solved"]) == (0, True)
    assert (result.json["goal_expected"], result.json["goal_reached"]) == (True, False)
    assert result.json["goal_reason"] == "the walker is at 4.5 m"


def test_the_goal_in_the_loop_is_that_of_the_world_that_accepts(executed):
    found = executed(3.0, "--check-goal").json
    assert (found["solved"], found["violations"]) == (True, [])


def test_violations_are_those_of_the_world_that_accepts(executed):
    """The hop ends before the pit that begins at 6 m, and executed beyond it."""
    assert executed(5.0, "--no-check-goal").json["solved"]


def test_the_log_has_both(executed, events):
    run = Path(executed(3.0).json["run_dir"])
    (event,) = events(run, "plan_executed")
    assert (event["goal_expected"], event["goal_reached"]) == (True, False)


def test_an_accepted_plan_is_told_even_if_it_cannot_be_carried_out(cli, here):
    (here / "plan.py").write_text(PLAN.format(by=3.0))
    for name in ("slip.py", "slip.yaml"):
        text = Path(__file__).with_name(name).read_text(encoding="utf-8")
        full = 'def observe(self):\n        raise OSError(28, "No space left on device")'
        (here / name).write_text(text.replace("def observe(self):", full))
    plugins = ("--plugin", Path(__file__).with_name("walk.py"), "--plugin", here / "slip.py")
    args = ("solve", "slip/far", *plugins, "--sketch", "plan.py", "--method", "llm3", "--no-check-goal")
    done = cli(*args, "--json")
    assert done.code == 2
    assert "No space left on device" in done.json["error"]
    assert (done.json["executed"], done.json["plan"]) == ("none", [{"skill": "hop", "args": [3.0]}])
    assert "hop(3)" in cli(*args).stdout
