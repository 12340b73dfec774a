"""Grasps from above by chance, as the paper's domain with scanned objects draws them."""

import functools
import math
from dataclasses import dataclass

import numpy as np

from proc3s import FloatArray

SPREAD = 0.02
"""Of the grasp point to either side of the object's centre along its x and y, m."""
RISE = 0.005
"""Of the grasp point above the object's centre: 5 mm back along the grasp's z, which points down, m."""
CELLS = 8
"""The pool has one grasp in each of so many parts of every dimension."""


@dataclass(frozen=True)
class GraspSampler:
    """A pose of the grasp point in the frame of an object: near its centre, pointing down, any yaw.

    Decodes points (n, 3) of the unit cube to x, y, z (m), roll, pitch, yaw (rad), (n, 6): the grasp of the
    pool that lies in the same cell. So few grasps recur, and what is known of one need not be found again.
    """

    dim = 3

    def decode(self, u: FloatArray) -> FloatArray:
        """Shape (n, 3) to (n, 6)."""
        cells = np.clip(np.floor(np.asarray(u) * CELLS).astype(int), 0, CELLS - 1)
        found: FloatArray = pool()[cells @ [CELLS * CELLS, CELLS, 1]]
        return found


@functools.cache
def pool() -> FloatArray:
    """All grasps that are drawn, (512, 6): one at a fixed random place in every cell of the unit cube."""
    steps = np.arange(CELLS)
    cells = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1).reshape(-1, 3)
    u = (cells + np.random.default_rng(0).random(cells.shape)) / CELLS
    x, y, yaw = (2 * u.T - 1) * np.array([[SPREAD], [SPREAD], [math.pi]])
    same = np.ones(len(u))
    grasps = np.stack([x, y, RISE * same, 0 * same, math.pi * same, yaw], axis=1)
    grasps.flags.writeable = False
    return grasps
