"""The execution world: what accepted plans do there, and that it agrees with the reference on clear cases."""

from types import SimpleNamespace

import numpy as np
import pytest
import test_actions
from tables import bodies_of, carry_out, frames_of, jittered, moves, packing, pyramid, scattered, world_of
from test_agreement import resident
from test_world import PICK, PLACE, START

from proc3s_tabletop.actions.execution import Execution
from proc3s_tabletop.bullet import scene as bullet_scene
from proc3s_tabletop.robot.settings import ReferenceSettings
from proc3s_tabletop.skills import pick, place
from proc3s_tabletop.telemetry import displacement
from proc3s_tabletop.world import ExecutionWorld

BLOCKS = {"a": test_actions.A, "b": test_actions.B, "c": test_actions.C, "bowl": (0.0, -0.65, 0.025)}
PICK_A = test_actions.PICK_A


def executing(positions, speed=1.0):
    return Execution(bodies_of(positions), frames_of(positions), ReferenceSettings(speed=speed))


@pytest.fixture(scope="module")
def shared():
    world = executing(BLOCKS)
    yield world
    world.close()


@pytest.fixture
def table(shared):
    """A driven arm over the blocks; all tests share one client, as snapshots allow."""
    shared.put(frames_of(BLOCKS))
    return shared


def position(world, name):
    return dict(world.snapshot.frames)[name].position


@pytest.mark.parametrize("name", ["stack 10 mm off along y", "place, z = 0", "into the bowl"])
def test_what_the_reference_accepts_ends_where_the_reference_has_it(table, name):
    reference = world_of(BLOCKS)
    try:
        assert carry_out(reference, test_actions.PASS[name])[1] is None
        assert carry_out(table, test_actions.PASS[name])[1] is None
        for body in BLOCKS:
            assert position(table, body) == pytest.approx(position(reference, body), abs=3e-3), body
    finally:
        reference.close()


def test_a_stack_too_far_off_falls(table):
    table.pick(*test_actions.A)
    telemetry = table.place(0.022, -0.5, 0.06)
    assert telemetry.ended is None
    assert position(table, "a")[2] < 0.03
    assert moves(telemetry)["a"].turned > 1


def test_nothing_is_refused_but_what_is_out_of_reach(table):
    table.pick(*test_actions.A)
    table.place(0.0, -0.5, 0.06)
    telemetry = table.pick(*test_actions.B)
    assert telemetry.ended is None
    assert position(table, "a")[2] > 0.1 or position(table, "b")[:2] != pytest.approx((0, -0.5), abs=0.02)
    before = table.snapshot
    telemetry = table.place(0.0, -1.2, 0.02)
    assert (telemetry.ended, telemetry.ik_residual > 0.1) == ("reach", True)
    assert table.snapshot == before


def test_a_pick_says_what_it_holds_and_how(table):
    telemetry = table.pick(-0.14, -0.5, 0.02)
    assert (telemetry.target, telemetry.held, telemetry.ended) == ("a", "a", None)
    assert telemetry.finger_gap == pytest.approx(0.04, abs=5e-4)
    assert telemetry.grip_force > 5
    assert telemetry.slip < 1e-3
    assert position(table, "a")[2] == pytest.approx(0.12, abs=2e-3)
    assert set(moves(telemetry)) == {"b", "c", "bowl"}
    assert telemetry.at_rest


def test_a_place_says_where_the_support_was_met(table):
    table.pick(*test_actions.A)
    telemetry = table.place(0.0, -0.5, 0.05)
    assert (telemetry.target, telemetry.held, telemetry.support) == ("a", None, "b")
    assert telemetry.support_height == pytest.approx(0.01, abs=1.5e-3)


def test_what_is_released_over_nothing_falls_by_so_much(table):
    table.pick(*test_actions.A)
    telemetry = table.place(-0.1, -0.35, 0.05)
    assert telemetry.support_height == pytest.approx(-0.03, abs=2e-3)
    assert position(table, "a") == pytest.approx((-0.1, -0.35, 0.02), abs=3e-3)


def test_an_empty_hand_holds_nothing_and_moves_nothing(table):
    before = dict(table.snapshot.frames)
    picked, placed = table.pick(-0.05, -0.3, 0.02), table.place(0.1, -0.3, 0.02)
    assert [(t.ended, t.target, t.held) for t in (picked, placed)] == [(None, None, None)] * 2
    for name, frame in before.items():
        assert position(table, name) == pytest.approx(frame.position, abs=2e-4)


def test_a_full_hand_lets_go_before_it_picks_again(table):
    table.pick(*test_actions.A)
    telemetry = table.pick(*test_actions.B)
    assert telemetry.held == "b"
    assert moves(telemetry)["a"].upright > 0.05
    assert position(table, "a")[2] < 0.03


def test_a_step_depends_on_its_snapshot_alone(table):
    start = table.snapshot
    first = [(table.pick(*test_actions.A), table.snapshot), (table.place(0.0, -0.5, 0.06), table.snapshot)]
    fresh = executing(BLOCKS)
    try:
        fresh.pick(*test_actions.C)
        fresh.snapshot = first[0][1]
        assert (fresh.place(0.0, -0.5, 0.06), fresh.snapshot) == first[1]
        fresh.snapshot = start
        assert (fresh.pick(*test_actions.A), fresh.snapshot) == first[0]
    finally:
        fresh.close()


@pytest.mark.parametrize("goal", [(0.27, -0.77), (-0.28, -0.74), (-0.25, -0.22)])
def test_what_is_carried_to_the_edge_of_the_table_stands_where_it_is_to_be(table, goal):
    table.pick(*test_actions.A)
    table.place(*goal, 0.02)
    assert position(table, "a")[:2] == pytest.approx(goal, abs=3e-4)


PUSHED = {
    "a": (0.0, -0.5, 0.02),
    "b": (0.0, -0.545, 0.02),
    "c": (0.0, -0.589, 0.02),
    "bowl": (0.2, -0.3, 0.025),
}


def pushing():
    """A pick beside a block, which the fingers push into the next, and that into another."""
    made = executing(PUSHED)
    made.pick(0.0, -0.47, 0.02)
    return made


def test_what_sleeps_is_woken_by_a_push(monkeypatch):
    slept = pushing()
    monkeypatch.setattr(bullet_scene, "LOOK", 10**9)
    awake = pushing()
    try:
        assert slept.snapshot != awake.snapshot
        assert position(slept, "b")[1] < -0.549
        assert position(slept, "c")[1] < -0.589
        for name in ("b", "c", "bowl"):
            assert position(slept, name) == pytest.approx(position(awake, name), abs=3e-4)
    finally:
        slept.close()
        awake.close()


@pytest.mark.slow
@pytest.mark.parametrize("speed", [0.95, 1.05])
def test_the_speed_changes_the_way_but_not_the_end(table, speed):
    other = executing(BLOCKS, speed)
    actions = [PICK_A, ("place", 0.0, -0.5, 0.06)]
    try:
        assert carry_out(table, actions)[1] is None
        assert carry_out(other, actions)[1] is None
        assert other.snapshot != table.snapshot
        assert position(other, "a") == pytest.approx(position(table, "a"), abs=2e-3)
    finally:
        other.close()


@pytest.fixture
def world():
    made = ExecutionWorld(SimpleNamespace(skill={"pick": pick, "place": place}.__getitem__), speed=1.02)
    yield made
    made.close()


def test_the_skills_are_those_of_the_reference_world(world):
    world.reset(START)
    assert world.observe() == START
    assert world.step(PICK).telemetry.held == "object_1"
    placed = world.step(PLACE)
    moved = world.observe().objects["object_1"].pose
    assert placed.after == world.observe()
    assert (moved.x, moved.y) == pytest.approx((-0.15, -0.4), abs=0.02)
    assert world.table.scene.settings.speed == 1.02


def test_a_closed_world_has_no_client(world):
    import pybullet

    world.reset(START)
    client = world.table.scene.client._id
    assert pybullet.isConnected(client)
    world.close()
    assert not pybullet.isConnected(client)
    with pytest.raises(RuntimeError, match="reset the world"):
        _ = world.table


def row(rng):
    """Five blocks go into a line along x, some of them too close."""
    positions = {f"block{k}": (*place, 0.02) for k, place in enumerate(scattered(rng, 5))}
    pitch = rng.uniform(0.034, 0.06)
    goals = [(pitch * (k - 2) + rng.normal(0, 0.001), -0.5 + rng.normal(0, 0.003), 0.02) for k in range(5)]
    pairs = zip(positions.values(), goals, strict=True)
    return positions, [action for at, goal in pairs for action in (("pick", *at), ("place", *goal))]


def unstack(rng):
    """The lower block of a stack goes into the bowl; in most plans the upper one is moved away first."""
    bowl, stack, free = scattered(rng, 3)
    top = stack + rng.uniform(-0.012, 0.012, 2)
    positions = {"bowl": (*bowl, 0.025), "low": (*stack, 0.02), "top": (*top, 0.06)}
    clear = [("pick", *positions["top"]), ("place", *free, 0.02)] if rng.uniform() < 0.7 else []
    aim = bowl + rng.uniform(-0.045, 0.045, 2)
    return positions, [*clear, ("pick", *positions["low"]), ("place", *aim, 0.04)]


CAUTION = {"approach", "grasp", "close", "carry", "descent", "release"}
"""Where the reference ends an action at a touch or a bad grip: motors may get away with it."""


def reference_verdicts(worlds, positions, actions, rng):
    """Why the reference refuses a plan, at three speeds and with the objects moved by half a millimetre."""
    starts = [positions, positions, positions, jittered(rng, positions), jittered(rng, positions)]
    for world, start in zip([*worlds, worlds[-1], worlds[-1]], starts, strict=True):
        world.put(frames_of(start))
        yield carry_out(world, actions)[1]


def same_end(one, other):
    """Whether everything ended at the same place, as far as judges care."""
    ends = zip(one.snapshot.frames, other.snapshot.frames, strict=True)
    moved = [displacement(name, before, after) for (name, before), (_, after) in ends]
    return all(d.shift < 0.012 and d.turned < 0.25 for d in moved)


def agreement(task, count, seed):
    """Of clear cases: whether execution ends as the reference says it does."""
    rng = np.random.default_rng(seed)
    plans = [task(rng) for _ in range(count)]
    execution = executing(plans[0][0])
    worlds = [world_of(plans[0][0], speed) for speed in (0.95, 1.05, 1.0)]
    for positions, actions in plans:
        reasons = list(reference_verdicts(worlds, positions, actions, rng))
        if len({reason is None for reason in reasons}) > 1 or CAUTION & set(reasons):
            continue
        execution.put(frames_of(positions))
        reason = carry_out(execution, actions)[1]
        worlds[-1].put(frames_of(positions))
        carry_out(worlds[-1], actions)
        yield same_end(worlds[-1], execution) if reasons[0] is None else reason is not None
    for world in (execution, *worlds):
        world.close()


@pytest.mark.slow
def test_execution_ends_as_the_reference_says():
    """Thirty cases cannot tell 97 % from 99 %, so one may differ, and one does: two blocks set down 1 to 2 mm
    too close, where execution puts the first a millimetre further away. Measured on 125: 124 agree."""
    agreed = [same for task in (pyramid, row, packing, unstack) for same in agreement(task, 10, seed=4)]
    assert len(agreed) > 25
    assert agreed.count(False) <= 1, agreed


@pytest.mark.slow
def test_memory_does_not_grow_with_rollouts(world):
    def rollouts(count):
        for _ in range(count):
            world.reset(START)
            world.step(PICK)

    rollouts(30)
    before = resident()
    rollouts(200)
    assert resident() - before < 2e6
