"""What is too wide for the open hand is said to be that, by world and screens, and only that is."""

import dataclasses
import math

import numpy as np
import pytest
from blocks_domain import belief, blocks_domain

from proc3s import Action, PlanBatch
from proc3s.domain.margins import check
from proc3s.domain.world import make_world
from proc3s_tabletop import sentences
from proc3s_tabletop.objects.shapes import Bowl, Box, Cylinder, Shape
from proc3s_tabletop.robot.grasp_frames import top_down
from proc3s_tabletop.robot.widths import too_wide
from proc3s_tabletop.screens.geometry import geometry

AT = (0.0, -0.5, 0.02)
SAYS = sentences.too_wide("object_0 (the red thing)", 0.08)
TURNED = (0.0, 0.0, math.pi / 4)


def box(width, length=0.04):
    return {"shape": "box", "size": [length, width, 0.04], "mass": 0.1}


def can(diameter):
    return {"shape": "cylinder", "radius": diameter / 2, "height": 0.04, "mass": 0.1}


def domain_of(body):
    spec = blocks_domain().spec
    world = spec.world.model_copy(update={"args": {"bodies": {"thing": body}}})
    return dataclasses.replace(blocks_domain(), spec=spec.model_copy(update={"world": world}))


def told(body, at=AT, turn=()):
    """The first violation of a pick, as the world has it, and as the screen has it if it has one."""
    domain = domain_of(body)
    scene = belief(domain, ("thing", "red", *AT, *turn))
    world = make_world(domain)
    try:
        world.reset(scene)
        _, found, _ = check(domain, world.step(Action("pick", at)), 0)
    finally:
        world.close()
    signatures = domain.signatures(scene)
    first = [s.skill for s in signatures].index("pick")
    start, offset = np.array([0, 1]), np.array([0, 3])
    batch = PlanBatch(signatures, start, np.array([first], np.uint8), offset, np.array(at, float))
    screened = geometry(scene, batch, domain)[0]
    return found[0].text if found else None, screened.text if screened else None


@pytest.mark.parametrize(
    ("body", "turn"),
    [
        *((box(width), ()) for width in (0.082, 0.083, 0.085, 0.088, 0.1, 0.2)),
        *((can(width), ()) for width in (0.083, 0.085, 0.09, 0.15)),
        (box(0.07, 0.07), TURNED),
    ],
)
def test_what_is_too_wide_is_called_so_by_world_and_screen(body, turn):
    world, screen = told(body, turn=turn)
    assert world == f"the grasp fails: {SAYS}"
    assert screen in (None, world)


@pytest.mark.parametrize("width", [0.1, 0.15])
def test_the_screen_sees_it_from_above(width):
    assert told(box(width))[1] == f"the grasp fails: {SAYS}"


@pytest.mark.parametrize(
    ("body", "at", "words"),
    [
        (box(0.07), (0.0, -0.46, 0.02), "come down on"),
        (box(0.07), (0.022, -0.5, 0.02), "too little of"),
        (box(0.2), (0.1, -0.5, 0.02), "nothing is between the fingers"),
        (box(0.2), (0.0, -0.5, 0.08), "nothing is between the fingers"),
    ],
)
def test_what_fits_or_is_elsewhere_is_not(body, at, words):
    world, screen = told(body, at)
    assert words in world
    assert screen in (None, world)


def test_what_just_fits_is_grasped():
    assert told(box(0.08)) == told(can(0.08)) == (None, None)


def test_a_wall_with_a_finger_inside_is_not_wide():
    """The far side of a bowl does not count when its rim is grasped."""
    grasps = np.stack([top_down(0.0, 0.078, 0.02), top_down(0.0, 0.0, 0.0), top_down(0.0, 0.0, -0.024)])
    assert too_wide(Bowl(), grasps).tolist() == [False, False, True]


def test_shapes_are_made_up_of_their_parts():
    shapes: list[Shape] = [Box((0.1, 0.1, 0.1)), Cylinder(0.05, 0.1), Bowl()]
    for shape in shapes:
        corners = np.vstack(shape.parts())
        assert np.ptp(corners, axis=0) == pytest.approx(np.ptp(shape.corners(), axis=0), abs=0.003)
