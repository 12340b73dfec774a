import math

import pytest
from blocks_domain import belief, blocks_domain

from proc3s import Action
from proc3s.domain.margins import check
from proc3s.domain.world import make_world

A, B, C = (-0.15, -0.5, 0.02), (0.0, -0.5, 0.02), (0.15, -0.5, 0.02)
BOWL = (0.0, -0.65, 0.025)
RED, BLUE, GREEN = "object_0 (the red block)", "object_1 (the blue block)", "object_2 (the green block)"
PICK_A = ("pick", *A)


@pytest.fixture(scope="module")
def domain():
    return blocks_domain()


@pytest.fixture(scope="module")
def world(domain):
    made = make_world(domain)
    yield made
    made.close()


@pytest.fixture
def carry_out(domain, world):
    """Do actions until one violates something: index of the step, violations, margins of all steps."""

    def run(*actions, extra=()):
        things = (("block", "red", *A), ("block", "blue", *B), ("block", "green", *C))
        world.reset(belief(domain, *things, ("bowl", "yellow", *BOWL), *extra))
        seen = []
        for step, (skill, *point) in enumerate(actions):
            margins, violations, _ = check(domain, world.step(Action(skill, tuple(point))), step)
            seen.append(margins)
            if violations:
                return step, violations, seen
        return None, [], seen

    return run


def place(x, y, z):
    return ("place", x, y, z)


VIOLATIONS = {
    "pick out of reach": ("kinematic", "cannot reach", [("pick", 0.0, -1.2, 0.02)]),
    "place out of reach": ("kinematic", "cannot reach", [PICK_A, place(0.0, -1.2, 0.02)]),
    "pick below the table": (
        "collision",
        "the gripper collides with the table",
        [("pick", -0.15, -0.5, 0.0)],
    ),
    "pick of a block under another": (
        "collision",
        f"the gripper collides with {RED} on its way to the grasp",
        [PICK_A, place(0.0, -0.5, 0.06), ("pick", *B)],
    ),
    "place where a finger has no room": (
        "collision",
        f"the gripper collides with {BLUE}",
        [PICK_A, place(0.0, -0.445, 0.02)],
    ),
    "a stack that nobody asked for": (
        "collision",
        f"{RED} in the hand collides with {BLUE} far above the z",
        [PICK_A, place(0.0, -0.5, 0.02)],
    ),
    "the object in hand on its way": (
        "collision",
        "in the hand collides with object_",
        [PICK_A, place(0.15, -0.5, 0.02)],
    ),
    "pick of nothing": (
        "grasp",
        f"nothing is between the fingers; the nearest object is {BLUE}",
        [("pick", 0.03, -0.35, 0.02)],
    ),
    "pick where the object was": (
        "grasp",
        f"nothing is between the fingers; the nearest object is {RED}",
        [PICK_A, place(-0.15, -0.36, 0.02), PICK_A],
    ),
    "grasp off centre": ("grasp", f"too little of {RED}", [("pick", -0.132, -0.5, 0.02)]),
    "fingers on the object itself": (
        "grasp",
        f"the fingers come down on {RED} instead of around it",
        [("pick", -0.15, -0.475, 0.02)],
    ),
    "pick with a full hand": ("grasp", f"the hand already holds {RED}", [PICK_A, ("pick", *B)]),
    "place of nothing": ("placement", "nothing in the hand", [place(0.0, -0.3, 0.02)]),
    "stack off centre": (
        "placement",
        f"{RED} does not stay where it is released",
        [PICK_A, place(0.022, -0.5, 0.06)],
    ),
    "release above the support": (
        "placement",
        f"{RED} would be dropped from high above the table",
        [PICK_A, place(-0.1, -0.35, 0.05)],
    ),
    "release far above the support": (
        "placement",
        f"{RED} would be dropped from high above the table",
        [PICK_A, place(-0.1, -0.35, 0.12)],
    ),
    "place beside the table": (
        "placement",
        f"{RED} lies outside the bounds of the table",
        [PICK_A, place(-0.32, -0.5, 0.02)],
    ),
}
TOWER = [("block", "white", *C[:2], 0.06), ("block", "white", *C[:2], 0.10), ("block", "white", *C[:2], 0.14)]


@pytest.mark.parametrize("name", VIOLATIONS)
def test_what_goes_wrong_is_a_violation_at_its_step(carry_out, name):
    constraint, text, actions = VIOLATIONS[name]
    step, violations, seen = carry_out(*actions, extra=TOWER if "on its way" in name else ())
    assert step == len(actions) - 1, violations
    assert violations[0].constraint == constraint, violations
    assert text in violations[0].text
    assert violations[0].margin < 0
    assert all(math.isfinite(margin) for margins in seen for margin in margins.values())


def test_an_object_that_is_knocked_over_is_named(carry_out):
    """The overhanging block stands alone, but not with another on its overhang."""
    lid = ("block", "white", 0.165, -0.5, 0.06)
    step, violations, _ = carry_out(PICK_A, place(0.18, -0.5, 0.10), extra=[lid])
    assert step == 1
    assert violations[0].constraint == "placement"
    assert violations[0].text == (
        f"{RED} does not stay where it is released, and object_4 (the white block) is knocked over"
    )


PASS = {
    "plain": [PICK_A, place(-0.1, -0.35, 0.02)],
    "z = 0": [PICK_A, place(-0.1, -0.35, 0.0)],
    "stack, z of its centre": [PICK_A, place(0.0, -0.5, 0.06)],
    "stack, z of the top of its support": [PICK_A, place(0.0, -0.5, 0.04)],
    "bowl": [PICK_A, place(0.0, -0.65, 0.02)],
    "twice": [PICK_A, place(-0.1, -0.35, 0.02), ("pick", *B), place(-0.1, -0.35, 0.06)],
}


@pytest.mark.parametrize("name", PASS)
def test_what_goes_well_has_margins_of_at_least_zero(carry_out, name):
    step, violations, seen = carry_out(*PASS[name])
    assert (step, violations) == (None, [])
    assert [set(margins) for margins in seen[:2]] == [
        {"kinematic", "collision", "grasp", "placement"},
        {"kinematic", "collision", "placement"},
    ]
    assert all(0 <= margin < 0.1 for margins in seen for margin in margins.values())


def test_margins_shrink_towards_the_violation(carry_out):
    """Further off the grasp is nearer to losing it, higher above the support nearer to dropping it."""
    covers = [carry_out(("pick", -0.15 + off, -0.5, 0.02))[2][0]["grasp"] for off in (0.0, 0.014, 0.018)]
    assert covers == sorted(covers, reverse=True)
    assert covers[1] > 0 > covers[2]
    drops = [carry_out(PICK_A, place(-0.1, -0.35, z))[2][1]["placement"] for z in (0.03, 0.04, 0.05, 0.06)]
    assert drops == sorted(drops, reverse=True)
    assert drops[1] > 0 > drops[2]


def test_the_constraints_are_checked_in_the_order_of_the_paper(domain):
    assert list(domain.spec.constraints) == ["kinematic", "collision", "grasp", "placement"]
    assert all(spec.rule for spec in domain.spec.constraints.values())
