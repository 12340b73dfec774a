"""Skills that name an object and a grasp in its frame: where the hand goes, and what a place asks for."""

import dataclasses
import math

import numpy as np
import pytest
from blocks_domain import belief, blocks_domain
from hypothesis import given
from hypothesis import strategies as st

from proc3s import Action, Pose, SkillSpec
from proc3s.domain.margins import check
from proc3s.domain.transforms import compose
from proc3s.specs.domain import ParamSpec
from proc3s_tabletop.tasks.grasp_sampler import GraspSampler
from proc3s_tabletop.tasks.state_methods import RigidPoseMethods
from proc3s_tabletop.world import ExecutionWorld, ReferenceWorld

DOWN = Pose(0.0, 0.0, 0.0, 0.0, math.pi, math.pi / 2)
ACROSS = dataclasses.replace(DOWN, yaw=0.0)
SPOT = Pose(0.0, -0.4, 0.02)


def typed(name, **params):
    params = {key: ParamSpec(type=kind) for key, kind in params.items()}
    return SkillSpec(name=name, target=f"proc3s_tabletop.world:{name}_object", summary="", params=params)


@pytest.fixture(scope="module")
def domain():
    """Arrange-Blocks, but skills name objects, grasps and poses."""
    domain = blocks_domain()
    skills = {"pick": typed("pick", o="object", g="grasp")}
    skills["place"] = typed("place", o="object", g="grasp", p="pose")
    return dataclasses.replace(domain, spec=domain.spec.model_copy(update={"skills": skills}))


@pytest.fixture(scope="module")
def start(domain):
    things = [("block", "red", -0.15, -0.5, 0.02, 0, 0, 0.5), ("block", "blue", 0.15, -0.5, 0.02)]
    return belief(domain, *things)


@pytest.fixture(scope="module")
def worlds(domain):
    made = {"reference": ReferenceWorld(domain), "execution": ExecutionWorld(domain)}
    yield made
    for world in made.values():
        world.close()


def carried_out(world, start, *actions):
    """The transitions of actions, and the words of the violations of the last."""
    world.reset(start)
    steps = [world.step(Action(*action)) for action in actions]
    _, found, _ = check(world.domain, steps[-1], len(steps) - 1)
    return steps, [violation.text for violation in found]


def pick(o, g):
    return "pick", (o, g)


def place(o, g, p):
    return "place", (o, g, p)


@pytest.mark.parametrize("name", ["reference", "execution"])
def test_a_turned_block_is_grasped_along_its_sides_and_comes_to_its_pose(worlds, start, name):
    steps, found = carried_out(
        worlds[name],
        start,
        pick("object_0", DOWN),
        place("object_0", DOWN, dataclasses.replace(SPOT, yaw=0.3)),
    )
    assert found == []
    assert steps[0].telemetry.held == steps[0].telemetry.wanted == "object_0"
    assert steps[0].telemetry.slip_angle < 0.05
    pose = steps[1].after.objects["object_0"].pose
    assert (pose.x, pose.y) == pytest.approx((SPOT.x, SPOT.y), abs=2e-3)
    assert pose.yaw == pytest.approx(0.3, abs=0.05)


def test_a_grasp_follows_an_object_that_has_moved(worlds, start):
    again = [pick("object_0", DOWN), place("object_0", DOWN, Pose(0.1, -0.35, 0.02))]
    steps, found = carried_out(
        worlds["reference"], start, pick("object_0", ACROSS), place("object_0", ACROSS, SPOT), *again
    )
    assert found == []
    pose = steps[-1].after.objects["object_0"].pose
    assert (pose.x, pose.y) == pytest.approx((0.1, -0.35), abs=2e-3)


REFUSED = {
    "a place of another object": (
        [pick("object_0", DOWN), place("object_1", DOWN, SPOT)],
        "the hand holds object_0 (the red block), not object_1 (the blue block)",
    ),
    "a place by another grasp": (
        [pick("object_0", DOWN), place("object_0", dataclasses.replace(DOWN, x=0.005), SPOT)],
        "the hand holds object_0 (the red block) by another grasp than the place names",
    ),
    "a place with an empty hand": (
        [place("object_0", DOWN, SPOT)],
        "there is nothing in the hand to set down",
    ),
    "a grasp beside the object": (
        [pick("object_0", dataclasses.replace(DOWN, x=0.06))],
        "the grasp fails: the fingers miss object_0 (the red block)",
    ),
    "a grasp that ends on another object": (
        [pick("object_0", dataclasses.replace(DOWN, x=0.3 * math.cos(0.5), y=-0.3 * math.sin(0.5)))],
        "the grasp fails: the fingers close on object_1 (the blue block) instead of object_0 (the red block)",
    ),
    "fingers on top of the object": (
        [pick("object_0", dataclasses.replace(DOWN, y=0.025))],
        "the grasp fails: the fingers come down on object_0 (the red block) instead of around it",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_refused_and_in_which_words(worlds, start, case):
    actions, words = REFUSED[case]
    _, found = carried_out(worlds["reference"], start, *actions)
    assert found == [words]


def test_a_refused_place_leaves_the_hand_as_it_is(worlds, start):
    world = worlds["reference"]
    carried_out(world, start, pick("object_0", DOWN), place("object_1", DOWN, SPOT))
    step = world.step(Action(*place("object_0", DOWN, SPOT)))
    assert check(world.domain, step, 2)[1] == []


def test_the_same_from_a_snapshot_as_in_one_go(worlds, start):
    world = worlds["reference"]
    (_, last), _ = carried_out(world, start, pick("object_0", DOWN), place("object_0", DOWN, SPOT))
    carried_out(world, start, pick("object_0", DOWN))
    snapshot = world.snapshot
    carried_out(world, start, pick("object_1", DOWN))
    world.resume(snapshot)
    assert world.step(Action(*place("object_0", DOWN, SPOT))) == last


NUMBERS = st.tuples(*[st.floats(-1, 1)] * 3, *[st.floats(-math.pi, math.pi)] * 3)


class Rigid(RigidPoseMethods):
    """As the class stands in a program's box."""

    def __init__(self, x, y, z, roll, pitch, yaw):
        self.x, self.y, self.z, self.roll, self.pitch, self.yaw = x, y, z, roll, pitch, yaw


@given(NUMBERS, NUMBERS, NUMBERS)
def test_programs_compose_poses_as_the_world_does(a, b, c):
    ours = Rigid(*a).multiply(Rigid(*b)).multiply(Rigid(*c))
    theirs = compose(compose(np.array(a), np.array(b)), np.array(c))
    assert ours.rotation == pytest.approx(Rigid(*theirs).rotation, abs=1e-6)
    assert ours.point == pytest.approx(theirs[:3], abs=1e-6)


@given(st.lists(st.tuples(*[st.floats(0, 1)] * 3), min_size=1, max_size=9))
def test_drawn_grasps_point_down_near_the_centre(u):
    grasps = GraspSampler().decode(np.array(u))
    assert (np.abs(grasps[:, :2]) <= 0.02).all()
    assert (np.abs(grasps[:, 5]) <= math.pi).all()
    assert grasps[:, 2:5] == pytest.approx(np.tile([0.005, 0.0, math.pi], (len(u), 1)))
    back = compose(np.array([0.01, 0.02, 0, 0, math.pi, 0.7]), np.array([0, 0, -0.005, 0, 0, 0]))
    assert back[:3] == pytest.approx([0.01, 0.02, 0.005])
