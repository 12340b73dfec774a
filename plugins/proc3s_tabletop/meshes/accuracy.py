"""How far the surface that is simulated is from that of the mesh."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from proc3s import FloatArray
from proc3s_tabletop.objects.shapes import MARGIN

POINTS = 4000
"""Drawn on each surface."""
EDGE = 0.004
"""Triangles are cut until no edge is longer, m: their middles then say which are near a point."""
CLOSED = 0.0003
"""A wall with another piece this close in front of it is inside, m: pieces that touch leave no gap."""
NEAR = 12
"""Triangles that are looked at for a point."""


def distance(vertices: FloatArray, faces: Any, pieces: Sequence[FloatArray]) -> float:
    """95th percentile, the larger of both ways, of the distance between mesh and pieces with margin, m.

    Points are drawn on the mesh, and on the outside of the union of the pieces.
    """
    rng = np.random.default_rng(0)
    (mesh, _), made = _small(vertices, faces), _outside(pieces)
    there = _nearest(_drawn(rng, mesh), made)
    back = _nearest(_drawn(rng, made), mesh)
    return float(max(np.percentile(there, 95), np.percentile(back, 95)))


def _small(vertices: FloatArray, faces: Any) -> tuple[FloatArray, NDArray[np.intp]]:
    """Small triangles (n, 3, 3), and of which face each is."""
    from trimesh.remesh import subdivide_to_size

    small, corners, of = subdivide_to_size(vertices, faces, EDGE, return_index=True)
    return np.asarray(small[corners]), np.asarray(of, np.intp)


def _outside(pieces: Sequence[FloatArray]) -> FloatArray:
    """Triangles (n, 3, 3) of the surface that a margin makes around pieces."""
    from scipy.spatial import ConvexHull

    hulls = [ConvexHull(piece) for piece in pieces]
    normals = np.concatenate([hull.equations[:, None, :3] for hull in hulls])
    moved = np.concatenate([hull.points[hull.simplices] for hull in hulls]) + MARGIN * normals
    triangles, of = _small(moved.reshape(-1, 3), np.arange(3 * len(moved)).reshape(-1, 3))
    before = triangles.mean(axis=1) + CLOSED * normals[of, 0]
    inside = np.zeros(len(before), bool)
    for hull in hulls:
        low, high = hull.points.min(axis=0) - MARGIN, hull.points.max(axis=0) + MARGIN
        near = np.flatnonzero(~inside & (before > low).all(axis=1) & (before < high).all(axis=1))
        deep = (before[near] @ hull.equations[:, :3].T + hull.equations[:, 3]).max(axis=1)
        inside[near] = deep < MARGIN
    return triangles[~inside]


def _drawn(rng: np.random.Generator, triangles: FloatArray) -> FloatArray:
    """Points (n, 3) spread evenly over triangles."""
    a, b, c = triangles.transpose(1, 0, 2)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    chosen = rng.choice(len(triangles), POINTS, p=areas / areas.sum())
    u = rng.random((POINTS, 2))
    u = np.where(u.sum(axis=1, keepdims=True) > 1, 1 - u, u)
    points: FloatArray = a[chosen] + u[:, :1] * (b - a)[chosen] + u[:, 1:] * (c - a)[chosen]
    return points


def _nearest(points: FloatArray, triangles: FloatArray) -> FloatArray:
    """Distances (n,) of points to the nearest triangle, m."""
    from scipy.spatial import cKDTree
    from trimesh.triangles import closest_point

    count = min(NEAR, len(triangles))
    _, which = cKDTree(triangles.mean(axis=1)).query(points, k=count)
    repeated = np.repeat(points, count, axis=0)
    away = np.linalg.norm(closest_point(triangles[which.ravel()], repeated) - repeated, axis=1)
    nearest: FloatArray = away.reshape(-1, count).min(axis=1)
    return nearest
