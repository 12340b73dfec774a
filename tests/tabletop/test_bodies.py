import numpy as np
import pytest
from tables import verdict

from proc3s_tabletop.actions.reference import Reference
from proc3s_tabletop.bullet.scene import Scene, Snapshot
from proc3s_tabletop.objects.body import BLOCK_SIZE, CATEGORIES, Body
from proc3s_tabletop.objects.shapes import Box, Cylinder
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.robot.settings import ReferenceSettings

UPRIGHT = (0.0, 0.0, 0.0, 1.0)


@pytest.fixture
def scene():
    """Makes scenes of bodies and closes them."""
    scenes = []

    def make(bodies):
        scenes.append(Scene(bodies, ReferenceSettings()))
        return scenes[-1]

    yield make
    for made in scenes:
        made.close()


def come_to_rest(scene, positions, ticks=240):
    frames = tuple((name, Frame(position, UPRIGHT)) for name, position in positions.items())
    scene.load(Snapshot(frames))
    scene.tick(ticks)
    return {name: np.array(scene.frame(name).position) for name in positions}


def test_bodies_stand_with_their_middle_at_half_their_height(scene):
    can, slab = Body(Cylinder(0.03, 0.1), mass=0.2), Body(Box((0.1, 0.05, 0.01)), mass=0.1)
    bodies = {**CATEGORIES, "can": can, "slab": slab}
    heights = {"block": BLOCK_SIZE, "bowl": 0.05, "can": 0.1, "slab": 0.01}
    starts = {name: (0.2 * k - 0.3, -0.5, h / 2) for k, (name, h) in enumerate(heights.items())}
    for name, position in come_to_rest(scene(bodies), starts).items():
        assert position == pytest.approx(starts[name], abs=3e-4), name


def test_a_bowl_keeps_the_blocks_that_fall_into_it(scene):
    made = scene(CATEGORIES)
    rng = np.random.default_rng(0)
    for x, y in rng.uniform(-0.04, 0.04, (40, 2)):
        rest = come_to_rest(made, {"bowl": (0.0, -0.5, 0.025), "block": (x, y - 0.5, 0.085)})
        assert np.linalg.norm((rest["block"] - rest["bowl"])[:2]) < 0.05
        assert rest["block"][2] < 0.05


def test_a_cylinder_is_picked_and_placed():
    world = Reference(
        {"can": Body(Cylinder(0.02, 0.08), mass=0.1)}, {"can": Frame((0.1, -0.5, 0.04), UPRIGHT)}
    )
    try:
        assert verdict(world.pick(0.1, -0.5, 0.05)) is None
        assert verdict(world.place(-0.1, -0.5, 0.05)) is None
        assert world.snapshot.frames[0][1].position == pytest.approx((-0.1, -0.5, 0.04), abs=1e-2)
    finally:
        world.close()
