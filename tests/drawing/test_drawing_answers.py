"""Every bundled answer and every worked example runs and does what it says."""

import re

import numpy as np
import pytest

from boxing import box
from proc3s import MethodSpec, PresetSpec
from proc3s.domain.world import make_world
from proc3s.planning.options import RunOptions
from proc3s.planning.setup import make_problem
from proc3s.plugins.registry import open_registry
from proc3s.prompts.examples import example_turns
from proc3s.prompts.extract import extract_program
from proc3s.search.evaluator import Evaluator
from proc3s.search.rollout import carry_out

REGISTRY = open_registry()
DRAWING = REGISTRY.domain("drawing")
ANSWERS = sorted((DRAWING.spec.folder / "answers").glob("*.md"))


def accepted_plan(sketch, problem, samples, seed=0):
    """The first plan that the world accepts."""
    from proc3s_executors.serial import Serial

    executor = Serial()
    u = np.random.default_rng(seed).random((samples, sketch.space.dim))
    try:
        return next((t.plan for t in Evaluator(problem, sketch, executor).stream(u) if t.accepted), None)
    finally:
        executor.close()


def test_answers_are_there_as_the_readme_promises():
    names = {path.name for path in ANSWERS}
    for task in ("star", "arrow", "letters", "enclosed"):
        assert f"{task}.proc3s.md" in names
        assert f"{task}.cap.seed0.md" in names
        assert f"{task}.llm3.seed0.md" in names
    assert any(".round1." in name for name in names)


@pytest.mark.parametrize("path", ANSWERS, ids=lambda path: path.name)
def test_an_authored_answer_runs(path):
    text = path.read_text(encoding="utf-8")
    assert text.startswith("---\norigin: authored\n---\n")
    task, template, *_ = path.name.split(".")
    answer = {"proc3s": "sketch", "cap": "program", "llm3": "plan"}[template]
    problem = make_problem(REGISTRY, RunOptions(task=f"drawing/{task}"))
    with box(DRAWING, extract_program(text), answer, problem.initial) as sketch:
        batch = sketch.plans(
            np.random.default_rng(0).random((50 if sketch.space.dim else 1, sketch.space.dim))
        )
        assert not batch.errors
        assert all(batch.plan(i) for i in range(len(batch)))


@pytest.mark.parametrize("kind", ["sketch", "program", "plan"])
def test_the_square_of_the_worked_example_is_a_square(kind):
    example = DRAWING.spec.examples["square"]
    state = DRAWING.scene(example, example.seed)
    problem = make_problem(REGISTRY, RunOptions(task="drawing/free", goal=example.instruction))
    import dataclasses
    import json

    problem = dataclasses.replace(problem, scene=json.dumps(DRAWING.states.dump(state)))
    ((turn, text),) = example_turns(problem, example, kind)
    assert turn == "answer"
    with box(DRAWING, extract_program(text), kind, state) as sketch:
        plan = accepted_plan(sketch, problem, 300 if kind == "sketch" else 1)
    assert plan is not None
    trial, _ = carry_out(make_world(DRAWING), problem, plan, stop=False)
    assert not trial.violations
    lines = np.array([action.args for action in plan]).reshape(-1, 2, 2)
    assert len(lines) == 4
    sides = lines[:, 1] - lines[:, 0]
    assert np.allclose(lines[:, 1], np.roll(lines[:, 0], -1, axis=0))
    assert ((np.abs(sides) < 1e-9).sum(axis=1) == 1).all()
    lengths = np.linalg.norm(sides, axis=1)
    assert lengths.min() > 5
    assert np.allclose(lengths, lengths[0])


def test_the_worked_example_tells_the_truth_about_its_scene():
    example = DRAWING.spec.examples["square"]
    state = DRAWING.scene(example, example.seed)
    problem = make_problem(REGISTRY, RunOptions(task="drawing/free", goal="x"))
    ((_, text),) = example_turns(problem, example, "plan")
    told = {tuple(map(int, pair)) for pair in re.findall(r"\((\d+), (\d+)\)", text)}
    assert {(round(o.x_pos), round(o.y_pos)) for o in state.obstacles} <= told


def test_no_worked_example_is_a_task():
    told = {e.instruction for e in DRAWING.spec.examples.values()}
    assert not told & {t.instruction for t in DRAWING.spec.tasks.values()}


@pytest.mark.parametrize("method", list(REGISTRY.all(MethodSpec)))
def test_every_method_has_a_worked_example(method):
    spec = REGISTRY.get(MethodSpec, method)
    problem = make_problem(REGISTRY, RunOptions(task="drawing/star"))
    turns = example_turns(problem, DRAWING.spec.examples["square"], spec.answer)
    assert turns[-1][0] == "answer"
    assert extract_program(turns[-1][1])


@pytest.mark.parametrize("preset", list(REGISTRY.all(PresetSpec)))
def test_every_task_has_a_budget_in_every_preset(preset):
    for task in DRAWING.spec.tasks:
        assert (
            make_problem(REGISTRY, RunOptions(task=f"drawing/{task}", goal="x", preset=preset)).samples
            == 10000
        )
