"""What is judged and screened is what was attempted, whatever a domain calls its skills and constraints."""

import dataclasses

import numpy as np
import pytest
from blocks_domain import belief, blocks_domain

from proc3s import Action, PlanBatch, SpecError
from proc3s.domain.margins import check
from proc3s.domain.world import make_world
from proc3s.specs.domain import ParamSpec
from proc3s_tabletop.screens.geometry import geometry, reach

A = (-0.15, -0.5, 0.02)
EMPTY, OFF, AWAY = (0.0, -0.3, 0.02), (-0.125, -0.5, 0.02), (0.0, -1.2, 0.02)
TOOLBOX = blocks_domain()


def renamed(targets, constraints=None):
    """Arrange-Blocks with other names: skill -> target, and constraint -> what the toolbox calls it."""
    skills = {
        name: TOOLBOX.spec.skills["pick"].model_copy(update={"name": name, "target": target})
        for name, target in targets.items()
    }
    known = TOOLBOX.spec.constraints
    kept = {n: known[old].model_copy(update={"name": n}) for n, old in (constraints or {}).items()} or known
    spec = TOOLBOX.spec.model_copy(update={"skills": skills, "constraints": kept})
    return dataclasses.replace(TOOLBOX, spec=spec)


SAME = {"grab": "proc3s_tabletop.skills:pick", "put": "proc3s_tabletop.skills:place"}
WRAPPED = {"grab": "own_skills:grab", "put": "own_skills:put"}
SWAPPED = {"place": "proc3s_tabletop.skills:pick", "pick": "proc3s_tabletop.skills:place"}


def told(domain, skill, *args):
    """What a first action violates in the world."""
    world = make_world(domain)
    try:
        world.reset(belief(domain, ("block", "red", *A)))
        _, found, _ = check(domain, world.step(Action(skill, args)), 0)
    finally:
        world.close()
    return [(violation.constraint, violation.margin, violation.text) for violation in found]


@pytest.mark.parametrize("targets", [SAME, WRAPPED, SWAPPED])
def test_the_world_says_the_same_of_a_skill_under_another_name(targets):
    grab, put = targets
    domain = renamed(targets)
    assert told(TOOLBOX, "place", *EMPTY)
    assert told(domain, put, *EMPTY) == told(TOOLBOX, "place", *EMPTY)
    assert told(TOOLBOX, "pick", *OFF)
    assert told(domain, grab, *OFF) == told(TOOLBOX, "pick", *OFF)
    assert told(domain, grab, *A) == []


def test_a_skill_with_other_parameters_is_judged_by_what_it_measured():
    domain = renamed({"grab": "own_skills:grab_beside"})
    params = {"o": ParamSpec(type="object"), "gap": ParamSpec()}
    skills = {"grab": domain.spec.skills["grab"].model_copy(update={"params": params})}
    domain = dataclasses.replace(domain, spec=domain.spec.model_copy(update={"skills": skills}))
    assert told(domain, "grab", "object_0", 0.0) == []
    (constraint, margin, text), *_ = told(domain, "grab", "object_0", 0.1)
    assert (constraint, round(margin, 3)) == ("grasp", -0.1)
    assert "the nearest object is object_0 (the red block)" in text


@pytest.mark.parametrize(
    ("target", "says"),
    [("put_then_grab", "2 times in one action"), ("put_and_keep_quiet", "other telemetry")],
)
def test_a_skill_whose_actions_nobody_could_judge_is_refused_by_name(target, says):
    with pytest.raises(SpecError, match=f"skill twice.*{says}"):
        told(renamed({"twice": f"own_skills:{target}"}), "twice", *A)


def screened(domain, *plan):
    """What the screens say of a plan of skills at points."""
    scene = belief(domain, ("block", "red", *A))
    signatures = domain.signatures(scene)
    names = [signature.skill for signature in signatures]
    skills = np.array([names.index(skill) for skill, _ in plan], np.uint8)
    values = np.array([value for _, at in plan for value in at], float)
    batch = PlanBatch(
        signatures, np.array([0, len(plan)]), skill=skills, offset=3 * np.arange(len(plan) + 1), values=values
    )
    found = geometry(scene, batch, domain)[0] or reach(scene, batch, domain)[0]
    return found and (found.constraint, found.skill, found.text)


@pytest.mark.parametrize("targets", [SAME, SWAPPED])
def test_a_screen_knows_the_toolbox_under_any_name(targets):
    grab, put = targets
    domain = renamed(targets)
    for skill, own, at in (("place", put, EMPTY), ("pick", grab, OFF), ("pick", grab, AWAY)):
        constraint, _, text = screened(TOOLBOX, (skill, at))
        assert screened(domain, (own, at)) == (constraint, own, text)


def test_a_screen_leaves_a_skill_of_another_function_to_the_world():
    domain = renamed({**WRAPPED, "take": SAME["grab"]})
    assert screened(domain, ("put", EMPTY)) is screened(domain, ("grab", OFF)) is None
    assert screened(domain, ("grab", A), ("take", A)) is None
    assert screened(domain, ("take", A), ("take", A))[:2] == ("grasp", "take")


def test_a_screen_knows_a_constraint_under_any_name():
    domain = renamed(SAME, {"grasp": "placement", "hold": "grasp"})
    assert screened(domain, ("put", EMPTY))[0] == "grasp"
    assert screened(domain, ("grab", OFF))[0] == "hold"
    assert screened(domain, ("grab", AWAY))[0] == "hold"
    domain = renamed(SAME, {"hold": "collision"})
    assert screened(domain, ("grab", OFF)) is screened(domain, ("grab", AWAY)) is None
