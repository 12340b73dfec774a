"""In MuJoCo, too, a step depends on its snapshot alone: to the last bit, after anything, in any process."""

import multiprocessing

import numpy as np
import pytest

from proc3s_tabletop.actions.execution import Execution
from proc3s_tabletop.actions.reference import Reference
from proc3s_tabletop.objects.body import CATEGORIES
from proc3s_tabletop.robot.frames import Frame

UPRIGHT = (0.0, 0.0, 0.0, 1.0)
PLACES = {
    "a": (0.0, -0.5, 0.02),
    "b": (0.0, -0.5, 0.06),
    "c": (0.12, -0.45, 0.02),
    "bowl": (-0.15, -0.4, 0.025),
}
PLAN = (("pick", 0.003, -0.5, 0.06), ("place", -0.15, -0.4, 0.05), ("pick", 0.0, -0.5, 0.02))


def made(world):
    bodies = {name: CATEGORIES["bowl" if name == "bowl" else "block"] for name in PLACES}
    return world(bodies, {name: Frame(place, UPRIGHT) for name, place in PLACES.items()}, engine="mujoco")


def carried_out(table, steps=PLAN):
    """What every step measured, and the snapshots after them."""
    return [(getattr(table, skill)(*at), table.snapshot) for skill, *at in steps]


def fresh(world):
    return carried_out(made(world))


@pytest.mark.parametrize("world", [Reference, Execution])
def test_a_restored_snapshot_goes_on_to_the_last_bit(world):
    table = made(world)
    start = table.snapshot
    expected = carried_out(table)
    assert {telemetry.target for telemetry, _ in expected} == {"a", "b"}
    for x in np.linspace(-0.02, 0.13, 4):
        table.snapshot = start
        carried_out(table, [("pick", float(x), -0.48, 0.02), ("place", 0.1, -0.6, 0.02)])
    table.snapshot = expected[0][1]
    assert carried_out(table, PLAN[1:]) == expected[1:]
    table.snapshot = start
    assert carried_out(table) == expected


@pytest.mark.slow
@pytest.mark.parametrize("world", [Reference, Execution])
def test_another_process_gives_the_same(world):
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.apply(fresh, (world,)) == fresh(world)
