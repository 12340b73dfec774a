"""`proc3s execute` carries the plan of a run out again, without an LLM, and says what becomes of it."""

import json
from pathlib import Path

import pytest

import proc3s

PEGS = Path(__file__).parents[1] / "support/pegs"
PROGRAM = PEGS / "bench/middle.aim.py"


@pytest.fixture
def run(cli, here):
    """The folder of a run: a peg is put down within 0.2 mm of the middle; 2 mm away is a miss."""
    folder = here / "runs/first"
    done = cli("solve", "pegs/middle", "--sketch", PROGRAM, "--plugin", PEGS / "domain.yaml", "--out", folder)
    assert done.code == 0, done.stderr
    return folder


def changed(run, event, **fields):
    """Change fields of an event in the log of a run."""
    log = run / "events.jsonl"
    events = [json.loads(line) for line in log.read_text().splitlines()]
    next(one for one in events if one["event"] == event).update(fields)
    log.write_text("".join(json.dumps(one) + "\n" for one in events))


def begun(run):
    return json.loads((run / "events.jsonl").read_text().partition("\n")[0])


def test_the_plan_of_the_newest_run_reaches_the_goal_again_and_nothing_is_written(cli, run):
    before = {path: path.read_bytes() for path in run.rglob("*") if path.is_file()}
    result = cli("execute")
    assert result.code == 0, result.stderr
    assert "the newest run, runs/first" in result.stderr
    first, total = result.stdout.splitlines()
    assert first.startswith("  1  reached  the peg is 0.")
    assert total == "1 of 1 reaches the goal, felt"
    assert {path: path.read_bytes() for path in run.rglob("*") if path.is_file()} == before


def test_errors_are_drawn_alike_each_time_whatever_their_number(cli, run):
    many, few = cli("execute", run, "--error", 5), cli("execute", "first", "--error", 5, "--times", 4)
    *lines, total = many.stdout.splitlines()
    assert len(lines) == 10
    assert few.stdout.splitlines()[:4] == lines[:4]
    reached = sum(line.split()[1] == "reached" for line in lines)
    assert len(set(lines)) == 10
    assert 0 < reached < 10
    assert (many.code, total.partition(" (95 % interval ")[0]) == (1, f"{reached} of 10 reach the goal")
    assert total.endswith(" %), felt, 5 mm")


def test_the_document_has_every_time(cli, run):
    result = cli("execute", run, "--error", 1, "--times", 2, "--json")
    assert (result.code, result.stderr) == (0, "")
    document = result.json
    assert (document["task"], document["error_mm"], document["times"]) == ("pegs/middle", 1.0, 2)
    assert document["world"] == {"execution": "felt"}
    assert document["reached"] == 2
    assert document["share"] == pytest.approx({"value": 1.0, "low": 0.3424, "high": 1.0}, abs=1e-4)
    assert [one["reached"] for one in document["repetitions"]] == [True, True]
    assert document["repetitions"][0]["reason"] != document["repetitions"][1]["reason"]


def test_a_larger_error_scales_the_same_draws_and_another_engine_has_its_own(cli, run):
    def reasons(*options):
        return [one["reason"] for one in cli("execute", run, *options, "--json").json["repetitions"]]

    felt, ice = reasons("--error", 3), reasons("--error", 1, "-W", "execution=ice")
    assert felt == ice
    assert reasons("--error", 1) != ice


def test_without_errors_it_is_carried_out_once(cli, run):
    result = cli("execute", run, "--times", 5)
    assert "every time is the same" in result.stderr
    assert len(result.stdout.splitlines()) == 2


def test_options_of_the_world_replace_those_of_the_run(cli, run):
    changed(run, "run_started", options={**begun(run)["options"], "world_options": {"execution": "sand"}})
    assert "not 'sand'" in cli("execute", run).stderr
    assert cli("execute", run, "-W", "execution=ice").stdout.endswith("goal, ice\n")


def test_a_scene_of_another_making_and_other_versions_are_said(cli, run):
    changed(run, "run_started", scene='{"place": 0.4}', versions={"python": "2.7"})
    result = cli("execute", run)
    assert result.code == 0
    assert "pegs/middle has another scene for this seed now; that of the run is used" in result.stderr
    assert "other versions are installed than when the run began" in result.stderr


def test_a_skill_that_is_gone_is_named(cli, run):
    changed(run, "plan_executed", plan=[{"skill": "throw", "args": [1.0]}])
    result = cli("execute", run)
    assert result.code == 2
    assert "pegs/middle has no skill 'throw' any more, which the plan uses" in result.stderr


@pytest.mark.parametrize(("error", "said"), [("-1", "-1"), ("nan", "nan"), ("51", "51"), ("inf", "inf")])
def test_an_error_is_none_or_small(cli, run, error, said):
    result = cli("execute", run, "--error", error)
    assert result.code == 2
    assert result.stderr == f"proc3s: --error: an error is 0 to 50 mm, not {said}\n"


def test_a_world_in_which_nothing_can_be_misplaced_says_so(cli):
    cli("run", "drawing/star", "--out", "first")
    result = cli("execute", "first", "--error", 1)
    assert result.code == 2
    assert result.stderr == "proc3s: --error: nothing is misplaced in the world of drawing\n"
    exact = cli("execute", "first")
    assert exact.code == 0, exact.stderr
    assert exact.stdout.splitlines()[-1] == "1 of 1 reaches the goal"


def test_goals_of_ones_own_are_carried_out_and_not_judged(cli, stub, answers):
    goal = ("--goal", "five lines", "--llm", stub(answers.star))
    assert cli("run", "drawing/star", *goal, "--out", "first").code == 0
    result = cli("execute", "first")
    assert result.code == 0
    first, total = result.stdout.splitlines()
    assert (first, total) == (
        "  1  not judged  custom goals are not judged",
        "carried out 1 time, not judged",
    )
    assert cli("execute", "first", "--json").json["reached"] is None


def test_a_run_without_a_plan_says_what_to_do(cli, stub):
    cli("run", "drawing/star", "--llm", stub("no code"), "--feedback", 0, "--out", "first")
    result = cli("execute", "first")
    assert result.code == 2
    assert result.stderr == "proc3s: first has no plan to carry out; `proc3s explain first` says why\n"


def test_a_result_in_python_is_executed_again(run):
    result = proc3s.load_run(run)
    (exact,) = result.execute()
    assert (exact.reached, exact.reason) == (True, result.reason)
    assert len({one.reason for one in result.execute(error_mm=1, times=3)}) == 3
    assert result.execute(3, 2) == result.execute(1, 2, {"execution": "ice"})
    with pytest.raises(proc3s.UsageError, match="an error is 0 to 50 mm"):
        result.execute(error_mm=-1)


@pytest.mark.slow
def test_a_plan_that_pybullet_accepted_is_carried_out_in_both_engines(cli):
    pytest.importorskip("mujoco")
    assert cli("run", "blocks/unstack", "--out", "first").code == 0
    for engine in ("pybullet", "mujoco"):
        result = cli("execute", "first", "-W", f"execution={engine}", "--error", 1, "--times", 2)
        assert result.code == 0, result.stdout
        assert result.stdout.splitlines()[-1] == (
            f"2 of 2 reach the goal (95 % interval 34 to 100 %), {engine}, 1 mm"
        )
