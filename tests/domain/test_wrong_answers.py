"""What a plugin's function returned is not what it must: which function, what, and what it must return."""

import dataclasses

import numpy as np
import pytest

import toy_world
from proc3s import Action, PlanBatch, Rollouts, Score, SpecError
from proc3s.domain.world import make_world
from proc3s.plugins.registry import open_registry
from proc3s.search.rollout import carry_out, judge
from proc3s.search.screens import BatchScreen
from proc3s.specs.base import Target
from proc3s.specs.domain import ScreenSpec

SLIDE = Action("slide", ("object_0", 3.0))


def target(name, answer):
    return Target(target=f"wrong_answers:{name}", args={"answer": answer})


def screened(tmp_path, screen):
    """The toy problem with one screen."""
    problem = toy_world.problem(tmp_path)
    spec = problem.domain.spec.model_copy(update={"screens": (screen,)})
    return dataclasses.replace(problem, domain=dataclasses.replace(problem.domain, spec=spec))


@pytest.mark.parametrize(
    "answer", ["bool", "none", "string", "pair", "mapping", "unsure", "speechless", "lost", "off"]
)
def test_a_judge_says_a_score(tmp_path, answer):
    problem = toy_world.problem(tmp_path)
    task = problem.task.model_copy(update={"judge": (target("judge", answer),)})
    words = r"judge wrong_answers:judge of toy/shift: .*returned .*, not a Score of a bool and a reason in"
    with pytest.raises(SpecError, match=words):
        judge(dataclasses.replace(problem, task=task), problem.initial, ())


def test_a_score_of_numpy_is_one(tmp_path):
    problem = toy_world.problem(tmp_path)
    task = problem.task.model_copy(update={"judge": (target("judge", "numpy"),)})
    score, _ = judge(dataclasses.replace(problem, task=task), problem.initial, ())
    assert score.reached is True
    assert score.margin is None


def test_the_margin_of_a_goal_is_the_least_that_its_judges_say(tmp_path):
    problem = toy_world.problem(tmp_path)
    judges = tuple(target("judge", answer) for answer in ("wide", "numpy", "narrow"))
    task = problem.task.model_copy(update={"judge": judges})
    score, _ = judge(dataclasses.replace(problem, task=task), problem.initial, ())
    assert score == Score(True, "far off; all well; near", 0.25)
    assert type(score.margin) is float


@pytest.mark.parametrize("answer", ["bool", "none", "string", "pair", "nan"])
def test_a_scene_is_a_dict(tmp_path, answer):
    domain = toy_world.domain(tmp_path)
    task = domain.spec.tasks["shift"].model_copy(update={"initial": target("initial", answer)})
    words = r"scene of shift \(wrong_answers:initial\): .*returned .*, not a dict of the fields of a Scene"
    with pytest.raises(SpecError, match=words):
        domain.scene(task, 0)


@pytest.mark.parametrize("answer", ["string", "pair", "mapping", "unsure", "nan", "no number", "nameless"])
def test_a_constraint_says_a_margin(tmp_path, answer):
    problem = toy_world.problem(tmp_path)
    rule = problem.domain.spec.constraints["on_wire"].model_copy(update=vars(target("margin", answer)))
    spec = problem.domain.spec.model_copy(update={"constraints": {"on_wire": rule}})
    problem = dataclasses.replace(problem, domain=dataclasses.replace(problem.domain, spec=spec))
    with pytest.raises(SpecError, match=r"constraint on_wire: .*returned .*, not a margin"):
        carry_out(make_world(problem.domain), problem, (SLIDE,))


@pytest.mark.parametrize("answer", ["bool", "none", "string", "pair", "mapping"])
def test_a_screen_says_a_violation_or_none_for_every_plan(tmp_path, answer):
    screen = ScreenSpec(name="quick", **vars(target("screen", answer)))
    problem = screened(tmp_path, screen)
    none = np.zeros(0, np.int64)
    batch = PlanBatch((), np.zeros(2, np.int64), none.astype(np.uint8), none, np.zeros(0))
    with pytest.raises(SpecError, match=r"screen quick: .*returned .*, not a list with a Violation or None"):
        BatchScreen(screen, problem)(batch)


@pytest.mark.parametrize("answer", ["bool", "string", "pair", "mapping"])
def test_a_stateful_screen_says_a_violation_or_none(tmp_path, answer):
    screen = ScreenSpec(name="slow", stateful=True, **vars(target("Stateful", answer)))
    rollouts = Rollouts(screened(tmp_path, screen))
    with pytest.raises(SpecError, match=r"screen slow: .*returned .*, not a Violation or None"):
        rollouts((SLIDE,))


@pytest.mark.parametrize("name", ["drawing", "blocks"])
def test_a_skill_returns_what_its_world_measures(name):
    domain = open_registry().domain(name)
    skill = next(iter(domain.spec.skills.values())).model_copy(update={"target": "wrong_answers:skill"})
    spec = domain.spec.model_copy(update={"skills": {skill.name: skill}})
    domain = dataclasses.replace(domain, spec=spec)
    world = make_world(domain)
    try:
        world.reset(domain.scene(next(iter(spec.tasks.values())), 0))
        with pytest.raises(
            SpecError, match=rf"skill {skill.name}: .*returned None, not a (Stroke|Telemetry)"
        ):
            world.step(Action(skill.name, tuple(np.zeros(len(skill.params)).tolist())))
    finally:
        world.close()


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (["a", "b", "a"], "beads.2: 'a' is the name of beads.0, too"),
        (["a", ""], "beads.1: '' is no name of an object"),
        (["  ", "b"], "beads.0: '  ' is no name of an object"),
    ],
)
def test_objects_have_names_of_their_own(tmp_path, names, words):
    domain = toy_world.domain(tmp_path)
    task = domain.spec.tasks["shift"]
    named = Target(target="wrong_answers:beads", args={"names": names})
    with pytest.raises(SpecError, match=rf"scene of shift \(wrong_answers:beads\): {words}"):
        domain.scene(task.model_copy(update={"initial": named}), 0)


def test_the_keys_of_a_mapping_are_names_too():
    blocks = open_registry().domain("blocks")
    task = blocks.spec.tasks["line"].model_copy(
        update={"initial": Target(target="wrong_answers:nameless_block")}
    )
    with pytest.raises(SpecError, match=r"objects.0: '' is no name of an object"):
        blocks.scene(task, 0)
