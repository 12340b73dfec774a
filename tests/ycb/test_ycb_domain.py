"""Arrange-YCB: its text, its scenes, its bundled answers and its worked example."""

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
from proc3s_tabletop.catalogue.body_specs import bodies_of

REGISTRY = open_registry()
YCB = REGISTRY.domain("ycb")
TASKS = {"packing": 3, "stacking": 6}
EXAMPLE = YCB.spec.examples["centre"]


@pytest.fixture
def run(cli):
    """Runs a task with its bundled answers; returns the summary."""

    def start(task, seed, *options):
        return cli("run", f"ycb/{task}", "--seed", seed, "--json", "--out", "run", *options).json

    return start


@pytest.mark.parametrize(("task", "count"), TASKS.items())
def test_scenes_are_as_the_task_says(task, count):
    poses = []
    for seed in range(10):
        objects = YCB.scene(YCB.spec.tasks[task], seed).objects
        assert len({o.category for o in objects.values()}) == len(objects) == count
        assert [*objects] == [o.body for o in objects.values()]
        for o in objects.values():
            assert (o.pose.roll, o.pose.pitch) == (0, 0)
            assert abs(o.pose.x) <= 0.2
            assert -0.7 <= o.pose.y <= -0.3
        poses.append(next(iter(objects.values())).pose)
    assert len(set(poses)) == len(poses)


@pytest.mark.parametrize("task", TASKS)
def test_nothing_is_done_at_the_start(task):
    """A judge that a scene satisfies already would judge nothing."""
    for seed in range(10):
        problem = make_problem(REGISTRY, RunOptions(task=f"ycb/{task}", method="proc3s", seed=seed))
        score, reason = judge(problem, problem.initial, ())
        assert score is not None
        assert not score.reached, reason


def test_the_text_gives_every_body_its_size():
    bodies = bodies_of(YCB.spec.world.args["bodies"])
    sizes = YCB.spec.constants["SIZES"].value
    assert [*bodies] == [*sizes] == YCB.spec.constants["CATEGORIES"].value
    for name, body in bodies.items():
        corners = body.shape.corners()
        measured = np.stack([corners.min(axis=0), corners.max(axis=0)], axis=1)
        assert sizes[name] == pytest.approx(measured, abs=6e-4), name


def test_programs_make_grasps_by_numpy_and_by_hand():
    source = """
def gen_plan(initial):
    berry = initial["object_1"]
    by_hand = ArrangePose(x=0.0, y=0.0, z=0.005, roll=0.0, pitch=math.pi, yaw=0.5)
    by_numpy = np.array([0.0, 0.0, 0.005, 0.0, np.pi, 0.5])
    assert [*by_hand] == list(by_numpy) and list(by_hand.point) == [0, 0, 0.005]
    assert list(by_hand.euler) == [0, np.pi, 0.5]
    spot = berry.pose.multiply(ArrangePose(0.1, 0.0, 0.0))
    return [Action("pick", [berry.body, by_numpy]), Action("place", ["object_1", by_hand, spot])]
"""
    state = YCB.scene(YCB.spec.tasks["packing"], 0)
    with box(YCB, source, "program", state) as sketch:
        pick, place = sketch.plans(np.zeros((1, 0)), first=0).plan(0)
    assert pick.args[1] == place.args[1]
    pose = state.objects["object_1"].pose
    moved = np.hypot(place.args[2].x - pose.x, place.args[2].y - pose.y)
    assert (moved, place.args[2].yaw) == pytest.approx((0.1, pose.yaw))


def test_every_task_has_bundled_answers():
    names = {path.name for path in (YCB.spec.folder / "answers").glob("*.md")}
    for task, suffix in itertools.product(TASKS, ("proc3s", "cap.seed0", "llm3.seed0")):
        assert f"{task}.{suffix}.md" in names


def example_problem():
    problem = make_problem(REGISTRY, RunOptions(task="ycb/packing", method="proc3s"))
    state = YCB.scene(EXAMPLE, EXAMPLE.seed)
    scene = json.dumps(YCB.states.dump(state))
    return dataclasses.replace(problem, task=EXAMPLE, scene=scene, goal=EXAMPLE.instruction)


def answers_of_example(kind):
    turns = list(example_turns(example_problem(), EXAMPLE, kind))
    return [text for turn, text in turns if turn == "answer"], [t for turn, t in turns if turn == "feedback"]


def test_the_example_fails_as_its_feedback_says_and_then_succeeds():
    problem = example_problem()
    (first, second), (feedback,) = answers_of_example("sketch")
    with box(YCB, extract_program(first), "sketch", problem.initial) as sketch:
        failed = [trial.violations[0] for trial in trials(sketch, problem, 12)]
    for violation in failed:
        assert f"step {violation.step}, action {violation.skill}: {violation.text}" in feedback
    assert len({violation.step for violation in failed}) == 2
    with box(YCB, extract_program(second), "sketch", problem.initial) as sketch:
        accepted = next(trial for trial in trials(sketch, problem, 60) if trial.accepted)
    assert reaches_goal(problem, accepted.plan)


@pytest.mark.parametrize(("kind", "answer"), [("program", "program"), ("plan", "plan")])
def test_the_example_shows_plans_that_reach_its_goal(kind, answer):
    problem = example_problem()
    (text,), _ = answers_of_example(kind)
    with box(YCB, extract_program(text), answer, problem.initial) as sketch:
        plan = sketch.plans(np.zeros((1, 0)), first=0).plan(0)
    assert reaches_goal(problem, plan)


@pytest.mark.slow
def test_a_check_finds_nothing_wrong_and_says_how_true_the_bodies_are(cli):
    report = cli("check", "ycb", "--json", "--seconds", 5).json
    assert (report["errors"], report["findings"]) == (0, [])
    told = [re.fullmatch(r"(\w+): \d+ convex pieces?, (\d\.\d) mm off the mesh", f) for f in report["facts"]]
    off = {found[1]: float(found[2]) for found in told}
    assert off.keys() == YCB.spec.world.args["bodies"].keys()
    assert max(off.values()) < 2.0


@pytest.mark.slow
def test_two_objects_are_stacked_from_end_to_end(run):
    summary = run("stacking", 0)
    assert (summary["solved"], summary["goal_reached"]) == (True, True), summary
    assert summary["goal_reason"] == "object_3 (the red strawberry) rests on object_2 (the blue meat_can)"


@pytest.mark.slow
@pytest.mark.parametrize(("task", "seed"), [*itertools.product(TASKS, range(10))])
def test_the_bundled_program_solves_every_seed(task, seed, run):
    summary = run(task, seed, "--audit", 20)
    assert (summary["solved"], summary["goal_reached"], summary["rounds"]) == (True, True, 0), summary


@pytest.mark.slow
@pytest.mark.parametrize(("task", "method"), [*itertools.product(TASKS, ("cap", "llm3"))])
def test_the_bundled_plans_of_seed_0_reach_the_goal(task, method, run):
    summary = run(task, 0, "--method", method)
    assert (summary["solved"], summary["goal_reached"]) == (True, True), summary
