"""What stands beside an object that is set down, and how near."""

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.actions.attempt import Attempt
from proc3s_tabletop.engine.protocol import Simulation
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.telemetry import Clearance, least

NEAR = 0.013
"""Neighbours count up to here, m: more than three errors that each of two is expected to be placed with."""
RAISED = 0.001
"""An object is looked at from this much above where it will stand, so that it touches no support, m."""


def note_neighbours(attempt: Attempt, name: str, stands: Frame) -> None:
    """Note how near an object comes, where it will stand, to what is beside it and does not support it.

    Leaves it there. What ends below its lowest point is not in its way, and does not count.
    """
    scene, support = attempt.scene, attempt.telemetry.support
    scene.put(name, lower(stands, -RAISED))
    others = (other for other in scene.names if other not in (name, support))
    near = {other: scene.beside(name, other, NEAR) for other in others}
    lowest = _heights(scene, name).min() if any(d is not None for d in near.values()) else 0.0
    attempt.note_clearance(
        least(
            [
                # The descent has found what the object touches.
                Clearance(max(0.0, distance), name, other, shared=True)
                for other, distance in near.items()
                if distance is not None and _heights(scene, other).max() > lowest
            ]
        )
    )


def lower(frame: Frame, drop: float) -> Frame:
    """A frame that is lower by so much, m."""
    x, y, z = frame.position
    return Frame((x, y, z - drop), frame.rotation)


def _heights(scene: Simulation, name: str) -> FloatArray:
    """How high the corners (n,) of an object are, m."""
    (x, y, z, w), height = scene.frame(name).rotation, scene.frame(name).position[2]
    up = np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
    heights: FloatArray = scene.shapes[name].shape.corners() @ up + height
    return heights
