"""What comes of a grip or a fall depends on how things lie there, and on nothing else."""

import math

import pytest
from tables import bodies_of, carry_out, frames_of

from proc3s_tabletop.bullet.engine import BulletEngine
from proc3s_tabletop.bullet.scene import Snapshot
from proc3s_tabletop.bullet.simulation import TableScene
from proc3s_tabletop.objects.body import CATEGORIES
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.robot.settings import ReferenceSettings

SCENE = {"a": (0, 0, 0), "b": (0, 0, 0), "c": (0, 0, 0), "bowl": (0, 0, 0)}
BLOCK, BOWL = CATEGORIES["block"], CATEGORIES["bowl"]
LEVEL = (0.0, 0.0, 0.0, 1.0)


@pytest.fixture
def simulator():
    made = BulletEngine().grips(bodies_of(SCENE), ReferenceSettings())
    yield made
    made.close()


@pytest.fixture
def ticks(monkeypatch):
    """Counts how often time passes."""
    counted = []
    tick = TableScene.tick
    monkeypatch.setattr(
        TableScene, "tick", lambda self, count=1: (counted.append(count), tick(self, count))[1]
    )
    return counted


def tool(x, y, z, yaw=math.pi / 2):
    """Tool0 over a grasp point, pointing down."""
    return Frame((x, y, z + 0.1455), (math.cos(yaw / 2), math.sin(yaw / 2), 0.0, 0.0))


def on_top(x, y, off=0.01):
    """A block on another, off its middle."""
    return ((BLOCK, Frame((x, y, 0.02), LEVEL)), (BLOCK, Frame((x + off, y, 0.0605), LEVEL)))


def seen_from(frame, x, y):
    px, py, pz = frame.position
    return [px - x, py - y, pz, *frame.rotation]


def test_a_rest_is_the_same_wherever_it_happens(simulator):
    here, there = simulator.rest(on_top(0.0, -0.5)), simulator.rest(on_top(0.17, -0.33))
    for a, b in zip(here.frames, there.frames, strict=True):
        assert seen_from(a, 0.0, -0.5) == pytest.approx(seen_from(b, 0.17, -0.33), abs=1e-7)
    assert here.at_rest


def test_a_grip_is_the_same_wherever_it_happens_and_whichever_way_it_turns(simulator, ticks):
    def grip(x, y, yaw):
        # A block 4 mm off across the hand, turned with it.
        off = (x + 0.004 * math.sin(yaw), y - 0.004 * math.cos(yaw), 0.02)
        turned = (0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))
        return simulator.grip(tool(x, y, 0.02, yaw), ((BLOCK, Frame(off, turned)),), 1.0)

    first = grip(0.0, -0.5, 0.0)
    assert first.telemetry.ended is None
    spent = len(ticks)
    assert grip(0.11, -0.42, math.pi / 2) == first
    assert grip(-0.2, -0.7, 0.4) == first
    assert len(ticks) == spent


def test_what_is_asked_again_is_not_simulated_again(simulator, ticks):
    once = simulator.rest(on_top(0.0, -0.5))
    spent = len(ticks)
    assert spent > 0
    assert simulator.rest(on_top(0.0, -0.5)) == once
    assert len(ticks) == spent
    simulator.rest(on_top(0.0, -0.5, off=0.011))
    assert len(ticks) > spent


def test_a_used_simulator_gives_what_a_fresh_one_gives(simulator):
    questions = [on_top(0.0, -0.5, off) for off in (0.0, 0.005, 0.017, 0.03)]
    grips = [(tool(0.0, -0.5, 0.02), ((BLOCK, Frame((dx, -0.5, 0.02), LEVEL)),), 1.0) for dx in (0.0, 0.008)]

    def answers(questions, grips):
        fresh = BulletEngine().grips(bodies_of(SCENE), ReferenceSettings())
        try:
            gripped = {grip: fresh.grip(*grip) for grip in grips}
            return {question: fresh.rest(question) for question in questions} | gripped
        finally:
            fresh.close()

    assert answers(questions, grips) == answers(questions[::-1], grips[::-1])
    for question in questions:
        assert simulator.rest(question) == answers([question], [])[question]


def test_speed_and_place_in_the_hand_matter(simulator):
    def held(dx, speed):
        return simulator.grip(tool(0.0, -0.5, 0.02), ((BLOCK, Frame((dx, -0.5, 0.02), LEVEL)),), speed).held

    assert len({held(0.0, 1.0), held(0.005, 1.0), held(0.0, 1.05)}) == 3


def test_a_touched_neighbour_is_named(table):
    """The closing fingers sink: they meet what the open ones passed over."""
    stack = {"low": (0.0, -0.5, 0.02), "a": (0.0, -0.5, 0.06)}
    telemetry = table({**stack, "c": (0.0, -0.45, 0.02)}).pick(0.0, -0.5, 0.052)
    assert telemetry.ended == "close"
    assert (telemetry.clearance.body, telemetry.clearance.other) == ("gripper", "c")
    assert table({**stack, "c": (0.0, -0.45, 0.02)}).pick(0.0, -0.5, 0.058).ended is None


def test_the_second_plan_costs_a_fraction_of_the_first(table, ticks):
    positions = {"a": (-0.15, -0.5, 0.02), "b": (0.15, -0.5, 0.02)}
    world = table(positions)
    plan = [("pick", -0.15, -0.5, 0.02), ("place", -0.1, -0.35, 0.02)]
    assert carry_out(world, plan)[1] is None
    first = sum(ticks)
    world.put(frames_of(positions))
    assert carry_out(world, [("pick", 0.15, -0.5, 0.02), ("place", 0.1, -0.35, 0.02)])[1] is None
    assert sum(ticks) == first


def test_what_hardly_moved_did_not_move():
    before = Snapshot((("a", Frame((0.0, 0.0, 0.02), LEVEL)), ("b", Frame((0.1, 0.0, 0.02), LEVEL))))
    crept = Frame((0.00005, 0.0, 0.01995), (0.0, 0.0, 0.0002, 1.0))
    moved = Frame((0.1, 0.0002, 0.02), LEVEL)
    after = Snapshot((("a", crept), ("b", moved))).after(before)
    assert dict(after.frames) == {"a": before.frames[0][1], "b": moved}
