"""A step depends on its snapshot and on nothing else, to the last bit."""

import dataclasses
import multiprocessing
import pickle

import pytest
from tables import frames_of, world_of

PILE = {
    "a": (0.0, -0.5, 0.02),
    "b": (0.04, -0.5, 0.02),
    "c": (0.02, -0.5, 0.06),
    "d": (0.02, -0.5, 0.10),
    "e": (-0.04, -0.5, 0.02),
    "f": (-0.02, -0.5, 0.06),
    "g": (-0.15, -0.35, 0.02),
    "bowl": (0.15, -0.65, 0.025),
}
PLAN = [
    ("pick", -0.15, -0.35, 0.02),
    ("place", -0.02, -0.5, 0.10),
    ("pick", 0.02, -0.5, 0.10),
    ("place", 0.15, -0.65, 0.03),
    ("pick", -0.02, -0.5, 0.10),
    ("place", 0.02, -0.5, 0.10),
]


def step(world, action):
    telemetry = getattr(world, action[0])(*action[1:])
    return telemetry, world.snapshot


def replay(world, actions):
    world.put(frames_of(PILE))
    return [step(world, action) for action in actions]


def fresh(actions):
    """The last step of a plan in a client of its own."""
    world = world_of(PILE)
    try:
        return replay(world, actions)
    finally:
        world.close()


@pytest.fixture(scope="module")
def expected():
    return fresh(PLAN)


def test_the_plan_moves_a_pile_of_touching_blocks(expected):
    assert [telemetry.ended for telemetry, _ in expected] == [None] * len(PLAN)


def test_a_used_client_gives_what_a_fresh_one_gives(table, expected):
    world = table(PILE)
    for _ in range(3):
        world.pick(0.02, -0.5, 0.02)
        world.place(0.1, -0.3, 0.02)
        assert replay(world, PLAN) == expected


def test_a_cached_prefix_gives_what_its_replay_gives(table, expected):
    world = table(PILE)
    for k in reversed(range(1, len(PLAN))):
        world.snapshot = expected[k - 1][1]
        assert step(world, PLAN[k]) == expected[k]


def test_steps_that_ended_early_leave_nothing_behind(table, expected):
    world = table(PILE)
    start = world.snapshot
    stages = set()
    for y in (-0.52, -0.51, -0.50, -0.49, -0.48, -0.47):
        for x in (0.0, 0.02, 0.04, 0.06):
            world.snapshot = start
            stages.add(world.pick(x, y, 0.06).ended)
            world.place(x, y, 0.06)
    assert len(stages) > 1
    world.snapshot = start
    assert step(world, PLAN[0]) == expected[0]


def test_another_order_of_the_same_plans_changes_nothing(table, expected):
    world = table(PILE)
    others = [[("pick", 0.02, -0.5, 0.10), ("place", -0.1 + 0.02 * k, -0.4, 0.02)] for k in range(3)]
    forwards = [replay(world, plan) for plan in others]
    backwards = [replay(world, plan) for plan in reversed(others)]
    assert forwards == backwards[::-1]


def test_snapshots_cross_processes_as_they_are(expected):
    _, snapshot = expected[2]
    assert snapshot.held is not None
    assert pickle.loads(pickle.dumps(snapshot)) == snapshot
    assert hash(snapshot) == hash(dataclasses.replace(snapshot))


def test_spawned_processes_give_the_same(expected):
    with multiprocessing.get_context("spawn").Pool(4) as pool:
        for result in pool.map(fresh, [PLAN, PLAN[:4], PLAN[:2], PLAN], chunksize=1):
            assert result == expected[: len(result)]
