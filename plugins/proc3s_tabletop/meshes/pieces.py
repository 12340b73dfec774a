"""Convex pieces of a mesh, such that PyBullet's surface around them is where the surface of the mesh is."""

from typing import Any

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.meshes.coacd import take_apart
from proc3s_tabletop.meshes.planes import cut
from proc3s_tabletop.objects.hulls import grown
from proc3s_tabletop.objects.shapes import MARGIN

FULL = 0.5
"""A body that fills less of its hull needs too many planes; for others they are quicker than CoACD."""
MOST = 64
"""Corners of a piece; Bullet slows down beyond."""


def pieces_of(mesh: Any, concavity: float | None = None) -> list[FloatArray]:
    """Corners (n, 3) of every convex piece of a trimesh mesh, m; each is to be surrounded by MARGIN.

    The same mesh always gives the same pieces: between a few planes, where those do, or else CoACD's, which
    are as hollow as `concavity` allows, a share of the longest edge.
    """
    sparse = closed(mesh) and abs(mesh.volume) < FULL * mesh.convex_hull.volume
    parts = None if sparse or concavity is not None else cut(mesh)
    return [core(points) for points in parts or take_apart(mesh, concavity)]


def closed(mesh: Any) -> bool:
    """Whether a mesh encloses a volume that can be measured: it has no holes, and one outside."""
    return bool(mesh.is_watertight and mesh.is_winding_consistent)


def core(points: FloatArray) -> FloatArray:
    """At most MOST corners (n, 3) of which a margin around makes the hull of points, as near as may be."""
    from scipy.spatial import ConvexHull

    hull = ConvexHull(points)
    corners = points[hull.vertices]
    few = _few(corners)
    short = _outside(ConvexHull(few), corners).clip(0).mean()
    return grown(few, float(short) - MARGIN)


def _few(corners: FloatArray) -> FloatArray:
    """The corners that matter most: begun with the outermost, each next is the one furthest outside."""
    from scipy.spatial import ConvexHull, QhullError

    if len(corners) <= MOST:
        return corners
    first = np.unique([corners.argmin(axis=0), corners.argmax(axis=0)])
    try:
        hull = ConvexHull(corners[first], incremental=True)
        while len(hull.points) < MOST:
            outside = _outside(hull, corners)
            hull.add_points(corners[[outside.argmax()]])
        hull.close()
    except QhullError:  # too few to begin with, or too thin to grow
        return corners[:: len(corners) // MOST + 1]
    return np.array(hull.points[ConvexHull(hull.points).vertices])


def _outside(hull: Any, points: FloatArray) -> FloatArray:
    """How far points (n, 3) are outside a hull: of its planes the worst, m."""
    furthest: FloatArray = (points @ hull.equations[:, :3].T + hull.equations[:, 3]).max(axis=1)
    return furthest
