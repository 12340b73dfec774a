"""What the classes of a state can do in a program: the text of these classes is copied into its box."""

from typing import Any

import numpy as np


class PoseMethods:
    """Methods of a pose with the fields x, y, z, roll, pitch and yaw."""

    x: float
    y: float
    z: float
    roll: float
    pitch: float
    yaw: float

    def __iter__(self) -> Any:
        return iter((self.x, self.y, self.z, self.roll, self.pitch, self.yaw))

    @property
    def point(self) -> Any:
        """[x, y, z]"""
        return np.array([self.x, self.y, self.z])

    @property
    def euler(self) -> Any:
        """[roll, pitch, yaw]"""
        return np.array([self.roll, self.pitch, self.yaw])


class RigidPoseMethods(PoseMethods):
    """The same, and poses may be composed: grasps are given in the frame of their object."""

    @property
    def rotation(self) -> Any:
        """The rotation matrix (3, 3)."""
        (cr, cp, cy), (sr, sp, sy) = np.cos(self.euler), np.sin(self.euler)
        return np.array(
            [
                [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                [-sp, cp * sr, cp * cr],
            ]
        )

    def multiply(self, other: Any) -> Any:
        """The pose that `other` is in the world when it is given in the frame of this one."""
        turn = self.rotation @ other.rotation
        level = np.hypot(turn[2, 1], turn[2, 2])
        roll, yaw = np.arctan2(turn[2, 1], turn[2, 2]), np.arctan2(turn[1, 0], turn[0, 0])
        if level < 1e-9:  # straight up or down: roll and yaw share one turn
            roll, yaw = 0.0, np.arctan2(-turn[0, 1], turn[1, 1])
        point = self.point + self.rotation @ other.point
        make: Any = type(self)
        return make(*map(float, (*point, roll, np.arctan2(-turn[2, 0], level), yaw)))


class ObjectMethods:
    """Methods of an object with a pose."""

    pose: Any

    @property
    def point(self) -> Any:
        """[x, y, z] of its centre"""
        return self.pose.point


class BeliefMethods:
    """Methods of a state with a dict of objects."""

    objects: dict[str, Any]

    def __getitem__(self, name: str) -> Any:
        """The object of that name."""
        return self.objects[name]
