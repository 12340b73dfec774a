"""The world gives the same verdict at another speed, and where objects lie half a millimetre off."""

import gc
import time
from pathlib import Path

import numpy as np
import pytest
from tables import carry_out, frames_of, jittered, packing, pyramid, world_of

SPEEDS = (1.0, 1.05, 0.95)


@pytest.mark.slow
@pytest.mark.parametrize("task", [pyramid, packing])
def test_the_world_agrees_with_itself(table, task):
    rng = np.random.default_rng(7)
    plans = [task(rng) for _ in range(25)]
    worlds = {speed: table(plans[0][0], speed) for speed in SPEEDS}

    def accepted(speed, positions, actions):
        worlds[speed].put(frames_of(positions))
        return carry_out(worlds[speed], actions)[1] is None

    verdicts = []
    for positions, actions in plans:
        first = accepted(1.0, positions, actions)
        others = [accepted(speed, positions, actions) for speed in SPEEDS[1:]]
        others.append(accepted(1.0, jittered(rng, positions), actions))
        verdicts += [(first, other) for other in others]
    assert {first for first, _ in verdicts} == {True, False}
    assert np.mean([first == other for first, other in verdicts]) >= 0.96


PLAN = [
    ("pick", -0.2, -0.35, 0.02),
    ("place", -0.025, -0.5, 0.02),
    ("pick", 0.2, -0.35, 0.02),
    ("place", 0.025, -0.5, 0.02),
]
TABLE = {
    "a": (-0.2, -0.35, 0.02),
    "b": (0.2, -0.35, 0.02),
    "c": (-0.2, -0.65, 0.02),
    "d": (0.2, -0.65, 0.02),
    "e": (0.0, -0.7, 0.02),
    "f": (0.0, -0.3, 0.02),
    "bowl0": (-0.13, -0.5, 0.025),
    "bowl1": (0.13, -0.5, 0.025),
}


def spent(work):
    start = time.process_time()
    work()
    return time.process_time() - start


@pytest.mark.slow
def test_a_plan_of_four_actions_costs_less_than_eight_hundred_steps(table):
    """A fifth of a second on an idle core. Measured against bare steps of the same simulator, since what a
    second is worth depends on what else the machine does."""
    world, plans, steps = table(TABLE), [], []
    for _ in range(8):
        world.put(frames_of(TABLE))
        plans.append(spent(lambda: carry_out(world, PLAN)))
        world.put(frames_of(TABLE))
        world.scene.load(world.snapshot)
        steps.append(spent(lambda: [world.scene.client.stepSimulation() for _ in range(400)]))
    assert min(plans) < 2 * min(steps), (plans, steps)


def resident():
    """Memory of this process, bytes."""
    gc.collect()
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096


def rollouts(world, count):
    for _ in range(count):
        world.put(frames_of(TABLE))
        carry_out(world, PLAN[:2])


@pytest.mark.slow
def test_memory_does_not_grow_with_rollouts(table):
    world = table(TABLE)
    rollouts(world, 50)
    before = resident()
    rollouts(world, 500)
    assert resident() - before < 2e6


@pytest.mark.slow
def test_worlds_that_are_closed_give_their_memory_back():
    for _ in range(5):
        world_of(TABLE).close()
    before = resident()
    for _ in range(20):
        world_of(TABLE).close()
    assert resident() - before < 10e6
