"""Arrange-Blocks: its text, its scenes, its bundled answers and its worked example."""

import dataclasses
import itertools
import json
import re

import numpy as np
import pytest

from boxing import box, reaches_goal, trials
from proc3s.planning.options import RunOptions
from proc3s.planning.setup import make_problem
from proc3s.plugins.registry import open_registry
from proc3s.prompts.examples import example_turns
from proc3s.prompts.extract import extract_program
from proc3s.search.rollout import judge

REGISTRY = open_registry()
BLOCKS = REGISTRY.domain("blocks")
TASKS = ("pyramid", "line", "packing", "unstack")
BENCH = sorted((BLOCKS.spec.folder / "bench").glob("*.py"))
EXAMPLE = BLOCKS.spec.examples["tower"]


@pytest.fixture
def run(cli):
    """Runs a task with its bundled answers; returns the summary."""

    def start(task, seed, *options):
        return cli("run", f"blocks/{task}", "--seed", seed, "--json", "--out", "run", *options).json

    return start


def test_the_skills_and_constraints_come_from_the_toolbox():
    assert list(BLOCKS.spec.skills) == ["pick", "place"]
    assert list(BLOCKS.spec.constraints) == ["kinematic", "collision", "grasp", "placement"]
    assert BLOCKS.spec.world.target.startswith("proc3s_tabletop")


@pytest.mark.parametrize("task", TASKS)
def test_scenes_are_as_the_task_says(task):
    for seed in range(30):
        objects = BLOCKS.scene(BLOCKS.spec.tasks[task], seed).objects
        bowls = [o for o in objects.values() if o.category == "bowl"]
        blocks = [o for o in objects.values() if o.category == "block"]
        assert (len(bowls), len(blocks)) == {"packing": (0, 5), "unstack": (1, 8)}.get(task, (2, 6))
        assert [*objects] == [o.body for o in objects.values()]
        heights = [o.pose.z for o in blocks]
        if task != "unstack":
            assert max(heights) == 0.02
        else:
            green = [o for o in blocks if o.color == "green"]
            assert len(green) == 1
            assert any(
                (o.pose.x, o.pose.y) == (green[0].pose.x, green[0].pose.y) and o.pose.z > green[0].pose.z
                for o in blocks
            )


@pytest.mark.parametrize("task", TASKS)
def test_nothing_is_done_at_the_start(task):
    """A judge that a scene satisfies already would judge nothing."""
    for seed in range(10):
        problem = make_problem(REGISTRY, RunOptions(task=f"blocks/{task}", method="proc3s", seed=seed))
        score, reason = judge(problem, problem.initial, ())
        assert score is not None
        assert not score.reached, reason


def test_programs_find_positions_and_names():
    source = """
def gen_plan(initial):
    first = initial["object_0"]
    assert first is initial.objects["object_0"] and first.body == "object_0"
    assert list(first.point) == list(first.pose.point) == list(first.pose)[:3]
    assert list(first.pose.euler) == list(first.pose)[3:] == list(ArrangePose(0, 0, 0))[3:]
    assert CATEGORIES == ["block", "bowl"] and len(TABLE_BOUNDS) == len(TABLE_CENTER) == 3
    return [Action("pick", first.point)]
"""
    state = BLOCKS.scene(BLOCKS.spec.tasks["packing"], 0)
    with box(BLOCKS, source, "program", state) as sketch:
        (action,) = sketch.plans(np.zeros((1, 0)), first=0).plan(0)
    pose = state.objects["object_0"].pose
    assert action.args == pytest.approx((pose.x, pose.y, pose.z))


@pytest.mark.parametrize("path", BENCH, ids=lambda path: path.name)
def test_a_sketch_of_the_benchmark_gives_plans(path):
    task = path.name.split(".")[0]
    state = BLOCKS.scene(BLOCKS.spec.tasks[task], 0)
    with box(BLOCKS, path.read_text(encoding="utf-8"), "sketch", state) as sketch:
        batch = sketch.plans(np.random.default_rng(0).random((8, sketch.space.dim)), first=0)
    assert not batch.errors
    assert {action.skill for k in range(8) for action in batch.plan(k)} == {"pick", "place"}


def test_every_task_has_bundled_answers():
    names = {path.name for path in (BLOCKS.spec.folder / "answers").glob("*.md")}
    for task, suffix in itertools.product(TASKS, ("proc3s", "cap.seed0", "llm3.seed0")):
        assert f"{task}.{suffix}.md" in names
    assert "unstack.proc3s.round1.md" in names


def answers_of_example(kind):
    problem = make_problem(REGISTRY, RunOptions(task="blocks/packing", method="proc3s"))
    turns = example_turns(problem, EXAMPLE, kind)
    return [text for turn, text in turns if turn == "answer"], [t for turn, t in turns if turn == "feedback"]


def example_problem():
    problem = make_problem(REGISTRY, RunOptions(task="blocks/packing", method="proc3s"))
    state = BLOCKS.scene(EXAMPLE, EXAMPLE.seed)
    scene = json.dumps(BLOCKS.states.dump(state))
    return dataclasses.replace(problem, task=EXAMPLE, scene=scene, goal=EXAMPLE.instruction)


def test_the_example_fails_as_its_feedback_says_and_then_succeeds():
    problem = example_problem()
    (first, second), (feedback,) = answers_of_example("sketch")
    with box(BLOCKS, extract_program(first), "sketch", problem.initial) as sketch:
        (failed,) = trials(sketch, problem, 1)
    violation = failed.violations[0]
    assert f"step {violation.step}, action {violation.skill}: {violation.text}" in feedback
    with box(BLOCKS, extract_program(second), "sketch", problem.initial) as sketch:
        accepted = next(trial for trial in trials(sketch, problem, 30) if trial.accepted)
    assert reaches_goal(problem, accepted.plan)


@pytest.mark.parametrize(("kind", "answer"), [("program", "program"), ("plan", "plan")])
def test_the_example_shows_plans_that_reach_its_goal(kind, answer):
    problem = example_problem()
    (text,), _ = answers_of_example(kind)
    with box(BLOCKS, extract_program(text), answer, problem.initial) as sketch:
        plan = sketch.plans(np.zeros((1, 0)), first=0).plan(0)
    assert reaches_goal(problem, plan)


def test_a_pyramid_is_built_from_end_to_end(run):
    summary = run("pyramid", 0)
    assert (summary["solved"], summary["goal_reached"]) == (True, True), summary
    assert [step["skill"] for step in summary["plan"]] == ["pick", "place"] * 2
    assert re.match(r"on 2 of block: object_\d", summary["goal_reason"])


@pytest.mark.slow
@pytest.mark.parametrize(("task", "seed"), [*itertools.product(TASKS, range(10))])
def test_the_bundled_program_solves_every_seed(task, seed, run):
    summary = run(task, seed)
    assert (summary["solved"], summary["goal_reached"]) == (True, True), summary
    assert summary["rounds"] == (task == "unstack")


@pytest.mark.slow
@pytest.mark.parametrize(("task", "method"), [*itertools.product(TASKS, ("cap", "llm3"))])
def test_the_bundled_plans_of_seed_0_reach_the_goal(task, method, run):
    summary = run(task, 0, "--method", method)
    assert (summary["solved"], summary["goal_reached"]) == (True, True), summary


@pytest.mark.slow
def test_one_and_four_workers_find_the_same(cli):
    sketch = BLOCKS.spec.folder / "bench/packing.open.py"
    flags = ("--sketch", sketch, "--samples", 24, "--solver", "rejection", "--no-check-goal", "--json")
    alone, together = (cli("solve", "blocks/packing", *flags, "--jobs", jobs).json for jobs in (1, 4))
    same = ("solved", "plan", "samples", "evaluations", "violations", "nearest")
    assert [together[key] for key in same] == [alone[key] for key in same]
