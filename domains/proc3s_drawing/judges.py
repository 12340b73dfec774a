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
    clearance,
    corners,
    inside,
    outlines,
    path_length,
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
    tips, inner = ring[turn > 0], ring[turn < 0]
    _require(
        len(inner) > 0,
        f"a closed convex polygon with {len(tips)} corners, no star: it has no inner corners",
    )
    _require(
        bool(np.all(turn * np.roll(turn, 1) < 0)),
        f"a closed outline with {len(tips)} points and {len(inner)} inner corners, no star: "
        "in a star there is exactly one inner corner between one point and the next",
    )
    _require(len(tips) >= 5, f"a closed star with {len(tips)} points only, it needs at least 5")
    _require_all_round(ring, tips)
    return f"a closed star with {len(tips)} points"


def _require_closed(graph: StrokeGraph) -> None:
    ends = graph.nodes[graph.of_degree(1, 1)]
    if len(ends) == 1:
        raise _Refusal(f"not closed: a stroke ends loose at {_at(ends[0])}")
    if len(ends):
        a, b = min(combinations(ends, 2), key=lambda pair: path_length(np.stack(pair)))
        raise _Refusal(
            f"the outline is not closed: {path_length(np.stack([a, b])):.1f} units between {_at(a)} and {_at(b)}"
        )


def _require_all_round(ring: FloatArray, tips: FloatArray) -> None:
    """Seen from its middle, a star runs round once, and its points reach about equally far in all directions."""
    middle = tips.mean(axis=0)
    _require(
        all(step > 0 for step in _steps(ring - middle)),
        f"a closed zigzag, no star: its points do not lie around its middle {_at(middle)}",
    )
    reach = np.linalg.norm(tips - middle, axis=1)
    _require(
        reach.min() > 0.35 * reach.max(),
        f"the points are too unequal for a star: the shortest reaches {reach.min():.1f} units from the "
        f"middle {_at(middle)}, the longest {reach.max():.1f}",
    )
    widest, fair = max(_steps(tips - middle)), 360 / len(tips)
    _require(
        widest < 2.2 * fair,
        f"the points are not spread around the star: {widest:.0f} degrees between two, {fair:.0f} would be even",
    )


def _steps(rays: FloatArray) -> list[float]:
    return [angle_between(a, b) for a, b in zip(rays, np.roll(rays, -1, axis=0), strict=True)]


# Arrow


@dataclass(frozen=True)
class _Arrow:
    """A shaft from `tail` to `tip` and the two ends of the head's strokes; `closed` if a stroke joins them."""

    tail: FloatArray
    tip: FloatArray
    barbs: tuple[FloatArray, FloatArray]
    closed: bool

    @property
    def strokes(self) -> list[tuple[FloatArray, FloatArray]]:
        sides = [(self.tip, barb) for barb in self.barbs]
        return [(self.tail, self.tip), *sides, *([self.barbs] if self.closed else [])]

    @property
    def leans(self) -> list[float]:
        """Degrees from the shaft back to each barb, positive on the left of the way back."""
        return [angle_between(self.tail - self.tip, barb - self.tip) for barb in self.barbs]


def _arrow(graph: StrokeGraph) -> _Arrow:
    curves = outlines(graph)
    _require(len(curves) <= 1, f"{len(curves)} separate closed shapes, an arrow has one head")
    arrow = _closed_head(graph, curves[0]) if curves else _open_head(graph)
    _require_head(arrow)
    _require_nothing_else(graph, arrow)
    return arrow


def _open_head(graph: StrokeGraph) -> _Arrow:
    """The shaft is the stroke between the other two."""
    loose, forks = graph.of_degree(1, 1), graph.of_degree(3)
    _require(
        bool(forks), "no head: two strokes must lead back from the tip of the shaft, here nothing branches"
    )
    _require(
        len(forks) == 1 and len(loose) == 3 and len(graph.chains) == 3,
        "an arrow is a shaft and two strokes that meet at its tip, or a triangle on a shaft: this drawing has "
        f"{len(loose)} loose ends and {len(forks)} points where strokes branch or cross, not 3 and 1",
    )
    tip = graph.nodes[forks[0]]
    ends = [_far_end(graph, chain, forks[0]) for chain in graph.chains]
    readings = [_Arrow(ends[i], tip, (ends[i - 1], ends[i - 2]), closed=False) for i in range(3)]
    long = max(np.linalg.norm(end - tip) for end in ends)
    shafts = [reading for reading in readings if np.linalg.norm(reading.tail - tip) >= 0.9 * long]
    return min(shafts, key=lambda reading: max(np.abs(reading.leans)))


def _closed_head(graph: StrokeGraph, curve: FloatArray) -> _Arrow:
    """A triangle; the shaft reaches it in the side opposite to the tip."""
    head = corners(curve, graph.tolerance)
    _require(len(head) == 3, f"the closed head has {len(head)} corners, a triangle has 3")
    tails = [end for end in graph.of_degree(1, 1) if not inside(graph.nodes[end], curve)]
    _require(len(tails) == 1, f"{len(tails)} loose ends outside the triangle: its shaft has one")
    chain = next(chain for chain in graph.chains if tails[0] in (chain[0], chain[-1]))
    joint = chain[0] if chain[-1] == tails[0] else chain[-1]
    tail, meets = _far_end(graph, chain, joint), graph.nodes[joint]
    nearest = float(np.linalg.norm(head - meets, axis=1).min())
    _require(
        nearest > 2 * graph.tolerance,
        f"the shaft meets the triangle at its corner {_at(meets)}: it must meet the middle of a side, "
        "and the corner opposite to that side is the tip",
    )
    bases = [segment_distance(meets[None], head[i - 1], head[i - 2])[0] for i in range(3)]
    i = int(np.argmin(bases))
    return _Arrow(tail, head[i], (head[i - 1], head[i - 2]), closed=True)


def _far_end(graph: StrokeGraph, chain: list[int], start: int) -> FloatArray:
    """Where a straight stroke ends that starts at a node."""
    path = simplify(graph.nodes[chain], graph.tolerance)
    _require(len(path) == 2, f"shaft and head are straight strokes, but one bends at {_at(path[1])}")
    end: FloatArray = graph.nodes[chain[-1] if chain[0] == start else chain[0]]
    return end


def _require_head(arrow: _Arrow) -> None:
    a, b = (abs(lean) for lean in arrow.leans)
    _require(
        max(a, b) <= 75,
        "the strokes of the head must lead back along the shaft, at most 75 degrees from it: "
        f"they lead off at {a:.0f} and {b:.0f} degrees",
    )
    _require(
        arrow.leans[0] * arrow.leans[1] < 0, "both strokes of the head are on the same side of the shaft"
    )
    _require(min(a, b) >= 8, f"the strokes of the head hug the shaft: {a:.0f} and {b:.0f} degrees from it")
    _require(
        abs(a - b) <= 25, f"the head is lopsided: its strokes lie {a:.0f} and {b:.0f} degrees from the shaft"
    )
    short, long = sorted(float(np.linalg.norm(barb - arrow.tip)) for barb in arrow.barbs)
    _require(
        short >= 0.5 * long, f"the head is lopsided: its strokes are {short:.1f} and {long:.1f} units long"
    )
    length = float(np.linalg.norm(arrow.tip - arrow.tail))
    _require(
        long * np.cos(np.radians(min(a, b))) <= 0.8 * length and long <= 1.1 * length,
        f"the shaft is too short for its head: {length:.1f} units, the head's strokes {long:.1f}",
    )


def _require_nothing_else(graph: StrokeGraph, arrow: _Arrow) -> None:
    middles = [(graph.nodes[i] + graph.nodes[j]) / 2 for i, j in sorted(graph.edges)]
    points = np.concatenate([graph.nodes[sorted(graph.neighbours)], np.stack(middles)])
    off = np.min([segment_distance(points, a, b) for a, b in arrow.strokes], axis=0)
    _require(
        off.max() <= 2 * graph.tolerance,
        f"the stroke at {_at(points[off.argmax()])} belongs neither to the shaft nor to the head of an arrow",
    )


def _aim(arrow: _Arrow, obstacles: Sequence[Any]) -> str:
    _require(bool(obstacles), "there is no obstacle to point at")
    biggest = max(obstacle.radius for obstacle in obstacles)
    way = [_distance_ahead(arrow, obstacle) for obstacle in obstacles]
    first = obstacles[int(np.argmin(way))]
    targets = [i for i, obstacle in enumerate(obstacles) if obstacle.radius == biggest]
    target = obstacles[min(targets, key=lambda i: way[i])]
    _require(min(way[i] for i in targets) < np.inf, _miss(arrow, target))
    _require(
        first.radius == biggest,
        f"the arrow meets {first.name} (radius {first.radius:.1f}) before the biggest obstacle {target.name} "
        f"(radius {target.radius:.1f})",
    )
    return f"an arrow that points at the biggest obstacle {target.name}"


def _distance_ahead(arrow: _Arrow, obstacle: Any) -> float:
    centre = np.array([obstacle.x_pos, obstacle.y_pos])
    return ray_to_circle(arrow.tip, arrow.tip - arrow.tail, centre, obstacle.radius)


def _miss(arrow: _Arrow, target: Any) -> str:
    aim = np.array([target.x_pos, target.y_pos]) - arrow.tip
    off = angle_between(arrow.tip - arrow.tail, aim)
    return (
        f"the arrow does not point at the biggest obstacle {target.name}: its centre lies {abs(off):.0f} degrees "
        f"to the {'left' if off > 0 else 'right'}, seen from the tip {_at(arrow.tip)}"
    )


# Letter M


def _letter_m(graph: StrokeGraph) -> str:
    points = _four_strokes(graph)
    up = _upright(points)
    tilt = angle_between(np.array([0.0, 1.0]), up)
    _require(
        abs(tilt) < 100, f"upside down, more like a W: its outer strokes end {abs(tilt):.0f} degrees off"
    )
    _require(abs(tilt) <= 24, f"tilted by {abs(tilt):.0f} degrees, more than 20")
    _require_proportions(points @ np.array([[up[1], up[0]], [-up[0], up[1]]]))
    return f"a letter M, {abs(tilt):.0f} degrees from upright"


def _four_strokes(graph: StrokeGraph) -> FloatArray:
    """Foot, top, middle, top, foot: shape (5, 2), from either side."""
    forks, feet = graph.of_degree(3), graph.of_degree(1, 1)
    rule = "the four strokes of an M join end to end, from foot to foot"
    _require(not forks, f"{rule}: here strokes branch or cross at {_at(graph.nodes[(forks or [0])[0]])}")
    _require(bool(feet), f"{rule}: here they close a loop")
    _require(len(graph.chains) == 1, f"{rule}: here are {len(graph.chains)} separate lines")
    _require(set(graph.chains[0]) == set(graph.neighbours), f"{rule}: here is a closed loop besides")
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
    left, right = (points[:3], points[:1:-1]) if points[1, 0] < points[3, 0] else (points[:1:-1], points[:3])
    (foot, top, middle), (other_foot, other_top, _) = left, right
    slants = [angle_between(np.array([0.0, 1.0]), leg) for leg in (top - foot, other_top - other_foot)]
    _require(
        max(np.abs(slants)) <= 20,
        f"the legs slant by {abs(slants[0]):.0f} and {abs(slants[1]):.0f} degrees: a zigzag, no M",
    )
    short, long = sorted([top[1] - foot[1], other_top[1] - other_foot[1]])
    _require(short >= 0.7 * long, f"the legs are unequal: {short:.1f} and {long:.1f} units")
    height = (short + long) / 2
    level = max(abs(top[1] - other_top[1]), abs(foot[1] - other_foot[1]))
    _require(level <= 0.25 * height, f"one leg stands {level:.1f} units higher than the other")
    wide, base = other_top[0] - top[0], other_foot[0] - foot[0]
    ratio = (wide + base) / 2 / height
    _require(0.35 <= ratio <= 2, f"{ratio:.1f} times as wide as high: an M is 0.35 to 2 times")
    _require(0.7 <= base / wide <= 2.5, f"the feet are {base:.1f} units apart, the tops {wide:.1f}")
    _require_notch((middle - top) / [wide, 1], (top[1] + other_top[1]) / 2 - middle[1], height)


def _require_notch(middle: FloatArray, depth: float, height: float) -> None:
    """`middle[0]`: the share of the way from the left top to the right one."""
    _require(depth > 0, "the two middle strokes meet above the legs, in an M they meet between them")
    _require(
        0.3 <= depth / height <= 1.1,
        f"the middle of the M reaches {depth / height:.2f} of the way down, it should reach 0.3 to 1.1 of it",
    )
    _require(
        0.25 <= middle[0] <= 0.75, f"the middle of the M stands {middle[0]:.2f} of the way from leg to leg"
    )


# Enclosure


def _enclosure(graph: StrokeGraph, obstacles: Sequence[Any], count: int) -> str:
    curves = outlines(graph)
    if not curves:
        _require_closed(graph)
    found = [[_position(obstacle, curve) for obstacle in obstacles] for curve in curves]
    best = max(found, key=lambda positions: positions.count("inside"), default=[])
    names = [o.name for o, position in zip(obstacles, best, strict=True) if position == "inside"]
    cut = [o.name for o, position in zip(obstacles, best, strict=True) if position == "cut"]
    _require(
        len(names) >= count,
        f"the closed curve has {len(names)} of {count} obstacles wholly inside"
        + (f": {', '.join(names)}" if names else "")
        + (f"; it cuts {', '.join(cut)}" if cut else "")
        + (f"; there are {len(curves)} curves, and each is counted by itself" if len(curves) > 1 else ""),
    )
    return f"a closed curve encloses {', '.join(names)}"


def _position(obstacle: Any, curve: FloatArray) -> str:
    centre = np.array([obstacle.x_pos, obstacle.y_pos])
    if clearance(centre, curve) < obstacle.radius:
        return "cut"
    return "inside" if inside(centre, curve) else "outside"
