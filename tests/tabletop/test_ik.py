import math

import numpy as np
import pytest

from proc3s_tabletop.bullet.arm import Robot
from proc3s_tabletop.bullet.client import Client
from proc3s_tabletop.robot import ik
from proc3s_tabletop.robot.grasp_frames import tool_poses, top_down
from proc3s_tabletop.robot.settings import HOME, ReferenceSettings


@pytest.fixture(scope="module")
def joints():
    return np.random.default_rng(0).uniform(-math.pi, math.pi, (500, 6))


@pytest.fixture(scope="module")
def robot(tmp_path_factory):
    client = Client()
    yield Robot(client, ReferenceSettings(), tmp_path_factory.mktemp("robot"))
    client.close()


def matrix(client, pose):
    position, rotation = pose
    transform = np.eye(4)
    transform[:3, :3] = np.reshape(client.getMatrixFromQuaternion(rotation), (3, 3))
    transform[:3, 3] = position
    return transform


def test_forward_kinematics_is_that_of_the_simulator(robot, joints):
    for q, pose in zip(joints[:200], ik.forward(joints[:200]), strict=True):
        robot.put_arm(q)
        assert np.abs(matrix(robot.client, robot.tool()) - pose).max() < 1e-6


def test_every_branch_reaches_the_pose(joints):
    poses = ik.forward(joints)
    solutions, exists = ik.inverse(poses)
    assert exists.any(axis=1).all()
    assert np.abs(ik.forward(solutions) - poses[:, None])[exists].max() < 1e-9


def test_the_angles_that_made_the_pose_are_among_the_branches(joints):
    solutions, _ = ik.inverse(ik.forward(joints))
    distance = np.nanmin(np.nanmax(np.abs(ik.wrap(solutions - joints[:, None])), axis=2), axis=1)
    assert distance.max() < 1e-6


def test_the_branches_are_those_of_another_library(joints):
    ur5e = pytest.importorskip("ur_analytic_ik").ur5e
    poses = ik.forward(joints)
    solutions, exists = ik.inverse(poses)
    for pose, found, which in zip(poses, solutions, exists, strict=True):
        others = np.array(ur5e.inverse_kinematics(np.ascontiguousarray(ik.BASE @ pose))).reshape(-1, 6)
        assert len(others) == which.sum()
        for other in others:
            assert np.abs(ik.wrap(found[which] - other)).max(axis=1).min() < 1e-5


def test_what_is_out_of_reach_has_no_branch():
    pose = ik.forward(np.array([HOME]))
    pose[:, :3, 3] *= 3
    solutions, exists = ik.inverse(pose)
    assert not exists.any()
    assert np.isnan(solutions).all(axis=-1).all() or not np.isfinite(solutions).all(axis=-1).any()


def test_the_nearest_branch_comes_first(joints):
    solutions, exists = ik.inverse(ik.forward(joints))
    for q, found, which in zip(joints, solutions, exists, strict=True):
        order = ik.nearest_first(found, which, q)
        travel = [np.abs(ik.wrap(found[k] - q)).sum() for k in order]
        assert len(order) == which.sum()
        assert travel == sorted(travel)
        assert travel[0] < 1e-6


def test_a_path_stays_continuous_and_within_the_limits():
    turning = ik.wrap(np.linspace(0, 1.9 * math.pi, 100)[:, None] * np.ones(6))
    path = ik.unwound(turning, np.zeros(6))
    assert np.abs(np.diff(path, axis=0)).max() < 0.1
    wound_up = ik.unwound(turning[:20], np.full(6, 1.9 * math.pi))
    assert np.abs(ik.wrap(wound_up - turning[:20])).max() < 1e-9
    assert (wound_up[:, [0, 1, 3, 4, 5]] <= 2 * math.pi).all()


def test_the_whole_table_is_in_reach(robot):
    xs, ys = np.linspace(-0.3, 0.3, 7), np.linspace(-0.8, -0.2, 7)
    points = [(x, y, z) for x in xs for y in ys for z in (0.0, 0.2)]
    _, exists = ik.inverse(tool_poses(np.array([top_down(*point) for point in points])))
    assert exists.any(axis=1).all()


def test_the_fingers_open_along_y_and_close_symmetrically(robot):
    solutions, exists = ik.inverse(tool_poses(top_down(0.1, -0.5, 0.2)[None]))
    robot.put_arm(solutions[0][ik.nearest_first(solutions[0], exists[0], np.array(HOME))[0]])
    for angle, gap in ((0.0, 0.085), (robot.angle_for(0.04), 0.04)):
        robot.put_fingers(angle)
        left, right = robot.pads()
        assert robot.gap() == pytest.approx(gap, abs=1.5e-3)
        assert abs(left[0] - right[0]) < 1e-3
        assert (left[1] + right[1]) / 2 == pytest.approx(-0.5, abs=1e-3)
    point, along = robot.grasp_point()
    assert point == pytest.approx([0.1, -0.5, 0.2], abs=1e-6)
    assert along == pytest.approx([0, 0, -1], abs=1e-6)
