"""The skills of the toolbox: picking and placing at points, and of named objects."""

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from proc3s import Pose
from proc3s_tabletop.telemetry import Telemetry

if TYPE_CHECKING:
    pass
from proc3s_tabletop.world import TabletopWorld


def pick(world: TabletopWorld, x: float, y: float, z: float) -> Telemetry:
    """The skill: grasp from above at a point in metres, and lift."""
    return world.table.pick(x, y, z)


def place(world: TabletopWorld, x: float, y: float, z: float) -> Telemetry:
    """The skill: set down what is held over a point in metres, and let go."""
    return world.table.place(*world.placed(x, y, z))


def pick_object(world: TabletopWorld, o: str, g: Pose) -> Telemetry:
    """The skill: grasp an object by a pose of the grasp point in its frame, wherever it is now, and lift."""
    return world.table.pick_object(o, np.array(dataclasses.astuple(g)))


def place_object(world: TabletopWorld, o: str, g: Pose, p: Pose) -> Telemetry:
    """The skill: bring an object that is held by a grasp to a pose of the world, and let go."""
    x, y, z = world.placed(p.x, p.y, p.z)
    pose = np.array([x, y, z, p.roll, p.pitch, p.yaw])
    return world.table.place_object(o, np.array(dataclasses.astuple(g)), pose)
