"""Grasps from above by chance, as the paper's domain with scanned objects draws them."""

import math
from dataclasses import dataclass

import numpy as np

from proc3s import FloatArray

SPREAD = 0.02
"""Of the grasp point to either side of the object's centre along its x and y, m."""
RISE = 0.005
"""Of the grasp point above the object's centre: 5 mm back along the grasp's z, which points down, m."""


@dataclass(frozen=True)
class GraspSampler:
    """A pose of the grasp point in the frame of an object: near its centre, pointing down, any yaw.

    Decodes points (n, 3) of the unit cube to x, y, z (m), roll, pitch, yaw (rad), (n, 6).
    """

    dim = 3

    def decode(self, u: FloatArray) -> FloatArray:
        """Shape (n, 3) to (n, 6)."""
        x, y, yaw = (2 * u.T - 1) * np.array([[SPREAD], [SPREAD], [math.pi]])
        same = np.ones(len(u))
        return np.stack([x, y, RISE * same, 0 * same, math.pi * same, yaw], axis=1)
