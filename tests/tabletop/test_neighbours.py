"""How near what is set down comes to what is beside it."""

import pytest
from tables import bodies_of, frames_of

from proc3s_tabletop.actions.reference import Reference

START = (-0.15, -0.5, 0.02)


@pytest.fixture(params=["pybullet", "mujoco"])
def put(request):
    """Puts block `a` somewhere among other things; what the place measured."""

    def carry_out(there, **others):
        positions = {"a": START, **others}
        world = Reference(bodies_of(positions), frames_of(positions), engine=request.param)
        assert world.pick(*START).ended is None
        placed = world.place(*there)
        assert placed.ended is None
        return placed.clearance

    return carry_out


@pytest.mark.parametrize("gap", [0.00025, 0.002])
def test_a_block_beside_another_is_as_near_as_the_gap_between_them(put, gap):
    found = put((0.04 + gap, -0.5, 0.02), b=(0.0, -0.5, 0.02))
    assert (found.body, found.other) == ("a", "b")
    assert found.distance == pytest.approx(gap, abs=2e-4)
    assert found.each == found.distance / 2  # both are off their place


def test_what_is_below_is_not_beside(put):
    found = put((0.02, -0.5, 0.06), b=(0.0, -0.5, 0.02), c=(0.041, -0.5, 0.02), d=(0.02, -0.455, 0.02))
    assert found.body != "a"


def test_what_reaches_higher_is(put):
    found = put((0.0, -0.5, 0.06), b=(0.0, -0.5, 0.02), c=(0.043, -0.5, 0.02), d=(0.043, -0.5, 0.06))
    assert (found.body, found.other) == ("a", "d")
    assert found.distance == pytest.approx(0.003, abs=3e-4)


def test_the_bowl_that_a_block_is_put_into_is_its_support(put):
    assert put((0.0, -0.5, 0.04), bowl=(0.0, -0.5, 0.025)).body != "a"
