"""Mesh files as bodies: prepared once, with convex pieces and the way they lie at rest, and then kept."""

import functools
import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop import mesh_cache
from proc3s_tabletop.bodies import MARGIN, Mesh, Surface

FORMAT = 3
"""Of what is kept; another number makes everything anew."""

SMALLEST, LARGEST = 0.002, 1.0
"""Edges of the box around a body, m: what is thinner or larger is no object for this table."""

SLIVER = 0.001
"""What is joined to nothing and has less than this share of the largest part's surface is no part of it."""

Turn: TypeAlias = tuple[float, float, float]


def prepare(path: Path, scale: float = 1.0, turn: Turn = (0.0, 0.0, 0.0)) -> Mesh:
    """A mesh file as a body in metres: `scale` times its numbers, turned by roll, pitch, yaw (rad), at rest.

    Raises ValueError that says what is wrong with a file that is no mesh of a body.
    """
    if not path.is_file():
        raise ValueError(f"there is no file {path}")
    stat = path.stat()
    return _prepared(path, scale, turn, (stat.st_mtime_ns, stat.st_size))


@functools.lru_cache(maxsize=256)
def _prepared(path: Path, scale: float, turn: Turn, version: tuple[int, int]) -> Mesh:
    content = path.read_bytes()
    said = f"{FORMAT} {path.suffix.lower()} {scale!r} {turn!r} {MARGIN!r}\n"
    key = hashlib.sha256(said.encode() + content).hexdigest()
    found = mesh_cache.kept(key, lambda: _made(path, scale, turn))
    counts = np.cumsum(found["counts"])[:-1]
    return Mesh(
        key,
        tuple(np.split(found["pieces"], counts)),
        found["hull"],
        Surface(found["vertices"], found["faces"]),
        float(found["error"]),
    )


def _made(path: Path, scale: float, turn: Turn) -> mesh_cache.Arrays:
    """Everything that is known of a mesh, as arrays."""
    from proc3s_tabletop.pieces import pieces_of
    from proc3s_tabletop.resting import rest
    from proc3s_tabletop.surfaces import distance

    mesh = _read(path, scale, turn)
    pieces = pieces_of(mesh)
    middle = mesh.center_mass if mesh.is_watertight else _middle(pieces)
    pieces = [piece - middle for piece in pieces]
    turned = rest(pieces)
    pieces = [piece @ turned.T for piece in pieces]
    vertices = (mesh.vertices - middle) @ turned.T
    return {
        "pieces": np.vstack(pieces),
        "counts": np.array([len(piece) for piece in pieces]),
        "hull": _hull(np.vstack(pieces)),
        "vertices": vertices.astype(np.float32),
        "faces": np.asarray(mesh.faces, np.int32),
        "error": np.array(distance(vertices, mesh.faces, pieces)),
    }


def _read(path: Path, scale: float, turn: Turn) -> Any:
    import trimesh

    from proc3s_tabletop.extents import FLAT, rotation, thickness

    try:
        mesh = trimesh.load_mesh(path)
    except Exception as error:  # every reader of trimesh has its own way to fail
        raise ValueError(f"{path.name} cannot be read as a mesh: {error}") from error
    if not len(getattr(mesh, "faces", ())) or not np.isfinite(mesh.vertices).all():
        raise ValueError(f"{path.name} holds no triangles")
    mesh = _without_slivers(mesh)
    mesh.apply_scale(scale)
    size = np.ptp(mesh.vertices, axis=0)
    if size.min() < SMALLEST or size.max() > LARGEST:
        raise ValueError(
            f"{path.name} is {' x '.join(f'{edge:.4g}' for edge in size)} m: is its scale right?"
        )
    if thickness(mesh.vertices) < FLAT:
        raise ValueError(f"{path.name} is flat")
    matrix = np.eye(4)
    matrix[:3, :3] = rotation(*turn)
    mesh.apply_transform(matrix)
    return mesh


def _without_slivers(mesh: Any) -> Any:
    from trimesh.util import concatenate

    parts = mesh.split(only_watertight=False)
    least = SLIVER * max(part.area for part in parts)
    return concatenate([part for part in parts if part.area >= least])


def _middle(pieces: Sequence[FloatArray]) -> FloatArray:
    """The centre of mass of the union of pieces."""
    from scipy.spatial import ConvexHull

    corners = np.vstack(pieces)
    axes = [
        np.linspace(low, high, 42)[1:-1] for low, high in zip(corners.min(0), corners.max(0), strict=True)
    ]
    grid = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 3)
    inside = np.zeros(len(grid), bool)
    for piece in pieces:
        planes = ConvexHull(piece).equations
        inside |= (grid @ planes[:, :3].T + planes[:, 3] <= 0).all(axis=1)
    middle: FloatArray = grid[inside].mean(axis=0)
    return middle


def _hull(corners: FloatArray) -> FloatArray:
    """Corners of the hull of points with a margin to both sides along every axis."""
    from scipy.spatial import ConvexHull

    ways = MARGIN * np.vstack([np.eye(3), -np.eye(3)])
    around = (corners[ConvexHull(corners).vertices][:, None] + ways).reshape(-1, 3)
    found: FloatArray = around[ConvexHull(around).vertices]
    return found
