"""Mesh files as bodies: prepared once, with convex pieces and the way they lie at rest, and then kept."""

import functools
import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from proc3s import FloatArray, UsageError
from proc3s.wording import plain
from proc3s_tabletop.meshes import cache as mesh_cache
from proc3s_tabletop.objects.shapes import MARGIN, Mesh, Surface

FORMAT = 3
"""Cache format version; bump it to invalidate old entries."""

SMALLEST, LARGEST = 0.002, 1.0
"""Edges of the box around a body, m: what is thinner or larger is no object for this table."""

SLIVER = 0.001
"""A loose part that has less than this share of the largest part's surface is no part of it."""

Turn: TypeAlias = tuple[float, float, float]


class MeshError(ValueError):
    """A file that is no mesh of a body; the sentence begins with its name."""


def prepare(
    path: Path, scale: float = 1.0, turn: Turn = (0.0, 0.0, 0.0), concavity: float | None = None
) -> Mesh:
    """A mesh file as a body in metres: `scale` times its numbers, turned by roll, pitch, yaw (rad), at rest.

    Raises MeshError that says what is wrong with a file that is no mesh of a body.
    """
    if not path.is_file():
        raise MeshError(f"there is no file {path}")
    stat = path.stat()
    return _prepared(path, scale, turn, concavity, (stat.st_mtime_ns, stat.st_size))


@functools.lru_cache(maxsize=256)
def _prepared(
    path: Path, scale: float, turn: Turn, concavity: float | None, version: tuple[int, int]
) -> Mesh:
    content = path.read_bytes()
    finer = "" if concavity is None else f" {concavity!r}"
    said = f"{FORMAT} {path.suffix.lower()} {scale!r} {turn!r} {MARGIN!r}{finer}\n"
    key = hashlib.sha256(said.encode() + content).hexdigest()
    found = mesh_cache.kept(key, lambda: _made_or_said(path, scale, turn, concavity))
    counts = np.cumsum(found["counts"])[:-1]
    return Mesh(
        key,
        tuple(np.split(found["pieces"], counts)),
        found["hull"],
        Surface(found["vertices"], found["faces"]),
        float(found["error"]),
    )


def _made_or_said(path: Path, scale: float, turn: Turn, concavity: float | None) -> mesh_cache.Arrays:
    """The same as `_made`; where geometry fails in some library, a sentence."""
    try:
        return _made(path, scale, turn, concavity)
    except (MeshError, UsageError):
        raise
    except Exception as error:  # Qhull, scipy, trimesh and CoACD have each their own
        raise MeshError(f"{path.name} cannot be made a body: {_first_line(error)}") from error


def _first_line(error: Exception) -> str:
    return next(iter(str(error).strip().splitlines()), type(error).__name__)


def _made(path: Path, scale: float, turn: Turn, concavity: float | None) -> mesh_cache.Arrays:
    """Everything that is known of a mesh, as arrays."""
    from proc3s_tabletop.meshes.accuracy import distance
    from proc3s_tabletop.meshes.pieces import closed, pieces_of
    from proc3s_tabletop.meshes.rest_pose import rest

    mesh = _read(path, scale, turn)
    pieces = pieces_of(mesh, concavity)
    middle = mesh.center_mass if closed(mesh) else _middle(pieces)
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

    from proc3s_tabletop.objects.extents import FLAT, rotation, thickness

    try:
        mesh = trimesh.load_mesh(path)
    except ImportError as error:
        text = f"{path.name} is of a format that needs another package ({_first_line(error)})"
        raise MeshError(f"{text}; take STL, OBJ, PLY or GLB") from error
    except Exception as error:  # every reader of trimesh has its own way to fail
        raise MeshError(f"{path.name} cannot be read as a mesh: {_first_line(error)}") from error
    if not len(getattr(mesh, "faces", ())) or not np.isfinite(mesh.vertices).all():
        raise MeshError(f"{path.name} holds no triangles")
    mesh = _without_slivers(mesh)
    mesh.apply_scale(scale)
    size = np.ptp(mesh.vertices, axis=0)
    if size.min() < SMALLEST or size.max() > LARGEST:
        raise MeshError(
            f"{path.name} is {' x '.join(plain(edge, 4) for edge in size.tolist())} m: is its scale right?"
        )
    if thickness(mesh.vertices) < FLAT:
        raise MeshError(f"{path.name} is flat")
    matrix = np.eye(4)
    matrix[:3, :3] = rotation(*turn)
    mesh.apply_transform(matrix)
    return mesh


def _without_slivers(mesh: Any) -> Any:
    from trimesh.util import concatenate

    # A repair would need another package; what is taken apart may have holes.
    parts = mesh.split(only_watertight=False, repair=False)
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
