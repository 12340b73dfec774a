"""The bodies that lie on the table: shapes, masses, friction, and which category has which."""

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.client import Client

MARGIN = 0.001
"""PyBullet surrounds the corners of a mesh with this much, m (measured)."""


class Shape(Protocol):
    """Something that can be made a collision shape; its origin is the middle of its extent."""

    def corners(self) -> FloatArray:
        """Points (n, 3) on its outside, metres, whose hull is its extent."""

    def collision(self, client: Client, folder: Path) -> int:
        """The PyBullet id of the shape; files that PyBullet reads from go to `folder`."""


@dataclass(frozen=True)
class Box:
    """A box with edges along x, y, z in metres."""

    size: tuple[float, float, float]

    def corners(self) -> FloatArray:
        """The eight corners."""
        return _box(self.size)

    def collision(self, client: Client, folder: Path) -> int:
        """One primitive."""
        half = [edge / 2 for edge in self.size]
        return int(client.createCollisionShape(client.GEOM_BOX, halfExtents=half))


@dataclass(frozen=True)
class Cylinder:
    """An upright cylinder, metres."""

    radius: float
    height: float

    def corners(self) -> FloatArray:
        """Points on both rims."""
        return _rings([(self.radius, -self.height / 2), (self.radius, self.height / 2)])

    def collision(self, client: Client, folder: Path) -> int:
        """One primitive."""
        kind = client.GEOM_CYLINDER
        return int(client.createCollisionShape(kind, radius=self.radius, height=self.height))


@dataclass(frozen=True)
class Bowl:
    """A round bowl with a flat floor and a wall that leans outwards, metres.

    The default stands on the table as a cereal bowl does and keeps a block that is dropped into it.
    """

    rim_radius: float = 0.080
    foot_radius: float = 0.045
    height: float = 0.050
    wall: float = 0.004
    wedges: int = 16

    def corners(self) -> FloatArray:
        """Points on the foot and on the rim."""
        return _rings([(self.foot_radius, -self.height / 2), (self.rim_radius, self.height / 2)])

    def collision(self, client: Client, folder: Path) -> int:
        """Convex pieces: a disc and the wedges of the wall."""
        path = folder / "bowl.obj"
        path.write_text(_obj(self.pieces()), encoding="ascii")
        return int(client.createCollisionShape(client.GEOM_MESH, fileName=str(path)))

    def pieces(self) -> list[FloatArray]:
        """The corners of every convex piece, each of shape (corners, 3)."""
        turns = np.linspace(0, 2 * math.pi, self.wedges + 1)
        wall = [np.vstack([self._rib(a), self._rib(b)]) for a, b in itertools.pairwise(turns)]
        low, high = MARGIN - self.height / 2, self.wall - MARGIN - self.height / 2
        floor = [_around(turn, self.foot_radius, z) for turn in turns[:-1] for z in (low, high)]
        return [*wall, np.array(floor)]

    def height_at(self, radius: FloatArray) -> FloatArray:
        """How high above its foot the bowl reaches at distances from its axis, metres."""
        share = (radius - self.foot_radius) / (self.rim_radius - self.foot_radius)
        height: FloatArray = np.maximum(np.clip(share, 0.0, 1.0) * self.height, self.wall)
        return height

    def _rib(self, turn: float) -> FloatArray:
        """The wall cut at an angle: outside and inside, at the foot and at the rim."""
        # The wall hangs a little above the table: only the floor is to stand on it.
        low, high = self.wall / 2 - self.height / 2, self.height / 2 - MARGIN
        corners = [(self.foot_radius, low), (self.rim_radius, high)]
        return np.array([_around(turn, r - inward, z) for inward in (0.0, self.wall) for r, z in corners])


@dataclass(frozen=True)
class Mesh:
    """Convex pieces in a Wavefront OBJ file, one `o` group each, metres; `size` is its extent."""

    path: str
    size: tuple[float, float, float]

    def corners(self) -> FloatArray:
        """The corners of the box around it."""
        return _box(self.size)

    def collision(self, client: Client, folder: Path) -> int:
        """One hull a group."""
        return int(client.createCollisionShape(client.GEOM_MESH, fileName=self.path))


@dataclass(frozen=True)
class Body:
    """A shape with a mass in kg and coefficients of friction."""

    shape: Shape
    mass: float
    friction: float = 0.6
    rolling_friction: float = 0.0
    spinning_friction: float = 0.0

    @property
    def half_height(self) -> float:
        """Of the upright body, metres: the z of its middle where it stands on the table."""
        return float(np.ptp(self.shape.corners()[:, 2])) / 2

    def create(self, client: Client, folder: Path, parked: tuple[float, float, float]) -> int:
        """Put the body into a client, far away; returns its PyBullet id."""
        shape = self.shape.collision(client, folder)
        body = int(client.createMultiBody(self.mass, shape, -1, parked))
        client.changeDynamics(
            body,
            -1,
            lateralFriction=self.friction,
            rollingFriction=self.rolling_friction,
            spinningFriction=self.spinning_friction,
        )
        return body


BLOCK_SIZE = 0.04
"""Edge of a block, m (the paper)."""

CATEGORIES: Mapping[str, Body] = {
    # 60 g: a cube of light wood of this size. 300 g: a small bowl of china.
    "block": Body(Box((BLOCK_SIZE, BLOCK_SIZE, BLOCK_SIZE)), mass=0.06),
    "bowl": Body(Bowl(), mass=0.3),
}
"""The body of every category of object, where a domain does not bring its own."""


def _box(size: tuple[float, float, float]) -> FloatArray:
    return np.array(list(itertools.product(*((-edge / 2, edge / 2) for edge in size))))


def _rings(profile: list[tuple[float, float]], points: int = 32) -> FloatArray:
    """Circles of the given radii and heights."""
    turns = np.linspace(0, 2 * math.pi, points, endpoint=False)
    return np.array([_around(turn, radius, z) for radius, z in profile for turn in turns])


def _around(turn: float, radius: float, z: float) -> tuple[float, float, float]:
    return radius * math.cos(turn), radius * math.sin(turn), z


def _obj(pieces: list[FloatArray]) -> str:
    """Pieces as an OBJ file; PyBullet takes the hull of a group's corners, so any faces over them do."""
    lines, first = [], 1
    for corners in pieces:
        lines.append("o piece")
        lines += [f"v {x:.7f} {y:.7f} {z:.7f}" for x, y, z in corners]
        lines += [f"f {first} {first + k} {first + k + 1}" for k in range(1, len(corners) - 1)]
        first += len(corners)
    return "\n".join(lines) + "\n"
