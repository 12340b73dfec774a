"""The skills of the toolbox: picking and placing at points, and of named objects."""

import dataclasses
from typing import Protocol

import numpy as np

from proc3s import FloatArray, Pose
from proc3s_tabletop.telemetry import Telemetry


class Arm(Protocol):
    """What carries picks and places out, from above; points in metres, poses as six numbers."""

    def pick(self, x: float, y: float, z: float) -> Telemetry:
        """Grasp at a point."""

    def place(self, x: float, y: float, z: float, turn: float = 0.0) -> Telemetry:
        """Set down what is held over a point, the hand turned about z."""

    def pick_object(self, name: str, grasp: FloatArray) -> Telemetry:
        """Grasp an object by a pose (6,) of the grasp point in its frame."""

    def place_object(self, name: str, grasp: FloatArray, pose: FloatArray) -> Telemetry:
        """Bring an object that is held by a grasp (6,) to a pose (6,) of the world."""


class HasTable(Protocol):
    """A world in which these skills work."""

    @property
    def table(self) -> Arm:
        """The table that they work on."""

    def placed(self, x: float, y: float, z: float) -> tuple[float, float, float, float]:
        """Where something is placed that is to be placed at a point, and its turn about z, rad."""


def pick(world: HasTable, x: float, y: float, z: float) -> Telemetry:
    """The skill: grasp from above at a point in metres, and lift."""
    return world.table.pick(x, y, z)


def place(world: HasTable, x: float, y: float, z: float) -> Telemetry:
    """The skill: set down what is held over a point in metres, and let go."""
    return world.table.place(*world.placed(x, y, z))


def pick_object(world: HasTable, o: str, g: Pose) -> Telemetry:
    """The skill: grasp an object by a pose of the grasp point in its frame, wherever it is now, and lift."""
    return world.table.pick_object(o, np.array(dataclasses.astuple(g)))


def place_object(world: HasTable, o: str, g: Pose, p: Pose) -> Telemetry:
    """The skill: bring an object that is held by a grasp to a pose of the world, and let go."""
    x, y, z, turn = world.placed(p.x, p.y, p.z)
    pose = np.array([x, y, z, p.roll, p.pitch, p.yaw + turn])
    return world.table.place_object(o, np.array(dataclasses.astuple(g)), pose)
