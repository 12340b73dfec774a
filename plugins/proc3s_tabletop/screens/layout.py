"""Where things lie in every plan of a batch, as far as that is certain without a simulation."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from proc3s import FloatArray
from proc3s_tabletop.catalogue.body_specs import body_of
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.objects.extents import rotation
from proc3s_tabletop.objects.shapes import Bowl, Box, Shape
from proc3s_tabletop.robot.grasp_frames import top_down
from proc3s_tabletop.robot.hand_profile import GAPS, WIDEST
from proc3s_tabletop.robot.widths import too_wide

Bools: TypeAlias = NDArray[np.bool_]
Rows: TypeAlias = NDArray[np.intp]
"""Numbers of plans in a batch."""

OPEN_HAND = (0.01, max(GAPS) / 2, 0.01)
"""What is further from the grasp point along x, y and z is not between the pads, m."""
UPRIGHT = 1e-3
"""A body that leans less stands upright, rad."""


@dataclass(frozen=True)
class Solids:
    """The n bodies of a scene as boxes along the axes of the world, metres.

    `outer` (n, 3) is half of the box around a body. `inner` (n, 3) is half of a box within it, negative
    where none is known. `flat` (n,) tells which have flat sides and stand upright, `bowls` which are bowls
    that do.
    """

    names: tuple[str, ...]
    centres: FloatArray
    outer: FloatArray
    inner: FloatArray
    flat: Bools
    bowls: Mapping[int, Bowl]
    shapes: tuple[Shape, ...]
    turns: FloatArray
    """Their rotations (n, 3, 3)."""

    def too_wide(self, k: int, centres: FloatArray, at: FloatArray) -> Bools:
        """Whether body k, its middle at `centres` (rows, 3), is too wide for the hand at `at` (rows, 3)."""
        away = at - centres
        wide: Bools = (np.abs(away) < self.outer[k] + OPEN_HAND).all(axis=1) & (2 * self.outer[k, 1] > WIDEST)
        grasps = np.repeat(top_down(0.0, 0.0, 0.0)[None], np.count_nonzero(wide), axis=0)
        grasps[:, :3, :3] = self.turns[k].T @ grasps[:, :3, :3]
        grasps[:, :3, 3] = away[wide] @ self.turns[k]
        wide[wide] = too_wide(self.shapes[k], grasps)
        return wide


def solids(objects: Mapping[str, Any], bodies: Mapping[str, Body]) -> Solids:
    """The bodies of the objects of a state, by their categories. Raises SpecError for one without a body."""
    poses = [thing.pose for thing in objects.values()]
    shapes = [body_of(bodies, name, thing.category).shape for name, thing in objects.items()]
    turns = [rotation(pose.roll, pose.pitch, pose.yaw) for pose in poses]
    turned = list(zip(shapes, turns, strict=True))
    inner = np.array([_inner(shape, turn) for shape, turn in turned]).reshape(-1, 3)
    return Solids(
        names=tuple(objects),
        centres=np.array([[pose.x, pose.y, pose.z] for pose in poses], float).reshape(-1, 3),
        outer=np.array([np.abs(s.corners() @ turn.T).max(axis=0) for s, turn in turned]).reshape(-1, 3),
        inner=inner,
        flat=inner[:, 0] > 0,
        shapes=tuple(shapes),
        turns=np.array(turns).reshape(-1, 3, 3),
        bowls={k: s for k, (s, turn) in enumerate(turned) if isinstance(s, Bowl) and _stands(turn)},
    )


def _inner(shape: Shape, turn: FloatArray) -> FloatArray:
    """Half the edges of a box along the axes within a turned body; -1 where none is known."""
    if not isinstance(shape, Box) or not _stands(turn):
        return np.full(3, -1.0)
    a, b, c = np.array(shape.size) / 2
    cosine, sine = abs(turn[0, 0]), abs(turn[1, 0])
    x, y = (a, b) if cosine >= sine else (b, a)
    share = min(1.0, a / (cosine * x + sine * y), b / (sine * x + cosine * y))
    return np.array([x * share, y * share, c])


def _stands(turn: FloatArray) -> bool:
    return math.acos(min(1.0, turn[2, 2])) < UPRIGHT


class Layout:
    """What the plans of a batch have done up to now: where every body is, and what the hand holds.

    `centres` (plans, n, 3) in m, and `slack` (plans, n): how far off they may be, infinite where only a
    simulation can tell. `held` (plans,) is the number of a body or -1, `offset` (plans, 3) its middle as seen
    from the grasp point.
    """

    def __init__(self, bodies: Solids, plans: int) -> None:
        self.bodies = bodies
        self.centres = np.repeat(bodies.centres[None], plans, axis=0)
        self.slack = np.zeros((plans, len(bodies.names)))
        self.held = np.full(plans, -1)
        self.offset = np.zeros((plans, 3))

    def met(self, rows: Rows, at: FloatArray, columns: FloatArray, rise: float) -> FloatArray:
        """How deep columns of the hand (k, 4) that come down to points `at` (rows, 3) reach into bodies, m.

        Shape (rows, n): at least so much for certain, negative where it is not. The hand comes from `rise`
        above; what it holds is not met.
        """
        away = self.centres[rows] - at[:, None]
        depth = np.full(away.shape[:2], -np.inf)
        span = np.array([columns[:, 2].max(), columns[:, 1].max()])
        near = (np.abs(away[..., :2]) < self.bodies.inner[:, :2] + span).all(axis=2)
        row, which = np.nonzero(near & (self.bodies.inner[:, 0] > 0))
        depth[row, which] = _deepest(away[row, which], self.bodies.inner[which], columns, rise)
        for k, bowl in self.bodies.bowls.items():
            depth[:, k] = _into_bowl(away[:, k], bowl, columns)
        depth -= self.slack[rows]
        holding = np.flatnonzero(self.held[rows] >= 0)
        depth[holding, self.held[rows[holding]]] = -np.inf
        return depth

    def beside(self, rows: Rows, which: Rows, at: FloatArray, half: FloatArray) -> FloatArray:
        """How far bodies overlap with the bodies `which`, put at `at` (rows, 3), as seen from above, m.

        Shape (rows, n), the lesser of both axes; `half` (n, 3) of all bodies: inner for what is certain,
        outer for what is possible. Bodies do not overlap with themselves.
        """
        away = np.abs(self.centres[rows, :, :2] - at[:, None, :2])
        depth: FloatArray = (half[None, :, :2] + half[which, None, :2] - away).min(axis=2)
        depth[(half[:, 0] < 0)[None] | (half[which, 0] < 0)[:, None]] = -np.inf
        depth[np.arange(len(rows)), which] = -np.inf
        return depth

    def tops(self, rows: Rows, which: Rows, at: FloatArray, spare: FloatArray) -> FloatArray:
        """How high every body may reach below bodies `which` put at `at` (rows, 3): its z, shape (rows, n).

        `spare` (rows, n) is how far off they may be, m.
        """
        tops: FloatArray = self.centres[rows, :, 2] + self.bodies.outer[:, 2]
        for k, bowl in self.bodies.bowls.items():
            away = np.abs(self.centres[rows, k, :2] - at[:, :2]) + self.bodies.outer[which, :2]
            furthest = np.linalg.norm(away + spare[:, k, None], axis=1)
            tops[:, k] += bowl.height_at(furthest) - bowl.height
        return tops


def _into_bowl(away: FloatArray, bowl: Bowl, columns: FloatArray) -> FloatArray:
    """How deep the deepest of columns (k, 4) reaches into bowls whose middles are `away` (rows, 3)."""
    nearest, furthest = _from_axis(away, columns)
    # What comes down between the foot and the rim meets the wall where it is furthest from the axis.
    wall = bowl.height_at(np.minimum(furthest, bowl.rim_radius)) - bowl.height / 2 + away[:, 2, None]
    below_wall, within_rim = wall - columns[:, 3], bowl.rim_radius - nearest
    deepest: FloatArray = np.minimum(below_wall, within_rim).max(axis=1)
    return deepest


def _from_axis(away: FloatArray, columns: FloatArray) -> tuple[FloatArray, FloatArray]:
    """How far columns (k, 4) are, seen from above, from the axis of a bowl that is `away` (rows, 3): where
    they are nearest, and where they are furthest, each (rows, k), m."""
    start, stop, width, _ = columns.T
    x, y = np.abs(away[:, 0, None]), away[:, 1, None]
    nearest = np.hypot(np.maximum(x - width, 0), np.maximum(np.maximum(start - y, y - stop), 0))
    furthest = np.hypot(x + width, np.maximum(y - start, stop - y))
    return nearest, furthest


def _deepest(away: FloatArray, half: FloatArray, columns: FloatArray, rise: float) -> FloatArray:
    """Overlap of the deepest of columns (k, 4) with boxes (m, 3) whose middles are `away` (m, 3), (m,)."""
    start, stop, width, bottom = columns.T
    x, y, z = (away[:, k, None] for k in range(3))
    hx, hy, hz = (half[:, k, None] for k in range(3))
    across = width + hx - np.abs(x)
    along = np.minimum(stop - y, y - start) + hy
    depth = np.minimum(np.minimum(across, along), z + hz - bottom)
    depth[z - hz > bottom + rise] = -np.inf
    deepest: FloatArray = depth.max(axis=1)
    return deepest
