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
