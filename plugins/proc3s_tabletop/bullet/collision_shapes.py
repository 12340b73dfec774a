"""Shapes as PyBullet takes them: one collision shape for every kind of body."""

import functools
import hashlib
from collections.abc import Sequence
from pathlib import Path

from proc3s import FloatArray
from proc3s_tabletop.bullet.client import Client
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.objects.shapes import Bowl, Box, Cylinder, Mesh, Shape


def create(body: Body, client: Client, folder: Path, parked: tuple[float, float, float]) -> int:
    """Put a body into a client, far away; returns its PyBullet id. Files that are read go to `folder`."""
    made = int(client.createMultiBody(body.mass, collision_shape(body.shape, client, folder), -1, parked))
    client.changeDynamics(
        made,
        -1,
        lateralFriction=body.friction,
        rollingFriction=body.rolling_friction,
        spinningFriction=body.spinning_friction,
    )
    return made


@functools.singledispatch
def collision_shape(shape: Shape, client: Client, folder: Path) -> int:
    """The PyBullet id of a shape; files that PyBullet reads from go to `folder`."""
    raise TypeError(f"no collision shape is known for a {type(shape).__name__}")


@collision_shape.register
def _(shape: Box, client: Client, folder: Path) -> int:
    half = [edge / 2 for edge in shape.size]
    return int(client.createCollisionShape(client.GEOM_BOX, halfExtents=half))


@collision_shape.register
def _(shape: Cylinder, client: Client, folder: Path) -> int:
    kind = client.GEOM_CYLINDER
    return int(client.createCollisionShape(kind, radius=shape.radius, height=shape.height))


@collision_shape.register
def _(shape: Bowl, client: Client, folder: Path) -> int:
    return compound(shape.parts(), client, folder)


@collision_shape.register
def _(shape: Mesh, client: Client, folder: Path) -> int:
    return compound(shape.pieces, client, folder)


def compound(pieces: Sequence[FloatArray], client: Client, folder: Path) -> int:
    """The PyBullet id of the hulls of corners (n, 3); the file that it is read from goes to `folder`."""
    return int(client.createCollisionShape(client.GEOM_MESH, fileName=str(written(_obj(pieces), folder))))


def written(text: str, folder: Path) -> Path:
    """A file for PyBullet, named by its content: whatever the file holds, a name is read only once."""
    path = folder / f"{hashlib.sha256(text.encode()).hexdigest()[:16]}.obj"
    path.write_text(text, encoding="ascii")
    return path


def _obj(pieces: Sequence[FloatArray]) -> str:
    """Pieces as an OBJ file; PyBullet takes the hull of a group's corners, so any faces over them do."""
    lines, first = [], 1
    for corners in pieces:
        lines.append("o piece")
        lines += [f"v {x:.7f} {y:.7f} {z:.7f}" for x, y, z in corners]
        lines += [f"f {first} {first + k} {first + k + 1}" for k in range(1, len(corners) - 1)]
        first += len(corners)
    return "\n".join(lines) + "\n"
