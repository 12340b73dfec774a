"""Worlds in which things stand, and come down, a little off: as with a camera that is not calibrated well."""

import math
from importlib.util import find_spec

import numpy as np
import pytest
from blocks_domain import belief, blocks_domain
from hypothesis import given
from hypothesis import strategies as st

from proc3s import Action, Pose
from proc3s_tabletop.actions.misplacement import TURN, Misplacement, off
from proc3s_tabletop.robot.frames import frame
from proc3s_tabletop.skills import pick_object, place_object
from proc3s_tabletop.world import ExecutionWorld, ReferenceWorld

DOMAIN = blocks_domain()
SCENE = belief(DOMAIN, ("block", "red", -0.15, -0.5, 0.02), ("block", "blue", 0.15, -0.5, 0.02))
PLAN = [Action("pick", (-0.15, -0.5, 0.02)), Action("place", (0.0, -0.4, 0.02))]
DOWN = Pose(0.0, 0.0, 0.0, 0.0, math.pi, math.pi / 2)
ERROR = 0.003
ROUNDING = 1e-6


@pytest.fixture(params=[ReferenceWorld, ExecutionWorld])
def world(request):
    made = request.param(DOMAIN)
    yield made
    made.close()


def outcome(world, rng=None, error=0.0):
    world.misplace(rng, error)
    world.reset(SCENE)
    for action in PLAN:
        world.step(action)
    return world.observe()


def stands(world, seed, error=ERROR):
    world.misplace(np.random.default_rng(seed), error)
    world.reset(SCENE)
    return [thing.pose for thing in world.observe().objects.values()]


@given(st.integers(0, 2**32), st.floats(1e-6, 0.05), st.floats(-0.3, 0.3), st.floats(-math.pi, math.pi))
def test_an_offset_stays_within_its_disc_and_its_angle(seed, error, x, yaw):
    here = frame(Pose(x, -0.5, 0.02, 0.0, 0.0, yaw))
    offset = Misplacement(np.random.default_rng(seed), error).draw()
    there = off(here, offset)
    assert math.hypot(offset.x, offset.y) <= error * (1 + 1e-12)
    assert abs(offset.turn) <= TURN * error
    assert there.position == (x + offset.x, -0.5 + offset.y, 0.02)
    assert abs(np.dot(here.rotation, there.rotation)) == pytest.approx(math.cos(offset.turn / 2))


def test_offsets_fill_the_disc_evenly_and_a_millimetre_turns_by_half_a_degree():
    made = Misplacement(np.random.default_rng(0), 0.002)
    drawn = np.array([made.draw() for _ in range(4000)])
    inner = np.hypot(drawn[:, 0], drawn[:, 1]) < 0.002 / math.sqrt(2)
    assert inner.mean() == pytest.approx(0.5, abs=0.03)  # half of the area
    assert np.abs(drawn[:, :2].mean(axis=0)).max() < 1e-4
    assert np.degrees(np.abs(drawn[:, 2]).max()) == pytest.approx(1.0, abs=0.01)


def test_a_larger_error_scales_the_same_draws():
    small, large = (Misplacement(np.random.default_rng(1), error) for error in (0.001, 0.003))
    assert np.array(large.draw()) == pytest.approx(3 * np.array(small.draw()))


def test_errors_repeat_with_the_seed_and_leave_nothing_behind(world):
    exact = outcome(world)
    first = outcome(world, np.random.default_rng(1), ERROR)
    assert first != exact
    assert outcome(world, np.random.default_rng(1), ERROR) == first
    assert outcome(world, np.random.default_rng(1), 0.0) == exact


def test_a_plan_that_goes_on_from_a_snapshot_has_no_errors_left(world):
    world.reset(SCENE)
    world.step(PLAN[0])
    held = world.snapshot
    exact = world.step(PLAN[1]).after
    outcome(world, np.random.default_rng(3), ERROR)
    world.misplace(None)
    world.resume(held)
    assert world.step(PLAN[1]).after == exact


def test_objects_stand_within_the_disc_each_off_in_its_own_way(world):
    poses = [stands(world, seed) for seed in range(5)]
    for drawn in poses:
        offs = [
            math.hypot(pose.x - nominal.pose.x, pose.y - nominal.pose.y)
            for pose, nominal in zip(drawn, SCENE.objects.values(), strict=True)
        ]
        assert 0 < max(offs) <= ERROR
        assert offs[0] != offs[1]
        assert all(0 < abs(pose.yaw) <= TURN * ERROR and pose.z == 0.02 for pose in drawn)
    assert len({pose for drawn in poses for pose in drawn}) == 10


def test_a_pick_at_a_point_goes_to_the_point_of_the_plan(world):
    stands(world, 4)
    assert world.step(PLAN[0]).telemetry.commanded == PLAN[0].args


@pytest.mark.slow
def test_what_is_placed_comes_down_off_and_turned(world):
    goal = outcome(world).objects["object_0"].pose
    spots = [outcome(world, np.random.default_rng(seed), ERROR).objects["object_0"].pose for seed in range(3)]
    assert len({(pose.x, pose.y, pose.yaw) for pose in spots}) == 3
    for pose in spots:
        # That of its stand as far as the fingers leave it, and that of the place.
        assert 0 < math.hypot(pose.x - goal.x, pose.y - goal.y) < 2 * ERROR + 1e-3


def _reached(world, error):
    """The pick and the place of a named object, and the snapshot after them."""
    world.misplace(np.random.default_rng(5), error)
    world.reset(SCENE)
    pick = pick_object(world, "object_0", DOWN)
    place = place_object(world, "object_0", DOWN, Pose(0.0, -0.4, 0.02))
    return pick, place, world.table.snapshot


def test_a_named_object_is_grasped_where_it_is_believed_to_be(world):
    pick, place, after = _reached(world, ERROR)
    assert pick.held == "object_0"
    assert pick.commanded == pytest.approx((-0.15, -0.5, 0.02), abs=1e-9)
    assert 0 < math.hypot(place.commanded[0], place.commanded[1] + 0.4) <= ERROR
    assert [name for name, _ in after.believed] == ["object_0", "object_1"]


def test_the_error_of_the_camera_moves_with_the_object(world):
    _, _, after = _reached(world, ERROR)
    seen, true = after.seen("object_0"), dict(after.frames)["object_0"]
    apart = math.dist(seen.position[:2], true.position[:2])
    started = dict(after.believed)["object_0"]
    assert apart == pytest.approx(math.hypot(*started.position[:2]), abs=ROUNDING)
    again = pick_object(world, "object_0", DOWN)
    assert again.commanded == pytest.approx(seen.position, abs=ROUNDING)


def test_without_an_error_a_named_object_is_grasped_where_it_is(world):
    pick, place, after = _reached(world, 0.0)
    assert pick.commanded == pytest.approx((-0.15, -0.5, 0.02), abs=1e-12)
    assert place.commanded == pytest.approx((0.0, -0.4, 0.02), abs=1e-12)
    assert after.believed == ()
    assert after.seen("object_1") is dict(after.frames)["object_1"]


@pytest.mark.skipif(find_spec("mujoco") is None, reason="the extra mujoco is not installed")
def test_both_engines_get_the_same_draws():
    found = []
    for engine in ("pybullet", "mujoco"):
        world = ExecutionWorld(DOMAIN, engine=engine)
        try:
            world.misplace(np.random.default_rng(6), ERROR)
            world.reset(SCENE)
            seen = world.observe()
            points = [world.step(action).telemetry.commanded for action in PLAN]
        finally:
            world.close()
        found.append((seen, points))
    assert found[0] == found[1]


def test_placements_are_off_by_disturbances_or_misplacements():
    world = ReferenceWorld(DOMAIN)
    world.disturb(np.random.default_rng(0), corner=0)
    x, y, _, turn = world.placed(0.0, 0.0, 0.1)
    errors = world.errors
    assert (abs(x), abs(y), abs(turn)) == (errors.placed, errors.placed, errors.turn)
    world.disturb(None)
    world.misplace(np.random.default_rng(0), ERROR)
    x, y, z, turn = world.placed(0.0, 0.0, 0.1)
    assert 0 < math.hypot(x, y) <= ERROR
    assert z == 0.1
    assert turn != 0
