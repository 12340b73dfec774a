"""Where a body is in the world: how high it reaches, and its outline seen from above."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from proc3s import FloatArray
from proc3s.domain.transforms import matrices
from proc3s_tabletop.objects.body import Body

FLAT = 0.0001
"""What is thinner than this is no solid, m."""


@dataclass(frozen=True)
class Extent:
    """A body at a pose: lowest and highest z, corners (n, 2) of its outline, how far it leans (m, rad)."""

    bottom: float
    top: float
    outline: FloatArray
    lean: float

    @property
    def upright(self) -> bool:
        """Whether it leans by less than 0.25 rad, the world's measure of a knocked-over object."""
        return self.lean < 0.25


def extent(body: Body, pose: Any) -> Extent:
    """The extent of a body whose middle is at a pose x, y, z (m), roll, pitch, yaw (rad)."""
    turn = rotation(pose.roll, pose.pitch, pose.yaw)
    corners = body.shape.corners() @ turn.T + [pose.x, pose.y, pose.z]
    lean = math.acos(float(np.clip(turn[2, 2], -1.0, 1.0)))
    return Extent(float(corners[:, 2].min()), float(corners[:, 2].max()), hull(corners[:, :2]), lean)


def thickness(points: FloatArray) -> float:
    """How far points (n, 3) reach along the direction in which they differ least, m."""
    *_, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    return float(np.ptp(points @ axes[-1]))


def rotation(roll: float, pitch: float, yaw: float) -> FloatArray:
    """The matrix (3, 3) of turns about the fixed axes x, y and z."""
    return matrices(np.array([0.0, 0.0, 0.0, roll, pitch, yaw]))[:3, :3]


def gap(a: FloatArray, b: FloatArray) -> float:
    """Distance of two convex outlines (n, 2), m; minus the depth to which they overlap."""
    apart = (b[None, :] - a[:, None]).reshape(-1, 2)
    normals = np.vstack([_normals(a), _normals(b), apart, -apart])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = normals[lengths[:, 0] > 1e-9] / lengths[lengths[:, 0] > 1e-9]
    return float(((b @ normals.T).min(axis=0) - (a @ normals.T).max(axis=0)).max())


def inside(outline: FloatArray, x: float, y: float) -> float:
    """How far a point lies inside a convex outline (n, 2), m; negative outside."""
    normals = _normals(outline)
    outside = ((np.array([x, y]) - outline) * normals).sum(axis=1) / np.linalg.norm(normals, axis=1)
    return -float(outside.max())


def common(a: FloatArray, b: FloatArray) -> FloatArray:
    """The corners (n, 2) of what two convex outlines have in common, in order; (0, 2) for nothing."""
    for corner, normal in zip(b, _normals(b), strict=True):
        over = (a - corner) @ normal
        ahead = np.roll(over, -1)
        crosses = over * ahead < 0
        share = np.divide(over, over - ahead, out=np.zeros_like(over), where=crosses)
        cut = a + share[:, None] * (np.roll(a, -1, axis=0) - a)
        a = np.stack([a, cut], axis=1)[np.stack([over <= 0, crosses], axis=1)]
    return a


def strip(points: FloatArray) -> float:
    """Least distance within which a straight line passes all points (n, 2)."""
    lines = (points[None, :] - points[:, None]).reshape(-1, 2)
    lines = lines[np.linalg.norm(lines, axis=1) > 1e-9]
    if not len(lines):
        return 0.0
    across = np.stack([-lines[:, 1], lines[:, 0]]) / np.linalg.norm(lines, axis=1)
    return float(np.ptp(points @ across, axis=0).min() / 2)


def _normals(outline: FloatArray) -> FloatArray:
    """Outward normals of the edges of an outline, one for the edge that begins at each corner."""
    edges = np.roll(outline, -1, axis=0) - outline
    return np.stack([edges[:, 1], -edges[:, 0]], axis=1)


# No scipy here: scenes are drawn without the extra, and Qhull takes three times as long for a block.
def hull(points: FloatArray) -> FloatArray:
    """The convex hull of points (n, 2), counter-clockwise."""
    ordered = sorted({(round(float(x), 9), round(float(y), 9)) for x, y in points})
    return np.array(_chain(ordered) + _chain(ordered[::-1]))


def _chain(ordered: list[tuple[float, float]]) -> list[tuple[float, float]]:
    chain: list[tuple[float, float]] = []
    for point in ordered:
        while len(chain) > 1 and _turn(chain[-2], chain[-1], point) <= 0:
            chain.pop()
        chain.append(point)
    return chain[:-1]


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
