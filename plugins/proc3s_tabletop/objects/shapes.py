"""The bodies that lie on the table: shapes, masses, friction, and which category has which."""

import itertools
import math
from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from proc3s import FloatArray

MARGIN = 0.001
"""PyBullet surrounds the corners of a mesh with this much, m (measured)."""


class Shape(Hashable, Protocol):
    """Something that lies on the table; its origin is its centre of mass.

    Upright, that is without roll and pitch, it stands on the table.
    """

    def corners(self) -> FloatArray:
        """Points (n, 3) on its outside, metres, whose hull is its extent."""

    def parts(self) -> Sequence[FloatArray]:
        """The corners (n, 3) of convex parts that make it up, metres."""


@dataclass(frozen=True)
class Box:
    """A box with edges along x, y, z in metres."""

    size: tuple[float, float, float]

    def corners(self) -> FloatArray:
        """The eight corners."""
        return _box(self.size)

    def parts(self) -> Sequence[FloatArray]:
        """The box."""
        return [self.corners()]


@dataclass(frozen=True)
class Cylinder:
    """An upright cylinder, metres."""

    radius: float
    height: float

    def corners(self) -> FloatArray:
        """Points on both rims."""
        return _rings([(self.radius, -self.height / 2), (self.radius, self.height / 2)])

    def parts(self) -> Sequence[FloatArray]:
        """The cylinder, as a prism."""
        return [self.corners()]


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

    def parts(self) -> list[FloatArray]:
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


class Surface(NamedTuple):
    """Triangles: corners (n, 3) in m, and the numbers (m, 3) of the corners of each."""

    vertices: FloatArray
    faces: NDArray[np.intp]


@dataclass(frozen=True)
class Mesh:
    """Convex pieces of a mesh in the frame in which it lies at rest, its centre of mass at 0, m.

    `meshes.prepare` makes them. PyBullet surrounds the corners (n, 3) of each of the `pieces` with MARGIN;
    that is the surface. `key` names what it was made of and how: meshes with the same key are equal.
    """

    key: str
    pieces: tuple[FloatArray, ...] = field(compare=False, repr=False)
    hull: FloatArray = field(compare=False, repr=False)
    """Corners (n, 3) of the hull of all pieces with their margin."""
    surface: Surface = field(compare=False, repr=False)
    """The mesh itself, to be looked at."""
    error: float = field(compare=False)
    """Distance of the surfaces of mesh and pieces, m: 95 of 100 points of either are nearer to the other."""

    def corners(self) -> FloatArray:
        """The corners of the hull of all pieces."""
        return self.hull

    def parts(self) -> Sequence[FloatArray]:
        """The pieces, without their margin."""
        return self.pieces


def _box(size: tuple[float, float, float]) -> FloatArray:
    return np.array(list(itertools.product(*((-edge / 2, edge / 2) for edge in size))))


def _rings(profile: list[tuple[float, float]], points: int = 32) -> FloatArray:
    """Circles of the given radii and heights."""
    turns = np.linspace(0, 2 * math.pi, points, endpoint=False)
    return np.array([_around(turn, radius, z) for radius, z in profile for turn in turns])


def _around(turn: float, radius: float, z: float) -> tuple[float, float, float]:
    return radius * math.cos(turn), radius * math.sin(turn), z
