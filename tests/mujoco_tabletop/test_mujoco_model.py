"""The published models, put together: kinematics, the grasp point, and the hand that screens reckon with."""

import mujoco
import numpy as np
import pytest

from proc3s_mujoco.engine import MujocoEngine
from proc3s_mujoco.linkage import linkage
from proc3s_mujoco.profile import MENAGERIE
from proc3s_tabletop.engine.values import ALOFT
from proc3s_tabletop.objects.body import CATEGORIES
from proc3s_tabletop.robot import ik
from proc3s_tabletop.robot.grasp_frames import tool_poses, top_down
from proc3s_tabletop.robot.hand_profile import GAPS
from proc3s_tabletop.robot.settings import TCP

ENGINE = MujocoEngine()
NEXT_TO_THE_EDGE = 5e-4
DOWN = (1.0, 0.0, 0.0, 0.0)


@pytest.fixture(scope="module")
def scene():
    return ENGINE.scene({}, ENGINE.settings())


@pytest.fixture
def hand_scene():
    made = ENGINE.hand_scene({"block": CATEGORIES["block"]}, ENGINE.settings())
    made.hand.put((0.0, 0.0, TCP), DOWN)
    return made


def test_the_arm_is_where_the_closed_form_has_it(scene):
    for q in np.random.default_rng(0).uniform(-2, 2, (20, 6)):
        scene.robot.put_arm(q)
        position, (x, y, z, w) = scene.robot.tool()
        expected = ik.forward(q)
        assert position == pytest.approx(expected[:3, 3], abs=1e-9)
        assert [2 * (x * z + w * y), 2 * (y * z - w * x)] == pytest.approx(expected[:2, 2], abs=1e-9)


def test_a_grasp_from_above_opens_along_y_around_its_point(scene):
    solutions, exists = ik.inverse(tool_poses(top_down(0.1, -0.5, 0.2)[None]))
    scene.robot.put_arm(solutions[0, np.flatnonzero(exists[0])[0]])
    scene.robot.put_fingers(0.0)
    point, along = scene.robot.grasp_point()
    left, right = scene.robot.pads()
    assert point == pytest.approx([0.1, -0.5, 0.2], abs=1e-6)
    assert along == pytest.approx([0, 0, -1], abs=1e-6)
    assert abs(left - right) == pytest.approx([0, scene.robot.gap(), 0], abs=1e-6)
    assert ((left + right) / 2)[:2] == pytest.approx([0.1, -0.5], abs=1e-4)


def test_fingers_are_put_where_their_motor_would_have_them(hand_scene):
    hand = hand_scene.hand
    hand.put(*ALOFT)
    for angle in (0.1, 0.33, 0.61):
        hand.put_fingers(angle)
        put = np.array(hand.linkage())
        hand.drive_fingers(angle)
        hand_scene.tick(200)
        assert np.array(hand.linkage()) == pytest.approx(put, abs=6e-3)
        assert hand.angle_for(hand.gap()) == pytest.approx(hand.read_fingers()[0], abs=6e-3)


def test_the_pads_open_as_wide_as_the_screens_say():
    assert linkage().gaps.max() == pytest.approx(max(GAPS), abs=1.5e-3)
    assert linkage().gaps.min() == pytest.approx(0.0, abs=1e-3)


def below(scene, x, y):
    """Where a ray from below meets the hand, z in m."""
    geom = np.zeros(1, np.int32)
    robot = np.array([0, 0, 0, 1, 0, 0], np.uint8)
    start, up = np.array([x, y, -0.2]), np.array([0.0, 0.0, 1.0])
    far = mujoco.mj_ray(scene.state.model, scene.state.placed(), start, up, robot, True, -1, geom)
    return far - 0.2 if far >= 0 else np.inf


def highest(scene, column):
    """The highest point of a column's foot at which the hand begins."""
    start, stop, width, _ = column
    across = (-width + NEXT_TO_THE_EDGE, 0.0, width - NEXT_TO_THE_EDGE)
    along = np.linspace(start + NEXT_TO_THE_EDGE, stop - NEXT_TO_THE_EDGE, 4)
    return max(below(scene, x, y) for x in along for y in across)


@pytest.mark.parametrize("gap", np.linspace(0.002, 0.0845, 15).round(4).tolist())
def test_every_column_that_screens_reckon_with_lies_inside_the_hand(hand_scene, gap):
    hand_scene.hand.put_fingers(hand_scene.hand.angle_for(gap))
    for column in MENAGERIE.columns(gap):
        assert highest(hand_scene, column) <= column[3] + 2e-4, column
