"""Screens of the table-top reject only what the world rejects, and say the same of it."""

import dataclasses
import json

import numpy as np
import pytest
from blocks_domain import belief, blocks_domain
from hypothesis import given, settings
from hypothesis import strategies as st
from test_actions import PASS, A, B, C, place

from proc3s import Action, PlanBatch, Problem
from proc3s.benchmark.cases import find_cases
from proc3s.benchmark.measurement import SCREENED
from proc3s.benchmark.throughput import Bench
from proc3s.domain.world import make_world
from proc3s.plugins.registry import open_registry
from proc3s.search.rollout import carry_out
from proc3s_tabletop.screens.geometry import geometry, reach

DOMAIN = blocks_domain()
THINGS = [
    ("block", "red", *A),
    ("block", "blue", *B),
    ("block", "green", *C),
    ("bowl", "red", 0, -0.65, 0.025),
]
SCENE = belief(DOMAIN, *THINGS)
SIGNATURES = DOMAIN.signatures(SCENE)
NAMES = [signature.skill for signature in SIGNATURES]
PICK_A, PICK_B = ("pick", *A), ("pick", *B)


def batch_of(plans):
    """Plans as lists of (skill, x, y, z) in columns."""
    actions = [action for plan in plans for action in plan]
    return PlanBatch(
        SIGNATURES,
        np.cumsum([0, *(len(plan) for plan in plans)]),
        np.array([NAMES.index(skill) for skill, *_ in actions], np.uint8),
        3 * np.arange(len(actions) + 1),
        np.array([value for _, *point in actions for value in point], float),
    )


def verdict(plan, scene=SCENE, domain=DOMAIN):
    """What the first screen to reject a plan says."""
    return geometry(scene, batch_of([plan]), domain)[0] or reach(scene, batch_of([plan]), domain)[0]


def world_says(plan, scene):
    """The first violation in the world."""
    made = open_registry().domain("blocks")
    world = make_world(made)
    try:
        as_json = json.dumps(made.states.dump(scene))
        problem = Problem(made, made.spec.tasks["line"], as_json, goal="", seed=0, samples=1)
        actions = tuple(Action(skill, tuple(map(float, point))) for skill, *point in plan)
        return carry_out(world, problem, actions)[0].violations[0]
    finally:
        world.close()


@pytest.mark.parametrize("name", PASS)
def test_what_passes_in_the_world_passes_the_screens(name):
    assert verdict(PASS[name]) is None


ON_B = [PICK_A, place(0.0, -0.5, 0.06)]
REJECTED = {
    "fingers on the block": ("grasp", [("pick", -0.15, -0.475, 0.02)]),
    "nothing there": ("grasp", [("pick", -0.05, -0.3, 0.02)]),
    "where the block was": ("grasp", [PICK_A, place(-0.1, -0.35, 0.02), PICK_A]),
    "25 mm off along the pads": ("grasp", [("pick", -0.125, -0.5, 0.02)]),
    "fingers in the table": ("collision", [("pick", -0.15, -0.5, 0.0)]),
    "full hand": ("grasp", [PICK_A, PICK_B]),
    "empty hand": ("placement", [place(0.0, -0.3, 0.02)]),
    "outside the table": ("placement", [PICK_A, place(0.31, -0.5, 0.02)]),
    "a stack nobody asked for": ("collision", [PICK_A, place(0.0, -0.5, 0.02)]),
    "no room for a finger": ("collision", [PICK_A, place(0.0, -0.445, 0.02)]),
    "no room for the opening finger": ("collision", [PICK_A, place(0.0, -0.4325, 0.02)]),
    "finger on the bowl": ("collision", [PICK_A, place(0.0, -0.55, 0.02)]),
    "dropped from high": ("placement", [PICK_A, place(-0.1, -0.35, 0.06)]),
    "beyond the edge of its support": ("placement", [PICK_A, place(0.026, -0.5, 0.06)]),
    "under another": ("collision", [*ON_B, PICK_B]),
}
OWN_WORDS = ("under another", "finger on the bowl")
"""Where screen and world see different things that are both wrong."""


@pytest.mark.parametrize("name", REJECTED)
def test_what_is_certain_to_fail_is_rejected(name):
    constraint, plan = REJECTED[name]
    found = verdict(plan)
    assert found is not None
    assert (found.constraint, found.step, found.skill) == (constraint, len(plan) - 1, plan[-1][0])
    assert found.margin < 0


@pytest.mark.parametrize("name", [name for name in REJECTED if name not in OWN_WORDS])
def test_the_world_says_the_same(name):
    plan = REJECTED[name][1]
    screen, world = verdict(plan), world_says(plan, SCENE)
    assert (screen.constraint, screen.step, screen.text) == (world.constraint, world.step, world.text)


actions = st.tuples(
    st.sampled_from(NAMES), st.floats(-0.3, 0.3), st.floats(-0.8, -0.2), st.sampled_from([0.0, 0.02, 0.06])
)
near = st.builds(
    lambda what, dx, dy: ("pick", what[0] + dx, what[1] + dy, what[2]),
    st.sampled_from([A, B, C]),
    st.floats(-0.01, 0.01),
    st.floats(-0.01, 0.01),
)
plans = st.lists(st.one_of(near, actions), min_size=1, max_size=5)


@settings(max_examples=60, deadline=None)
@given(st.lists(plans, min_size=1, max_size=5))
def test_a_verdict_does_not_depend_on_the_batch(batch):
    for screen in (geometry, reach):
        together = screen(SCENE, batch_of(batch), DOMAIN)
        assert together == [screen(SCENE, batch_of([plan]), DOMAIN)[0] for plan in batch]


def test_what_no_branch_of_the_arm_reaches_is_rejected():
    high = [PICK_A, place(0.0, -0.5, 0.9)]
    assert (
        geometry(SCENE, batch_of([[PICK_A]]), DOMAIN) == reach(SCENE, batch_of([[PICK_A]]), DOMAIN) == [None]
    )
    found = reach(SCENE, batch_of([high]), DOMAIN)[0]
    assert (found.constraint, found.step) == ("kinematic", 1)
    assert found.text == world_says(high, SCENE).text


def changed(**fields):
    return dataclasses.replace(DOMAIN, spec=DOMAIN.spec.model_copy(update=fields))


def test_a_domain_without_the_constraint_rejects_nothing_for_it():
    kept = {name: spec for name, spec in DOMAIN.spec.constraints.items() if name != "grasp"}
    assert verdict(REJECTED["nothing there"][1], domain=changed(constraints=kept)) is None
    assert verdict(REJECTED["empty hand"][1], domain=changed(constraints=kept)) is not None


def test_another_tolerance_is_kept():
    loose = DOMAIN.spec.constraints["placement"].model_copy(update={"tolerance": 0.1})
    domain = changed(constraints={**DOMAIN.spec.constraints, "placement": loose})
    assert verdict(REJECTED["outside the table"][1], domain=domain) is None


def test_a_skill_of_another_kind_is_left_to_the_world():
    own = DOMAIN.spec.skills["pick"].model_copy(update={"target": "own_skills:grab"})
    domain = changed(skills={**DOMAIN.spec.skills, "pick": own})
    assert verdict(REJECTED["nothing there"][1], domain=domain) is None
    assert verdict([("pick", 0.0, -1.2, 0.02), *REJECTED["empty hand"][1]], domain=domain) is None


def test_turned_and_leaning_blocks_and_an_empty_table_are_no_trouble():
    turned = belief(DOMAIN, ("block", "red", *A, 0.0, 0.0, 0.6), ("block", "blue", *B, 0.4, 0.0, 0.0))
    assert verdict([PICK_A], scene=turned) is None
    assert verdict([PICK_B], scene=turned) is None
    assert verdict([("pick", 0.1, -0.3, 0.02)], scene=turned).constraint == "grasp"
    assert geometry(belief(DOMAIN), batch_of([[PICK_A]]), DOMAIN) == [None]


CASES = [case for case in find_cases(open_registry()) if case.task.startswith("blocks/")]


@pytest.mark.slow
def test_at_most_one_reject_in_two_hundred_is_wrong():
    """On every program and scene of the benchmark; what the screens reject is put to the world."""
    audited = wrong = 0
    with Bench(open_registry(), []) as bench:
        for case in CASES:
            for seed in (0, 1):
                screened = bench.stream(case, seed, SCREENED, 256)
                audited, wrong = audited + screened.audited, wrong + screened.wrong
    assert audited > 300
    assert wrong <= audited / 200
