"""Judges of the Drawing domain: does the picture show what was asked for?

They see a drawing as a person does: gaps and overshoots under 1 % of its size do not count, nor do the
order, direction, repetition and splitting of its lines.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from proc3s.domain.values import FloatArray, Plan
from proc3s.domain.world import Score
from proc3s_drawing import geometry as geo
from proc3s_drawing.geometry import StrokeGraph, angle_between


def is_star(state: Any, plan: Plan) -> Score:
    """A closed star of at least 5 points, drawn as crossing strokes or as an outline."""
    return verdict(state, _star)


def is_arrow(state: Any, plan: Plan) -> Score:
    """A shaft with a head of two or three strokes whose ray meets the biggest obstacle before any other."""
    return verdict(state, lambda graph: _aim(_arrow(graph), state.obstacles))


def is_letter_m(state: Any, plan: Plan) -> Score:
    """Four strokes end to end that a person reads as a capital M, tilted by 20 degrees at most."""
    return verdict(state, _letter_m)


def encloses(state: Any, plan: Plan, count: int = 2, exact: bool = False) -> Score:
    """One closed curve that does not cross itself, with at least `count` whole obstacles inside; if `exact`,
    just so many, and it cuts no other."""
    return verdict(state, lambda graph: _enclosure(graph, state.obstacles, count, exact))


class Refusal(Exception):
    """Why the drawing is not what it should be."""


def require(holds: bool, reason: str) -> None:
    """Refuse for a reason where something does not hold."""
    if not holds:
        raise Refusal(reason)


def within(what: str, value: float, low: float, high: float) -> None:
    """Refuse a figure outside its bounds."""
    require(low <= value <= high, f"{what}: {value:.2f}, it should be {low:g} to {high:g}")


def verdict(state: Any, read: Callable[[StrokeGraph], str]) -> Score:
    """What a reader of the drawing says of a state; it returns a reason or raises Refusal."""
    lines = [(line.p1_x, line.p1_y, line.p2_x, line.p2_y) for line in state.drawn_lines]
    try:
        graph = geo.stroke_graph(np.array(lines, dtype=np.float64).reshape(-1, 4))
        require(bool(graph.edges), "nothing is drawn, or only dots")
        return Score(True, read(graph))
    except (Refusal, geo.TangledError) as refusal:
        return Score(False, str(refusal))


def _at(point: FloatArray) -> str:
    return f"({point[0]:.1f}, {point[1]:.1f})"


def _star(graph: StrokeGraph) -> str:
    _require_closed(graph)
    curves = geo.outlines(graph)
    require(len(curves) == 1, f"{len(curves)} separate closed shapes, a star is one")
    ring = geo.corners(curves[0], graph.tolerance)
    turn = geo.turns(ring)
    tips, inner = ring[turn > 0], int((turn < 0).sum())
    require(inner > 0, f"a closed convex polygon with {len(tips)} corners, no star: it has no inner corners")
    count = f"a closed outline with {len(tips)} points and {inner} inner corners, no star"
    alternate = bool(np.all(turn * np.roll(turn, 1) < 0))
    require(alternate, f"{count}: a star has exactly one inner corner between one point and the next")
    require(len(tips) >= 5, f"a closed star with {len(tips)} points only, it needs at least 5")
    _require_all_round(ring, tips)
    return f"a closed star with {len(tips)} points"


def _require_closed(graph: StrokeGraph) -> None:
    loose = graph.of_degree(1, 1)
    if len(loose) == 1:
        raise Refusal(f"not closed: a stroke ends loose at {_at(graph.nodes[loose[0]])}")
    if loose:
        a, b = min(combinations(loose, 2), key=graph.length)
        ends = f"{_at(graph.nodes[a])} and {_at(graph.nodes[b])}"
        raise Refusal(f"the outline is not closed: {graph.length((a, b)):.1f} units between {ends}")


def _require_all_round(ring: FloatArray, tips: FloatArray) -> None:
    """Seen from its middle, a star runs round once, and its points reach far enough in all directions."""
    middle = tips.mean(axis=0)
    around = angle_between(ring - middle, np.roll(ring, -1, axis=0) - middle)
    zigzag = f"a closed zigzag, no star: it does not run once around its middle {_at(middle)}"
    require(bool(np.all(around > 0)), zigzag)
    reach = np.linalg.norm(tips - middle, axis=1)
    within("the shortest point of the star as a share of the longest", reach.min() / reach.max(), 0.4, 1)
    spread = angle_between(tips - middle, np.roll(tips, -1, axis=0) - middle).max()
    within("degrees between two points of the star", spread, 0, round(1.8 * 360 / len(tips)))


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
    curves = geo.outlines(graph)
    require(len(curves) <= 1, f"{len(curves)} separate closed shapes, an arrow has one head")
    arrow = _closed_head(graph, curves[0]) if curves else _open_head(graph)
    _require_head(arrow)
    strokes = [(arrow.tail, arrow.tip), *((arrow.tip, barb) for barb in arrow.barbs), arrow.barbs]
    middles = np.stack([graph.nodes[[*edge]].mean(axis=0) for edge in sorted(graph.edges)])
    off = np.min([geo.segment_distance(middles, a, b) for a, b in strokes], axis=0)
    stray = f"the stroke at {_at(middles[off.argmax()])} belongs neither to the shaft nor to the head"
    require(off.max() <= 2 * graph.tolerance, stray)
    return arrow


def _open_head(graph: StrokeGraph) -> _Arrow:
    """Of three strokes that meet in the tip, the shaft is a long one between the other two."""
    loose, forks = graph.of_degree(1, 1), graph.of_degree(3)
    require(bool(forks), "no head: two strokes must lead back from the tip of the shaft, and none does")
    require(
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
    head = geo.corners(curve, graph.tolerance)
    require(len(head) == 3, f"the closed head has {len(head)} corners, a triangle has 3")
    tails = [end for end in graph.of_degree(1, 1) if not geo.inside(graph.nodes[end], curve)]
    require(len(tails) == 1, f"{len(tails)} loose ends outside the triangle: its shaft has one")
    chain = next(chain for chain in graph.chains if tails[0] in (chain[0], chain[-1]))
    joint = chain[0] if chain[-1] == tails[0] else chain[-1]
    tail, meets = _far_end(graph, chain, joint), graph.nodes[joint]
    require(
        bool(np.linalg.norm(head - meets, axis=1).min() > 2 * graph.tolerance),
        f"the shaft meets the triangle at its corner {_at(meets)}: it must meet the middle of a side, "
        "and the corner opposite to that side is the tip",
    )
    i = int(np.argmin([geo.segment_distance(meets, head[i - 1], head[i - 2]) for i in range(3)]))
    return _Arrow(tail, head[i], (head[i - 1], head[i - 2]))


def _far_end(graph: StrokeGraph, chain: list[int], start: int) -> FloatArray:
    """Where a straight stroke ends that starts at a node; shaky strokes may double back there."""
    path = graph.nodes[chain if chain[0] == start else chain[::-1]]
    away = np.linalg.norm(path - path[0], axis=1)
    path = geo.simplify(np.concatenate([path[:1], path[away > 3 * graph.tolerance]]), graph.tolerance)
    require(len(path) > 1, f"the stroke at {_at(path[0])} is too short to see")
    require(len(path) == 2, f"shaft and head are straight strokes, but one bends at {_at(path[1])}")
    end: FloatArray = path[1]
    return end


def _require_head(arrow: _Arrow) -> None:
    narrow, wide = sorted(np.abs(arrow.leans).tolist())
    rule = "the two strokes of the head must lead back along the shaft, one on each side, at 8 to 72 degrees"
    require(8 <= narrow <= wide <= 72, f"{rule}: they lead off at {narrow:.0f} and {wide:.0f} degrees")
    require(arrow.leans[0] * arrow.leans[1] < 0, f"{rule}: they are on the same side")
    within("a lopsided head: the difference of its two angles in degrees", wide - narrow, 0, 20)
    short, long = sorted(float(np.linalg.norm(barb - arrow.tip)) for barb in arrow.barbs)
    within("a lopsided head: its shorter stroke as a share of the longer", short / long, 0.6, 1)
    within("the length of the head's strokes as a share of the arrow's", long / arrow.length, 0.05, 0.8)
    back = long * np.cos(np.radians(narrow)) / arrow.length
    within("how far the head leads back as a share of the length of the arrow", back, 0, 0.7)


def _aim(arrow: _Arrow, obstacles: Sequence[Any]) -> str:
    require(bool(obstacles), "there is no obstacle to point at")
    ahead = arrow.tip - arrow.tail
    way = [geo.ray_to_circle(arrow.tip, ahead, _centre(o), o.radius) for o in obstacles]
    # Of several that are biggest, the one that the arrow meets first.
    target = min(range(len(way)), key=lambda i: (-obstacles[i].radius, way[i]))
    first, biggest = obstacles[int(np.argmin(way))], obstacles[target]
    name = f"the biggest obstacle {biggest.name} (radius {biggest.radius:.1f})"
    off = float(angle_between(ahead, _centre(biggest) - arrow.tip))
    beside = f"its centre lies {abs(off):.0f} degrees to the {'left' if off > 0 else 'right'}"
    missed = f"the arrow does not point at {name}: {beside}, seen from the tip {_at(arrow.tip)}"
    require(way[target] < np.inf, missed)
    met = f"the arrow meets {first.name} (radius {first.radius:.1f}) before {name}"
    require(first.radius == biggest.radius, met)
    return f"an arrow that points at {name}"


def _centre(obstacle: Any) -> FloatArray:
    return np.array([obstacle.x_pos, obstacle.y_pos], dtype=np.float64)


def _letter_m(graph: StrokeGraph) -> str:
    points = _four_strokes(graph)
    up = _upright(points)
    tilt = float(angle_between(np.array([0.0, 1.0]), up))
    require(abs(tilt) < 100, f"upside down, more like a W: {abs(tilt):.0f} degrees from upright")
    require(abs(tilt) <= 24, f"tilted by {abs(tilt):.0f} degrees, more than 20")
    _require_proportions(points @ np.array([[up[1], up[0]], [-up[0], up[1]]]))
    return f"a letter M, {abs(tilt):.0f} degrees from upright"


def _four_strokes(graph: StrokeGraph) -> FloatArray:
    """Foot, top, middle, top, foot: shape (5, 2), from either side."""
    forks, rule = graph.of_degree(3), "the four strokes of an M join end to end, from foot to foot"
    crossings = ", ".join(_at(graph.nodes[fork]) for fork in forks)
    require(not forks, f"{rule}: here strokes branch or cross at {crossings}")
    require(bool(graph.chains), f"{rule}: here they close a loop")
    require(len(graph.chains) == 1, f"{rule}: here are {len(graph.chains)} separate lines")
    require({*graph.chains[0]} == {*graph.neighbours}, f"{rule}: here is a closed loop besides")
    points = geo.simplify(graph.nodes[graph.chains[0]], graph.tolerance)
    require(len(points) == 5, f"{rule}: this line has {len(points) - 1} straight strokes")
    return points


def _upright(points: FloatArray) -> FloatArray:
    """The unit vector that is up for the letter: halfway between its legs and the normal of its lines."""
    foot, top, _, other_top, other_foot = points
    legs = _unit(top - foot) + _unit(other_top - other_foot)
    side_by_side = bool(np.linalg.norm(legs) > 1)
    require(side_by_side, "the first and the last stroke of an M are legs that stand side by side")
    across = _unit(other_top - top) + _unit(other_foot - foot)
    normal = np.array([-across[1], across[0]])
    return _unit(_unit(legs) + _unit(normal if normal @ legs > 0 else -normal))


def _unit(vector: FloatArray) -> FloatArray:
    unit: FloatArray = vector / max(float(np.linalg.norm(vector)), 1e-12)
    return unit


def _require_proportions(points: FloatArray) -> None:
    """Of an M that stands upright in its own frame, x to the right, y up."""
    foot, top, middle, other_top, other_foot = points if points[1, 0] < points[3, 0] else points[::-1]
    for x, y in (top - foot, other_top - other_foot):
        within("a zigzag, no M: degrees by which a leg slants", np.degrees(np.arctan2(x, y)), -20, 20)
    short, long = sorted([top[1] - foot[1], other_top[1] - other_foot[1]])
    within("the shorter leg of the M as a share of the longer", short / long, 0.7, 1)
    height, wide, base = (short + long) / 2, other_top[0] - top[0], other_foot[0] - foot[0]
    level = max(abs(top[1] - other_top[1]), abs(foot[1] - other_foot[1]))
    within("how much higher one leg of the M stands as a share of its height", level / height, 0, 0.25)
    within("the width of the M as a share of its height", (wide + base) / 2 / height, 0.35, 2)
    within("the distance of the feet of the M as a share of that of its tops", base / wide, 0.7, 2.5)
    depth = (top[1] + other_top[1]) / 2 - middle[1]
    within("how far down the middle of the M reaches as a share of its height", depth / height, 0.3, 1.1)
    within("how far from leg to leg the middle of the M stands", (middle[0] - top[0]) / wide, 0.25, 0.75)


def _enclosure(graph: StrokeGraph, obstacles: Sequence[Any], count: int, exact: bool) -> str:
    curves = geo.outlines(graph)
    if not curves:
        _require_closed(graph)
    require(bool(curves), "no closed curve is wide enough to hold anything")
    found = [[_position(obstacle, curve) for obstacle in obstacles] for curve in curves]
    best = max(found, key=lambda positions: positions.count("inside"))
    within = [o.name for o, position in zip(obstacles, best, strict=True) if position == "inside"]
    cut = [o.name for o, position in zip(obstacles, best, strict=True) if position == "cut"]
    reason = f"the closed curve has {len(within)} of {count} obstacles wholly inside"
    reason += f": {', '.join(within)}" if within else ""
    reason += f"; it cuts {', '.join(cut)}" if cut else ""
    reason += f"; there are {len(curves)} curves, each counts by itself" if len(curves) > 1 else ""
    require(len(within) >= count and not (exact and (cut or len(within) > count)), reason)
    return f"a closed curve encloses {', '.join(within)}"


def _position(obstacle: Any, curve: FloatArray) -> str:
    centre = _centre(obstacle)
    if geo.segment_distance(centre, curve, np.roll(curve, -1, axis=0)).min() < obstacle.radius:
        return "cut"
    return "inside" if geo.inside(centre, curve) else "outside"
