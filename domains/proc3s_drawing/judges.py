"""Judges of the Drawing domain: does the picture show what was asked for?

They see a drawing as a person does: gaps and overshoots under 1 % of its size do not count, nor do the
order, direction, repetition and splitting of its lines.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from proc3s.state import FloatArray, Plan
from proc3s.world import Score
from proc3s_drawing.geometry import (
    StrokeGraph,
    angle_between,
    corners,
    inside,
    outlines,
    ray_to_circle,
    segment_distance,
    simplify,
    stroke_graph,
    turns,
)


def is_star(state: Any, plan: Plan) -> Score:
    """A closed star of at least 5 points, drawn as crossing strokes or as an outline."""
    return _verdict(state, _star)


def is_arrow(state: Any, plan: Plan) -> Score:
    """A shaft with a head of two or three strokes whose ray meets the biggest obstacle before any other."""
    return _verdict(state, lambda graph: _aim(_arrow(graph), state.obstacles))


def is_letter_m(state: Any, plan: Plan) -> Score:
    """Four strokes end to end that a person reads as a capital M, tilted by 20 degrees at most."""
    return _verdict(state, _letter_m)


def encloses(state: Any, plan: Plan, count: int = 2) -> Score:
    """One closed curve that does not cross itself, with at least `count` whole obstacles inside."""
    return _verdict(state, lambda graph: _enclosure(graph, state.obstacles, count))


class _Refusal(Exception):
    """Why the drawing is not what it should be."""


def _require(holds: bool, reason: str) -> None:
    if not holds:
        raise _Refusal(reason)


def _within(what: str, value: float, low: float, high: float) -> None:
    _require(low <= value <= high, f"{what}: {value:.2f}, it should be {low:g} to {high:g}")


def _verdict(state: Any, read: Callable[[StrokeGraph], str]) -> Score:
    lines = [(line.p1_x, line.p1_y, line.p2_x, line.p2_y) for line in state.drawn_lines]
    graph = stroke_graph(np.array(lines, dtype=np.float64).reshape(-1, 4))
    try:
        _require(bool(graph.edges), "nothing is drawn, or only dots")
        return Score(True, read(graph))
    except _Refusal as refusal:
        return Score(False, str(refusal))


def _at(point: FloatArray) -> str:
    return f"({point[0]:.1f}, {point[1]:.1f})"


# Star


def _star(graph: StrokeGraph) -> str:
    _require_closed(graph)
    curves = outlines(graph)
    _require(len(curves) == 1, f"{len(curves)} separate closed shapes, a star is one")
    ring = corners(curves[0], graph.tolerance)
    turn = turns(ring)
    tips, inner = ring[turn > 0], int((turn < 0).sum())
    _require(inner > 0, f"a closed convex polygon with {len(tips)} corners, no star: it has no inner corners")
    _require(
        bool(np.all(turn * np.roll(turn, 1) < 0)),
        f"a closed outline with {len(tips)} points and {inner} inner corners, no star: a star has exactly "
        "one inner corner between one point and the next",
    )
    _require(len(tips) >= 5, f"a closed star with {len(tips)} points only, it needs at least 5")
    middle = tips.mean(axis=0)
    rays, tip_rays = ring - middle, tips - middle
    around = bool(np.all(angle_between(rays, np.roll(rays, -1, axis=0)) > 0))
    _require(
        around, f"a closed zigzag, no star: its outline does not run once around its middle {_at(middle)}"
    )
    reach = np.linalg.norm(tip_rays, axis=1)
    _within("the shortest point of the star as a share of the longest", reach.min() / reach.max(), 0.35, 1)
    spread = angle_between(tip_rays, np.roll(tip_rays, -1, axis=0)).max()
    _within("the widest angle between two points of the star", spread, 0, 2.2 * 360 / len(tips))
    return f"a closed star with {len(tips)} points"


def _require_closed(graph: StrokeGraph) -> None:
    loose = graph.of_degree(1, 1)
    if len(loose) == 1:
        raise _Refusal(f"not closed: a stroke ends loose at {_at(graph.nodes[loose[0]])}")
    if loose:
        a, b = min(combinations(loose, 2), key=graph.length)
        ends = f"{_at(graph.nodes[a])} and {_at(graph.nodes[b])}"
        raise _Refusal(f"the outline is not closed: {graph.length((a, b)):.1f} units between {ends}")


# Arrow


@dataclass(frozen=True)
class _Arrow:
    """A shaft from `tail` to `tip` and the two ends of the head's strokes, which a third may join."""

    tail: FloatArray
    tip: FloatArray
    barbs: tuple[FloatArray, FloatArray]

    @property
    def length(self) -> float:
        return float(np.linalg.norm(self.tip - self.tail))

    @property
    def leans(self) -> FloatArray:
        """Degrees from the shaft back to each barb; of opposite signs if they are on opposite sides."""
        return angle_between(self.tail - self.tip, np.stack(self.barbs) - self.tip)


def _arrow(graph: StrokeGraph) -> _Arrow:
    curves = outlines(graph)
    _require(len(curves) <= 1, f"{len(curves)} separate closed shapes, an arrow has one head")
    arrow = _closed_head(graph, curves[0]) if curves else _open_head(graph)
    _require_head(arrow)
    sides = [(arrow.tail, arrow.tip), *((arrow.tip, barb) for barb in arrow.barbs), arrow.barbs]
    points = np.stack([graph.nodes[[*edge]].mean(axis=0) for edge in sorted(graph.edges)])
    off = np.min([segment_distance(points, a, b) for a, b in sides], axis=0)
    stray = (
        f"the stroke at {_at(points[off.argmax()])} belongs neither to the shaft nor to the head of an arrow"
    )
    _require(off.max() <= 2 * graph.tolerance, stray)
    return arrow


def _open_head(graph: StrokeGraph) -> _Arrow:
    """The shaft is the stroke between the other two."""
    loose, forks = graph.of_degree(1, 1), graph.of_degree(3)
    _require(
        bool(forks), "no head: two strokes must lead back from the tip of the shaft, here nothing branches"
    )
    _require(
        len(forks) == 1 and len(loose) == 3 and len(graph.chains) == 3,
        "an arrow is a shaft and two strokes that meet at its tip, or a triangle on a shaft: here are "
        f"{len(loose)} loose ends and {len(forks)} points where strokes branch or cross, not 3 and 1",
    )
    tip = graph.nodes[forks[0]]
    ends = [_far_end(graph, chain, forks[0]) for chain in graph.chains]
    readings = [_Arrow(ends[i], tip, (ends[i - 1], ends[i - 2])) for i in range(3)]
    longest = max(reading.length for reading in readings)
    shafts = [reading for reading in readings if reading.length >= 0.9 * longest]
    return min(shafts, key=lambda reading: float(np.abs(reading.leans).max()))


def _closed_head(graph: StrokeGraph, curve: FloatArray) -> _Arrow:
    """A triangle; the shaft reaches it in the side opposite to the tip."""
    head = corners(curve, graph.tolerance)
    _require(len(head) == 3, f"the closed head has {len(head)} corners, a triangle has 3")
    tails = [end for end in graph.of_degree(1, 1) if not inside(graph.nodes[end], curve)]
    _require(len(tails) == 1, f"{len(tails)} loose ends outside the triangle: its shaft has one")
    chain = next(chain for chain in graph.chains if tails[0] in (chain[0], chain[-1]))
    joint = chain[0] if chain[-1] == tails[0] else chain[-1]
    tail, meets = _far_end(graph, chain, joint), graph.nodes[joint]
    _require(
        bool(np.linalg.norm(head - meets, axis=1).min() > 2 * graph.tolerance),
        f"the shaft meets the triangle at its corner {_at(meets)}: it must meet the middle of a side, "
        "and the corner opposite to that side is the tip",
    )
    i = int(np.argmin([segment_distance(meets, head[i - 1], head[i - 2]) for i in range(3)]))
    return _Arrow(tail, head[i], (head[i - 1], head[i - 2]))


def _far_end(graph: StrokeGraph, chain: list[int], start: int) -> FloatArray:
    """Where a straight stroke ends that starts at a node."""
    path = simplify(graph.nodes[chain], graph.tolerance)
    _require(len(path) == 2, f"shaft and head are straight strokes, but one bends at {_at(path[1])}")
    return path[-1] if chain[0] == start else path[0]


def _require_head(arrow: _Arrow) -> None:
    narrow, wide = sorted(np.abs(arrow.leans).tolist())
    _require(
        wide <= 75,
        "the strokes of the head must lead back along the shaft, at most 75 degrees from it: "
        f"they lead off at {narrow:.0f} and {wide:.0f} degrees",
    )
    _require(
        arrow.leans[0] * arrow.leans[1] < 0, "both strokes of the head are on the same side of the shaft"
    )
    _within("degrees from the shaft to the nearer stroke of its head", narrow, 8, 75)
    _within("a lopsided head: the difference of its two angles in degrees", wide - narrow, 0, 25)
    short, long = sorted(float(np.linalg.norm(barb - arrow.tip)) for barb in arrow.barbs)
    _within("a lopsided head: its shorter stroke as a share of the longer", short / long, 0.5, 1)
    covered = max(long * np.cos(np.radians(narrow)) / 0.8, long / 1.1) / arrow.length
    _within("the shaft is too short for its head: share of the longest head it can bear", covered, 0, 1)


def _aim(arrow: _Arrow, obstacles: Sequence[Any]) -> str:
    _require(bool(obstacles), "there is no obstacle to point at")
    way = [_distance_ahead(arrow, obstacle) for obstacle in obstacles]
    # Of several that are biggest, the one that the arrow meets first.
    target = min(range(len(way)), key=lambda i: (-obstacles[i].radius, way[i]))
    first, biggest = obstacles[int(np.argmin(way))], obstacles[target]
    off = float(angle_between(arrow.tip - arrow.tail, _centre(biggest) - arrow.tip))
    _require(
        way[target] < np.inf,
        f"the arrow does not point at the biggest obstacle {biggest.name}: its centre lies {abs(off):.0f} degrees "
        f"to the {'left' if off > 0 else 'right'}, seen from the tip {_at(arrow.tip)}",
    )
    _require(
        first.radius == biggest.radius,
        f"the arrow meets {first.name} (radius {first.radius:.1f}) before the biggest obstacle {biggest.name} "
        f"(radius {biggest.radius:.1f})",
    )
    return f"an arrow that points at the biggest obstacle {biggest.name}"


def _centre(obstacle: Any) -> FloatArray:
    return np.array([obstacle.x_pos, obstacle.y_pos], dtype=np.float64)


def _distance_ahead(arrow: _Arrow, obstacle: Any) -> float:
    return ray_to_circle(arrow.tip, arrow.tip - arrow.tail, _centre(obstacle), obstacle.radius)


# Letter M


def _letter_m(graph: StrokeGraph) -> str:
    points = _four_strokes(graph)
    up = _upright(points)
    tilt = float(angle_between(np.array([0.0, 1.0]), up))
    _require(
        abs(tilt) < 100, f"upside down, more like a W: its legs hang {abs(tilt):.0f} degrees from upright"
    )
    _require(abs(tilt) <= 24, f"tilted by {abs(tilt):.0f} degrees, more than 20")
    _require_proportions(points @ np.array([[up[1], up[0]], [-up[0], up[1]]]))
    return f"a letter M, {abs(tilt):.0f} degrees from upright"


def _four_strokes(graph: StrokeGraph) -> FloatArray:
    """Foot, top, middle, top, foot: shape (5, 2), from either side."""
    forks, rule = graph.of_degree(3), "the four strokes of an M join end to end, from foot to foot"
    _require(not forks, f"{rule}: here strokes branch or cross at {_at(graph.nodes[forks].mean(axis=0))}")
    lines = len(graph.chains)
    _require(
        lines == 1, f"{rule}: here are {lines} separate lines" if lines else f"{rule}: here they close a loop"
    )
    _require({*graph.chains[0]} == {*graph.neighbours}, f"{rule}: here is a closed loop besides")
    points = simplify(graph.nodes[graph.chains[0]], graph.tolerance)
    _require(len(points) == 5, f"{rule}: this line has {len(points) - 1} straight strokes")
    return points


def _upright(points: FloatArray) -> FloatArray:
    """The unit vector that is up for the letter: halfway between its legs and the normal of its lines."""
    foot, top, _, other_top, other_foot = points
    legs = _unit(top - foot) + _unit(other_top - other_foot)
    _require(
        bool(np.linalg.norm(legs) > 1), "the first and the last stroke must be legs that stand side by side"
    )
    across = _unit(other_top - top) + _unit(other_foot - foot)
    normal = np.array([-across[1], across[0]])
    return _unit(_unit(legs) + _unit(normal if normal @ legs > 0 else -normal))


def _unit(vector: FloatArray) -> FloatArray:
    return vector / max(float(np.linalg.norm(vector)), 1e-12)


def _require_proportions(points: FloatArray) -> None:
    """Of an M that stands upright in its own frame, x to the right, y up."""
    foot, top, middle, other_top, other_foot = points if points[1, 0] < points[3, 0] else points[::-1]
    for leg in (top - foot, other_top - other_foot):
        _within(
            "a zigzag: degrees by which a leg slants", float(np.degrees(np.arctan2(leg[0], leg[1]))), -20, 20
        )
    short, long = sorted([top[1] - foot[1], other_top[1] - other_foot[1]])
    height, wide, base = (short + long) / 2, other_top[0] - top[0], other_foot[0] - foot[0]
    level = max(abs(top[1] - other_top[1]), abs(foot[1] - other_foot[1]))
    _within("the shorter leg of the M as a share of the longer", short / long, 0.7, 1)
    _within("how much higher one leg of the M stands, as a share of its height", level / height, 0, 0.25)
    _within("the width of the M as a share of its height", (wide + base) / 2 / height, 0.35, 2)
    _within("the distance of the feet of the M as a share of that of the tops", base / wide, 0.7, 2.5)
    depth = (top[1] + other_top[1]) / 2 - middle[1]
    _within("how far the middle of the M reaches down, as a share of its height", depth / height, 0.3, 1.1)
    _within("how far the middle of the M stands from leg to leg", (middle[0] - top[0]) / wide, 0.25, 0.75)


# Enclosure


def _enclosure(graph: StrokeGraph, obstacles: Sequence[Any], count: int) -> str:
    curves = outlines(graph)
    if not curves:
        _require_closed(graph)
    found = [[_position(obstacle, curve) for obstacle in obstacles] for curve in curves]
    best = max(found, key=lambda positions: positions.count("inside"), default=[])
    names = [o.name for o, position in zip(obstacles, best, strict=False) if position == "inside"]
    cut = [o.name for o, position in zip(obstacles, best, strict=False) if position == "cut"]
    _require(
        len(names) >= count,
        f"the closed curve has {len(names)} of {count} obstacles wholly inside"
        + (f": {', '.join(names)}" if names else "")
        + (f"; it cuts {', '.join(cut)}" if cut else "")
        + (f"; there are {len(curves)} curves, and each is counted by itself" if len(curves) > 1 else ""),
    )
    return f"a closed curve encloses {', '.join(names)}"


def _position(obstacle: Any, curve: FloatArray) -> str:
    centre = _centre(obstacle)
    if segment_distance(centre, curve, np.roll(curve, -1, axis=0)).min() < obstacle.radius:
        return "cut"
    return "inside" if inside(centre, curve) else "outside"
