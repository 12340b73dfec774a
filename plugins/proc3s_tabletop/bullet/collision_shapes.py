"""Shapes as PyBullet takes them: one collision shape for every kind of body."""

from collections.abc import Sequence
from pathlib import Path

from proc3s import FloatArray
from proc3s_tabletop.bullet.client import Client


def compound(pieces: Sequence[FloatArray], client: Client, path: Path) -> int:
    """The PyBullet id of the hulls of corners (n, 3); `path` is where the file goes that it reads from."""
    path.write_text(_obj(pieces), encoding="ascii")
    return int(client.createCollisionShape(client.GEOM_MESH, fileName=str(path)))


def _obj(pieces: Sequence[FloatArray]) -> str:
    """Pieces as an OBJ file; PyBullet takes the hull of a group's corners, so any faces over them do."""
    lines, first = [], 1
    for corners in pieces:
        lines.append("o piece")
        lines += [f"v {x:.7f} {y:.7f} {z:.7f}" for x, y, z in corners]
        lines += [f"f {first} {first + k} {first + k + 1}" for k in range(1, len(corners) - 1)]
        first += len(corners)
    return "\n".join(lines) + "\n"
