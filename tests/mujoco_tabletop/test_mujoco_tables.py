"""What tables in MuJoCo accept and refuse, and what they measure."""

import pytest

from proc3s_tabletop.actions.execution import Execution
from proc3s_tabletop.actions.reference import Reference
from proc3s_tabletop.objects.body import CATEGORIES, Body
from proc3s_tabletop.objects.shapes import Cylinder
from proc3s_tabletop.robot.frames import Frame

UPRIGHT = (0.0, 0.0, 0.0, 1.0)
ROW = {"a": (-0.1, -0.5, 0.02), "b": (0.0, -0.5, 0.02), "bowl": (0.1, -0.35, 0.025)}


@pytest.fixture
def table():
    """Makes tables of named positions; a bowl where the name says so, else a block."""

    def make(places, world=Reference, **others):
        bodies = {name: CATEGORIES["bowl" if name == "bowl" else "block"] for name in places} | others
        frames = {name: Frame(place, UPRIGHT) for name, place in places.items()}
        return world(bodies, frames, engine="mujoco")

    return make


def test_a_block_is_put_on_another(table):
    made = table(ROW)
    picked = made.pick(-0.1, -0.5, 0.02)
    assert (picked.ended, picked.held, picked.cover) == (None, "a", 1.0)
    assert picked.finger_gap == pytest.approx(0.04, abs=5e-4)
    assert picked.grip_force > 20
    assert picked.slip < 1e-3
    placed = made.place(0.0, -0.5, 0.06)
    assert (placed.ended, placed.support, placed.at_rest) == (None, "b", True)
    assert placed.support_height == pytest.approx(0.0, abs=5e-4)
    assert dict(made.snapshot.frames)["a"].position == pytest.approx((0.0, -0.5, 0.06), abs=3e-4)


@pytest.mark.parametrize(
    ("plan", "stage"),
    [
        ([("pick", -0.1, -0.475, 0.02)], "approach"),
        ([("pick", -0.082, -0.5, 0.02)], "grasp"),
        ([("pick", 0.2, -0.5, 0.02)], "grasp"),
        ([("pick", 0.9, -0.9, 0.02)], "reach"),
        ([("pick", -0.1, -0.5, 0.0)], "approach"),
        ([("place", -0.1, -0.5, 0.02)], "hand"),
        ([("pick", -0.1, -0.5, 0.02), ("place", 0.0, -0.5, 0.15)], "support"),
        ([("pick", -0.1, -0.5, 0.02), ("place", 0.0, -0.455, 0.02)], "descent"),
    ],
)
def test_what_must_fail_ends_at_its_stage(table, plan, stage):
    made = table(ROW)
    *before, last = [getattr(made, skill)(*at).ended for skill, *at in plan]
    assert (before, last) == ([None] * len(before), stage)


def test_a_stack_past_the_edge_falls(table):
    made = table(ROW)
    made.pick(-0.1, -0.5, 0.02)
    fallen = {d.name: d for d in made.place(0.024, -0.5, 0.06).displacements}["a"]
    assert fallen.turned > 0.25
    made = table(ROW)
    made.pick(-0.1, -0.5, 0.02)
    stands = {d.name: d for d in made.place(0.016, -0.5, 0.06).displacements}["a"]
    assert stands.shift < 0.002


def test_an_object_under_another_takes_it_along(table):
    made = table({"a": (0.0, -0.5, 0.02), "b": (0.0, -0.5, 0.06)})
    assert "b" in {d.name for d in made.pick(0.0, -0.5, 0.02).displacements or () if d.shift > 0.012} or (
        made.snapshot.held is None
    )


@pytest.mark.parametrize("world", [Reference, Execution])
def test_a_block_dropped_into_a_bowl_stays_there(table, world):
    made = table(ROW, world)
    made.pick(-0.1, -0.5, 0.02)
    placed = made.place(0.1, -0.35, 0.045)
    assert (placed.target, placed.support, placed.at_rest) == ("a", "bowl", True)
    x, y, z = dict(made.snapshot.frames)["a"].position
    assert (x, y, z) == pytest.approx((0.1, -0.35, 0.024), abs=2e-3)


def test_motors_and_friction_put_a_block_where_it_is_to_be(table):
    made = table(ROW, Execution)
    assert made.pick(-0.1, -0.5, 0.02).held == "a"
    placed = made.place(0.2, -0.7, 0.02)
    assert (placed.support, placed.held) == ("table", None)
    assert dict(made.snapshot.frames)["a"].position == pytest.approx((0.2, -0.7, 0.02), abs=2e-3)
    assert dict(made.snapshot.frames)["b"].position == pytest.approx(ROW["b"], abs=2e-4)


def test_a_tall_cylinder_is_carried_upright(table):
    can = Body(Cylinder(0.03, 0.1), mass=0.3)
    made = table(ROW | {"can": (0.2, -0.6, 0.05)}, can=can)
    assert made.pick(0.2, -0.6, 0.07).held == "can"
    placed = made.place(0.15, -0.65, 0.07)
    assert (placed.ended, placed.support) == (None, "table")
    x, y, z = dict(made.snapshot.frames)["can"].position
    assert (x, y, z) == pytest.approx((0.15, -0.65, 0.05), abs=1.5e-3)
