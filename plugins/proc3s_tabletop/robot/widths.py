"""How wide a body is where fingers are to grasp it."""

import functools
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from proc3s import FloatArray
from proc3s_tabletop.objects.shapes import Shape
from proc3s_tabletop.robot.hand_profile import GAPS, WIDEST
from proc3s_tabletop.robot.settings import ReferenceSettings

Bools: TypeAlias = NDArray[np.bool_]

SIDE = max(GAPS) / 2
"""From the middle of the open hand to a pad, m."""


def too_wide(shape: Shape, grasps: FloatArray) -> Bools:
    """Whether a body reaches further between the pads than they take, for grasps (n, 4, 4) in its frame.

    Shape (n,). What lies beyond a pad does not count: it may be a wall with the finger inside.
    """
    settings = ReferenceSettings()
    grid = [(0.0, across, along) for along in settings.cover_along for across in settings.cover_across]
    starts = (grasps[:, None, :3, :3] @ np.array(grid)[..., None])[..., 0] + grasps[:, None, :3, 3]
    low, high = np.full(starts.shape[:2], np.inf), np.full(starts.shape[:2], -np.inf)
    for planes in _parts(shape):
        enters, leaves = _clipped(planes, starts, grasps[:, None, :3, 0])
        between = (enters < leaves) & (enters < SIDE) & (leaves > -SIDE)
        low, high = (
            np.where(between, np.minimum(low, enters), low),
            np.where(between, np.maximum(high, leaves), high),
        )
    wide: Bools = np.any(high - low > WIDEST, axis=1)
    return wide


def _clipped(planes: FloatArray, starts: FloatArray, way: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Where lines from `starts` (n, k, 3) along `way` (n, 1, 3) enter and leave a convex part,
    each (n, k), m; a line that misses it leaves before it enters."""
    ahead = np.broadcast_to(way @ planes[:, :3].T, (*starts.shape[:2], len(planes)))
    room = -(starts @ planes[:, :3].T + planes[:, 3])
    with np.errstate(divide="ignore", invalid="ignore"):
        met = room / ahead
    outside = (np.abs(ahead) < 1e-12) & (room < 0)
    enters = np.where(ahead < -1e-12, met, np.where(outside, np.inf, -np.inf)).max(axis=2)
    leaves = np.where(ahead > 1e-12, met, np.inf).min(axis=2)
    return enters, leaves


@functools.lru_cache(256)
def _parts(shape: Shape) -> list[FloatArray]:
    """The planes (m, 4) of the hull of every convex part of a body; inside, all are negative."""
    from scipy.spatial import ConvexHull

    return [ConvexHull(corners).equations for corners in shape.parts()]
