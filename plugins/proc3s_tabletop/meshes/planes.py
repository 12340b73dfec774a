"""Cutting a mesh by planes into nearly convex parts: always the worst part, where that helps most."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from proc3s import FloatArray
from proc3s_tabletop.objects.extents import FLAT, thickness

MOST = 64
"""Parts at most."""
TOLERANCE = 0.0014
"""What lies less than this inside the hull of its part is well represented, m."""
SHARE = 0.06
"""Share of the surface that may lie deeper."""
OVERLAP = 0.0015
"""Parts reach this far over the plane between them, m."""
EDGE = 0.004
"""Longest edge of the triangles whose corners stand for the surface, m."""
VOXEL = 0.003
"""Distance of the points that stand for the inside, m: without them cavities stay where planes meet."""
LOOKED_AT = 250
"""Points of the surface by which planes are compared."""
JUDGED = 800
"""Points of the surface by which a part is judged."""
THIN, NARROW = 0.008, 0.003
"""A part thinner than this is not cut along that way, and nothing narrower is cut off, m."""

Indices = NDArray[np.intp]


class Part(NamedTuple):
    """Which points belong to a part, and what area of the surface its hull misrepresents, m2."""

    points: Indices
    bad: float


def cut(mesh: Any) -> list[FloatArray] | None:
    """The points (n, 3) of every part of a trimesh mesh, m; None where planes do not do."""
    points, areas = _points(mesh)
    rng = np.random.default_rng(0)
    parts = [_part(points, areas, np.arange(len(points)))]
    while sum(part.bad for part in parts) > SHARE * areas.sum():
        if len(parts) == MOST:
            return None
        worst = parts.pop(int(np.argmax([part.bad for part in parts])))
        halves = _halves(points, areas, worst, rng)
        if not halves:
            parts.append(worst._replace(bad=0.0))
        parts += [_part(points, areas, half) for half in halves]
    return [points[part.points] for part in parts if thickness(points[part.points]) > FLAT]


def _points(mesh: Any) -> tuple[FloatArray, FloatArray]:
    """Points (n, 3) on the surface and inside, and the area (n,) that each stands for: none inside, m2."""
    from trimesh.remesh import subdivide_to_size

    surface, faces = subdivide_to_size(mesh.vertices, mesh.faces, EDGE)
    a, b, c = surface[faces].transpose(1, 0, 2)
    areas = np.zeros(len(surface))
    np.add.at(areas, faces.ravel(), np.repeat(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6, 3))
    inside = _inside(mesh)
    return np.vstack([surface, inside]), np.append(areas, np.zeros(len(inside)))


def _inside(mesh: Any) -> FloatArray:
    """The middles (n, 3) of the voxels that the surface encloses."""
    from scipy.ndimage import binary_fill_holes
    from trimesh.remesh import subdivide_to_size

    dense, _ = subdivide_to_size(mesh.vertices, mesh.faces, 0.6 * VOXEL, max_iter=20)
    low = dense.min(axis=0) - VOXEL
    met = ((dense - low) / VOXEL).astype(int)
    surface = np.zeros(met.max(axis=0) + 2, bool)
    surface[tuple(met.T)] = True
    enclosed = np.argwhere(binary_fill_holes(surface) & ~surface)
    return np.asarray(low + (enclosed + 0.5) * VOXEL)


def _part(points: FloatArray, areas: FloatArray, which: Indices) -> Part:
    from scipy.spatial import ConvexHull, QhullError

    surface = which[areas[which] > 0]
    if not len(surface):
        return Part(which, 0.0)
    seen = surface[:: max(1, len(surface) // JUDGED)]
    try:
        deep = _depth(ConvexHull(points[which]), points[seen]) > TOLERANCE
    except QhullError:  # a fin without thickness is no part of a body
        return Part(which, 0.0)
    return Part(which, float(areas[seen][deep].sum() / areas[seen].sum() * areas[surface].sum()))


def _depth(hull: Any, points: FloatArray) -> FloatArray:
    """How deep points (n, 3) lie inside a hull, m."""
    deep: FloatArray = -(points @ hull.equations[:, :3].T + hull.equations[:, 3]).max(axis=1)
    return deep


def _halves(points: FloatArray, areas: FloatArray, part: Part, rng: np.random.Generator) -> list[Indices]:
    """The two sides of the best plane, overlapping; none where no plane is left."""
    some = _some(areas, part.points, rng)
    best = min(_planes(points[some], areas[some]), key=lambda found: found[0], default=None)
    if best is None:
        return []
    _, normal, offset = best
    height = points[part.points] @ normal
    return [part.points[height < offset + OVERLAP], part.points[height > offset - OVERLAP]]


def _some(areas: FloatArray, which: Indices, rng: np.random.Generator) -> Indices:
    """A few points of the surface and of the inside."""
    surface, inside = which[areas[which] > 0], which[areas[which] == 0]
    few = (rng.permutation(surface)[:LOOKED_AT], rng.permutation(inside)[: LOOKED_AT // 3])
    return np.concatenate(few)


def _planes(points: FloatArray, areas: FloatArray) -> Iterator[tuple[float, FloatArray, float]]:
    """Planes to cut at, as cost, normal and offset: across the axes and across the points' main ways."""
    from scipy.spatial import ConvexHull

    hull = ConvexHull(points)
    deep = points[(_depth(hull, points) > TOLERANCE) & (areas > 0)]
    *_, ways = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    whole = _cost(points, areas)
    for normal in (*np.eye(3), *ways):
        height = points @ normal
        low, high = float(height.min()), float(height.max())
        for offset in _offsets(low, high, deep @ normal):
            sides = height < offset, height >= offset
            if min(np.count_nonzero(side) for side in sides) >= 8:
                uneven = 0.02 * whole * abs((offset - low) / (high - low) - 0.5)
                yield sum(_cost(points[s], areas[s]) for s in sides) + uneven, normal, offset


def _offsets(low: float, high: float, deep: FloatArray) -> Iterator[float]:
    """Where along a way to cut: at its quarters, and where points lie deep."""
    if high - low < THIN:
        return
    wanted = [low + share * (high - low) for share in (0.25, 0.5, 0.75)]
    wanted += np.quantile(deep, (0.05, 0.3, 0.7, 0.95)).tolist() if len(deep) else []
    yield from (offset for offset in wanted if min(offset - low, high - offset) >= NARROW)


def _cost(points: FloatArray, areas: FloatArray) -> float:
    """The volume of a hull, and what lies between it and the surface, m3; nothing where points are flat."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        hull = ConvexHull(points)
    except QhullError:
        return 0.0
    empty = np.clip(_depth(hull, points) - TOLERANCE / 2, 0.0, None)
    return float(hull.volume + (areas * empty).sum())
