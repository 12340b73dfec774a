import pytest
from tables import carry_out, moves

A, B, C = (-0.15, -0.5, 0.02), (0.0, -0.5, 0.02), (0.15, -0.5, 0.02)
PICK_A = ("pick", *A)


def place(x, y, z):
    return ("place", x, y, z)


PASS = {
    "plain pick and place": [PICK_A, place(-0.1, -0.35, 0.02)],
    "grasp 10 mm off along the pads": [("pick", -0.14, -0.5, 0.02), place(-0.1, -0.35, 0.02)],
    "grasp 10 mm off along the closing direction": [("pick", -0.15, -0.49, 0.02), place(-0.1, -0.35, 0.02)],
    "stack": [PICK_A, place(0.0, -0.5, 0.06)],
    "stack 10 mm off along x": [PICK_A, place(0.01, -0.5, 0.06)],
    "stack 10 mm off along y": [PICK_A, place(0.0, -0.49, 0.06)],
    "stack, z of the top of the support": [PICK_A, place(0.0, -0.5, 0.04)],
    "place, z = 0": [PICK_A, place(-0.1, -0.35, 0.0)],
    "place, z = twice the half block": [PICK_A, place(-0.1, -0.35, 0.04)],
    "into the bowl": [PICK_A, place(0.0, -0.65, 0.03)],
    "bridge over a gap of 20 mm": [PICK_A, place(0.09, -0.5, 0.02), ("pick", *B), place(0.12, -0.5, 0.06)],
    "beside a block along x": [PICK_A, place(0.045, -0.5, 0.02)],
    "beside a block along y, with room for a finger": [PICK_A, place(0.0, -0.42, 0.02)],
}


@pytest.mark.parametrize("name", PASS)
def test_passes(table, name):
    world = table({"a": A, "b": B, "c": C, "bowl": (0.0, -0.65, 0.025)})
    passed, reason, seen = carry_out(world, PASS[name])
    assert (passed, reason) == (len(PASS[name]), None), seen[-1]


FAIL = {
    "grasp 25 mm off along the pads": ("grasp", [("pick", -0.125, -0.5, 0.02)]),
    "grasp 18 mm off along the pads": ("grasp", [("pick", -0.132, -0.5, 0.02)]),
    "grasp 25 mm off along the closing direction": ("approach", [("pick", -0.15, -0.475, 0.02)]),
    "pick of nothing": ("grasp", [("pick", -0.05, -0.3, 0.02)]),
    "pick below the table": ("approach", [("pick", -0.15, -0.5, 0.0)]),
    "pick out of reach": ("reach", [("pick", 0.0, -1.2, 0.02)]),
    "pick with a full hand": ("hand", [PICK_A, ("pick", *B)]),
    "place with nothing in hand": ("hand", [place(0.0, -0.3, 0.02)]),
    "place out of reach": ("reach", [PICK_A, place(0.0, -1.2, 0.02)]),
    "pick of a block under another": ("approach", [PICK_A, place(0.0, -0.5, 0.06), ("pick", *B)]),
    "stack 22 mm off along x": ("unstable", [PICK_A, place(0.022, -0.5, 0.06)]),
    "stack 22 mm off along y": ("unstable", [PICK_A, place(0.0, -0.478, 0.06)]),
    "bridge past the edge": (
        "unstable",
        [PICK_A, place(0.09, -0.5, 0.02), ("pick", *B), place(0.173, -0.5, 0.06)],
    ),
    "release 30 mm above the support": ("drop", [PICK_A, place(-0.1, -0.35, 0.05)]),
    "release far above the support": ("support", [PICK_A, place(-0.1, -0.35, 0.12)]),
    "stack that nobody asked for": ("high", [PICK_A, place(0.0, -0.5, 0.02)]),
    "run into a block from above its side": ("high", [PICK_A, place(0.03, -0.5, 0.02)]),
    "beside a block along y, no room for a finger": ("descent", [PICK_A, place(0.0, -0.445, 0.02)]),
}


@pytest.mark.parametrize("name", FAIL)
def test_fails(table, name):
    world = table({"a": A, "b": B, "c": C, "bowl": (0.0, -0.65, 0.025)})
    expected, actions = FAIL[name]
    passed, reason, seen = carry_out(world, actions)
    assert (passed, reason) == (len(actions) - 1, expected), seen[-1]


def test_an_action_that_ends_early_leaves_the_world_as_it_was(table):
    world = table({"a": A, "b": B})
    before = world.snapshot
    assert world.pick(-0.125, -0.5, 0.02).ended == "grasp"
    assert world.snapshot == before
    world.pick(*A)
    carrying = world.snapshot
    telemetry = world.place(0.0, -0.445, 0.02)
    assert (telemetry.ended, telemetry.held) == ("descent", "a")
    assert world.snapshot == carrying


def test_a_pick_says_what_it_holds_and_how(table):
    world = table({"a": A, "b": B})
    telemetry = world.pick(-0.15, -0.495, 0.02)
    assert (telemetry.target, telemetry.held, telemetry.ended) == ("a", "a", None)
    assert telemetry.ik_residual < 1e-6
    assert telemetry.cover == 1.0
    assert telemetry.finger_gap == pytest.approx(0.04, abs=5e-4)
    assert telemetry.grip_force > 5
    assert telemetry.slip < 1e-3
    assert telemetry.slip_angle < 0.02
    assert [d.name for d in telemetry.displacements] == ["b"]


def test_a_place_says_where_the_support_was_met(table):
    world = table({"a": A, "b": B})
    world.pick(*A)
    telemetry = world.place(0.0, -0.5, 0.05)
    assert (telemetry.target, telemetry.held, telemetry.support) == ("a", None, "b")
    assert telemetry.support_height == pytest.approx(0.01, abs=1e-3)
    world.pick(0.0, -0.5, 0.06)
    dropped = world.place(0.1, -0.4, 0.035)
    assert dropped.support == "table"
    assert dropped.support_height == pytest.approx(-0.015, abs=1e-3)
    assert moves(dropped)["a"].upright < 2e-3


def test_contacts_name_both_bodies(table):
    world = table({"a": A, "b": B})
    contact = world.pick(-0.15, -0.475, 0.02).clearance
    assert contact.distance < 0
    assert (contact.body, contact.other) == ("gripper", "a")
    table_contact = world.pick(0.1, -0.4, -0.01).clearance
    assert (table_contact.body, table_contact.other) == ("gripper", "table")
    world.pick(*A)
    world.place(0.0, -0.5, 0.06)
    under = world.pick(*B)
    assert (under.ended, under.clearance.body, under.clearance.other) == ("approach", "gripper", "a")


def test_the_held_object_is_tested_for_contact_on_the_way(table):
    tower = {"low": (0.0, -0.5, 0.02), "middle": (0.0, -0.5, 0.06), "high": (0.0, -0.5, 0.10)}
    world = table({"a": A, **tower, "top": (0.0, -0.5, 0.14)})
    world.pick(*A)
    telemetry = world.place(0.15, -0.5, 0.02)
    assert telemetry.ended == "carry"
    assert {telemetry.clearance.body, telemetry.clearance.other} & {"top", "high"}


def test_the_arm_does_not_run_into_itself(table):
    telemetry = table({"a": A}).pick(0.0, -0.2, 0.02)
    assert telemetry.ended == "approach"
    touching = {telemetry.clearance.body, telemetry.clearance.other}
    assert touching <= {"shoulder", "upper arm", "forearm", "wrist"}


def test_a_target_out_of_reach_is_missed_by_so_much(table):
    world = table({"a": A})
    near, far = world.pick(0.0, -1.0, 0.02), world.pick(0.0, -1.1, 0.02)
    assert (near.ended, far.ended) == ("reach", "reach")
    assert far.ik_residual - near.ik_residual == pytest.approx(0.1, abs=0.02)


def test_bounds_count_the_target_and_every_object(table):
    world = table({"a": A, "b": (0.28, -0.5, 0.02)})
    outside = world.pick(0.35, -0.5, 0.02).bounds
    assert (outside.name, outside.distance) == ("target", pytest.approx(-0.05))
    edge = world.pick(*A).bounds
    assert (edge.name, edge.distance) == ("b", pytest.approx(0.02, abs=1e-4))


def test_an_object_that_another_brings_down_is_knocked_over(table):
    """The overhanging block stands alone, but not with another on its overhang."""
    world = table({"a": A, "low": (0.0, -0.5, 0.02), "lid": (0.015, -0.5, 0.06)})
    world.pick(*A)
    telemetry = world.place(0.03, -0.5, 0.10)
    assert telemetry.knocked_over == ("lid",)
    assert moves(telemetry)["lid"].shift > 0.02
    assert moves(telemetry)["low"].shift < 0.002
