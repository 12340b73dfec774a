from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from proc3s import Action, Pose, SpecError, State
from proc3s_tabletop.bullet.scene import Scene
from proc3s_tabletop.catalogue.body_specs import bodies_of
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.objects.shapes import Mesh, Surface
from proc3s_tabletop.robot.settings import ReferenceSettings
from proc3s_tabletop.skills import pick, place
from proc3s_tabletop.world import ReferenceWorld


@dataclass(frozen=True)
class Thing:
    category: str
    color: str
    pose: Pose


@dataclass(frozen=True)
class Table(State):
    objects: dict[str, Thing]


START = Table(
    {
        "object_0": Thing("block", "red", Pose(0.0, -0.5, 0.02, yaw=0.3)),
        "object_1": Thing("block", "blue", Pose(0.15, -0.4, 0.02)),
        "object_2": Thing("bowl", "green", Pose(-0.15, -0.4, 0.025)),
    }
)
PICK, PLACE = Action("pick", (0.15, -0.4, 0.02)), Action("place", (-0.15, -0.4, 0.03))


@pytest.fixture
def world():
    domain = SimpleNamespace(skill={"pick": pick, "place": place}.__getitem__)
    made = ReferenceWorld(domain)
    yield made
    made.close()


def test_a_state_comes_back_as_it_was_put(world):
    world.reset(START)
    assert world.observe() == START


def test_steps_change_the_poses_of_what_they_move(world):
    world.reset(START)
    picked, placed = world.step(PICK), world.step(PLACE)
    assert (picked.before, picked.telemetry.held) == (START, "object_1")
    assert placed.before == picked.after
    assert placed.telemetry.support == "object_2"
    moved = placed.after.objects["object_1"]
    assert (moved.category, moved.color) == ("block", "blue")
    assert (moved.pose.x, moved.pose.y) == pytest.approx((-0.15, -0.4), abs=2e-3)
    assert placed.after.objects["object_0"].pose.yaw == pytest.approx(0.3, abs=1e-3)


def test_a_plan_goes_on_from_a_snapshot(world):
    world.reset(START)
    world.step(PICK)
    carrying = world.snapshot
    first = world.step(PLACE)
    world.reset(START)
    world.resume(carrying)
    assert world.step(PLACE) == first


def test_a_state_with_other_objects_gets_a_table_of_its_own(world):
    world.reset(START)
    few = Table({"object_1": START.objects["object_1"]})
    world.reset(few)
    assert world.step(PICK).telemetry.held == "object_1"
    assert set(world.observe().objects) == {"object_1"}
    world.reset(START)
    assert world.observe() == START


def test_an_unknown_category_says_which_there_are(world):
    odd = Table({"object_0": Thing("sofa", "red", Pose(0.0, -0.5, 0.2))})
    with pytest.raises(SpecError, match=r"object_0: category: no body for 'sofa'; there are block, bowl"):
        world.reset(odd)


def test_poses_survive_the_simulator(world):
    turned = Pose(0.1, -0.6, 0.3, 0.2, -0.7, 2.5)
    world.reset(Table({"object_0": Thing("block", "red", Pose(0.0, -0.5, 0.02))}))
    from proc3s_tabletop.robot import frames as poses

    assert poses.numbers(poses.frame(turned)) == pytest.approx(vars(turned))
    rotation = world.table.scene.client.getQuaternionFromEuler([0.2, -0.7, 2.5])
    assert poses.frame(turned).rotation == pytest.approx(rotation)


def test_pieces_that_are_far_from_their_mesh_come_with_advice():
    none = np.zeros((0, 3))
    world = ReferenceWorld(SimpleNamespace())
    for name, error in {"fine": 0.0018, "plate": 0.0056}.items():
        world.categories = {name: Body(Mesh(name, (none,), none, Surface(none, none), error), 0.1)}
        assert world.facts() == [f"{name}: 1 convex piece, {1e3 * error:.1f} mm off the mesh"]
        told = {text: "`concavity`" in advice for text, advice in world.coarse().items()}
        coarse = {"plate is 5.6 mm off its 1 convex piece": True}
        assert told == (coarse if name == "plate" else {})


def test_bowls_of_two_sizes_are_two_shapes():
    small = {"shape": "bowl", "mass": 0.2, "rim_radius": 0.05, "foot_radius": 0.03, "height": 0.03}
    bodies = bodies_of({"large": {"shape": "bowl", "mass": 0.3}, "small": small})
    scene = Scene(bodies, ReferenceSettings())
    try:
        wide = {}
        for name, body in bodies.items():
            low, high = scene.client.getAABB(scene.bodies[name])
            wide[name] = (high[0] - low[0]) / 2
            assert wide[name] == pytest.approx(body.shape.rim_radius, abs=0.003)
        assert wide["small"] < wide["large"]
    finally:
        scene.close()
