"""From a grasp on an object to the poses of the tool, and back."""

import math

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.robot.settings import TCP, TOP_DOWN_YAW


def top_down(x: float, y: float, z: float, yaw: float = TOP_DOWN_YAW) -> FloatArray:
    """The pose (4, 4) of a grasp from above: its point in metres, the closing direction turned by yaw."""
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, s, 0.0, x], [s, -c, 0.0, y], [0.0, 0.0, -1.0, z], [0.0, 0.0, 0.0, 1.0]])


def tool_to_grasp() -> FloatArray:
    """The grasp point (4, 4) in the frame of tool0."""
    transform = np.eye(4)
    transform[2, 3] = TCP
    return transform


def tool_poses(grasps: FloatArray) -> FloatArray:
    """Poses of tool0 for poses of the grasp point."""
    return grasps @ np.linalg.inv(tool_to_grasp())
