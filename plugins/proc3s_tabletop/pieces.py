"""Convex pieces of a mesh, such that PyBullet's surface around them is where the surface of the mesh is."""

import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.bodies import MARGIN

MOST = 64
"""Corners of a piece; Bullet slows down beyond."""


def pieces_of(mesh: Any) -> list[FloatArray]:
    """Corners (n, 3) of every convex piece of a trimesh mesh, m; each is to be surrounded by MARGIN."""
    points = _dense(mesh)
    found = [core(inside) for inside in _parts(mesh, points)]
    return [piece for piece in found if len(piece) >= 4]


def core(points: FloatArray) -> FloatArray:
    """At most MOST corners (n, 3) of which a margin around makes the hull of points, as near as may be."""
    from scipy.spatial import ConvexHull

    hull = ConvexHull(points)
    corners = points[hull.vertices]
    few = _few(corners)
    short = _outside(ConvexHull(few), corners).clip(0).mean()
    return _shrunk(few, MARGIN - float(short))


def _few(corners: FloatArray) -> FloatArray:
    """The corners that matter most: begun with the outermost, each next is the one furthest outside."""
    from scipy.spatial import ConvexHull

    if len(corners) <= MOST:
        return corners
    first = np.unique([corners.argmin(axis=0), corners.argmax(axis=0)])
    if len(first) < 4:
        return corners[:: len(corners) // MOST + 1]
    hull = ConvexHull(corners[first], incremental=True)
    while len(hull.points) < MOST:
        outside = _outside(hull, corners)
        hull.add_points(corners[[outside.argmax()]])
    hull.close()
    return np.array(hull.points[ConvexHull(hull.points).vertices])


def _outside(hull: Any, points: FloatArray) -> FloatArray:
    """How far points (n, 3) are outside a hull: of its planes the worst, m."""
    furthest: FloatArray = (points @ hull.equations[:, :3].T + hull.equations[:, 3]).max(axis=1)
    return furthest


def _shrunk(corners: FloatArray, by: float) -> FloatArray:
    """Corners moved such that the planes around each move inwards, by least squares."""
    from scipy.spatial import ConvexHull

    hull = ConvexHull(corners)
    moved = corners.copy()
    for k in hull.vertices:
        normals = hull.equations[(hull.simplices == k).any(axis=1), :3]
        step, *_ = np.linalg.lstsq(normals, np.full(len(normals), -by), rcond=0.1)
        moved[k] += step
    return moved[hull.vertices]


def _dense(mesh: Any, edge: float = 0.004) -> FloatArray:
    import trimesh

    vertices, _ = trimesh.remesh.subdivide_to_size(mesh.vertices, mesh.faces, edge)
    return np.asarray(vertices)


def _parts(mesh: Any, points: FloatArray) -> Iterator[FloatArray]:
    """The points of the surface within each piece that V-HACD finds, a voxel more to every side."""
    from scipy.spatial import ConvexHull

    resolution = 100_000
    voxel = float(np.prod(mesh.extents) / resolution) ** (1 / 3)
    for corners in _decomposed(mesh, resolution):
        inside = points[_outside(ConvexHull(corners), points) < 0.7 * voxel]
        if len(inside) >= 4 and np.ptp(inside, axis=0).min() > 2 * MARGIN:
            yield inside


def _decomposed(mesh: Any, resolution: int) -> list[FloatArray]:
    import pybullet

    with tempfile.TemporaryDirectory() as folder:
        source, made, log = (str(Path(folder) / name) for name in ("in.obj", "out.obj", "log.txt"))
        mesh.export(source)
        with quiet():
            pybullet.vhacd(source, made, log, resolution=resolution, concavity=1e-4, gamma=1e-4)
        return groups(Path(made).read_text(encoding="ascii"))


def groups(text: str) -> list[FloatArray]:
    """The corners of every group of an OBJ file."""
    found: list[list[list[float]]] = []
    for line in text.splitlines():
        if line.startswith("o "):
            found.append([])
        elif line.startswith("v "):
            found[-1].append([float(number) for number in line.split()[1:4]])
    return [np.array(corners) for corners in found]


@contextmanager
def quiet() -> Iterator[None]:
    """C code that prints as it goes prints nowhere."""
    sys.stdout.flush()
    sys.stderr.flush()
    kept: Sequence[int] = [os.dup(1), os.dup(2)]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    try:
        yield
    finally:
        for number, was in zip((1, 2), kept, strict=True):
            os.dup2(was, number)
            os.close(was)
        os.close(nowhere)
