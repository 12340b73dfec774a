"""Reads an arrow: a shaft with a head of two or three strokes, and what it points at."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from proc3s.domain.values import FloatArray
from proc3s_drawing import geometry as geo
from proc3s_drawing.geometry import StrokeGraph, angle_between
from proc3s_drawing.readings import Reading, at, centre, degree, require, unit, within


def read_arrow(graph: StrokeGraph, obstacles: Sequence[Any]) -> Reading:
    """An arrow that points at the biggest of the obstacles."""
    arrow, margin = _arrow(graph)
    says, spare = _aim(arrow, obstacles)
    return says, min(margin, spare)


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


def _arrow(graph: StrokeGraph) -> tuple[_Arrow, float]:
    """An arrow, and the margin of its proportions."""
    curves = geo.outlines(graph)
    require(len(curves) <= 1, f"{len(curves)} separate closed shapes, an arrow has one head")
    arrow = _closed_head(graph, curves[0]) if curves else _open_head(graph)
    margin = _head(arrow)
    strokes = [(arrow.tail, arrow.tip), *((arrow.tip, barb) for barb in arrow.barbs), arrow.barbs]
    middles = np.stack([graph.nodes[[*edge]].mean(axis=0) for edge in sorted(graph.edges)])
    off = np.min([geo.segment_distance(middles, a, b) for a, b in strokes], axis=0)
    stray = f"the stroke at {at(middles[off.argmax()])} belongs neither to the shaft nor to the head"
    require(off.max() <= 2 * graph.tolerance, stray)
    return arrow, margin


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
        f"the shaft meets the triangle at its corner {at(meets)}: it must meet the middle of a side, "
        "and the corner opposite to that side is the tip",
    )
    i = int(np.argmin([geo.segment_distance(meets, head[i - 1], head[i - 2]) for i in range(3)]))
    return _Arrow(tail, head[i], (head[i - 1], head[i - 2]))


def _far_end(graph: StrokeGraph, chain: list[int], start: int) -> FloatArray:
    """Where a straight stroke ends that starts at a node; shaky strokes may double back there."""
    path = graph.nodes[chain if chain[0] == start else chain[::-1]]
    away = np.linalg.norm(path - path[0], axis=1)
    path = geo.simplify(np.concatenate([path[:1], path[away > 3 * graph.tolerance]]), graph.tolerance)
    require(len(path) > 1, f"the stroke at {at(path[0])} is too short to see")
    require(len(path) == 2, f"shaft and head are straight strokes, but one bends at {at(path[1])}")
    end: FloatArray = path[1]
    return end


def _head(arrow: _Arrow) -> float:
    """The margin of its proportions."""
    narrow, wide = sorted(float(lean) for lean in np.abs(arrow.leans))
    rule = "the two strokes of the head must lead back along the shaft, one on each side, at 8 to 72 degrees"
    short, long = sorted(float(np.linalg.norm(barb - arrow.tip)) for barb in arrow.barbs)
    steep, leads = min(narrow - 8, 72 - wide) * degree(short), f"{narrow:.0f} and {wide:.0f} degrees"
    require(8 <= narrow <= wide <= 72, f"{rule}: they lead off at {leads}", steep)
    require(arrow.leans[0] * arrow.leans[1] < 0, f"{rule}: they are on the same side")
    turn, length = degree(short), arrow.length
    back = long * float(np.cos(np.radians(narrow))) / length
    return min(
        steep,
        within("a lopsided head: the difference of its two angles in degrees", wide - narrow, 0, 20, turn),
        within("a lopsided head: its shorter stroke as a share of the longer", short / long, 0.6, 1, long),
        within(
            "the length of the head's strokes as a share of the arrow's", long / length, 0.05, 0.8, length
        ),
        within("how far the head leads back as a share of the length of the arrow", back, 0, 0.7, length),
    )


def _aim(arrow: _Arrow, obstacles: Sequence[Any]) -> Reading:
    require(bool(obstacles), "there is no obstacle to point at")
    ahead = arrow.tip - arrow.tail
    way = [geo.ray_to_circle(arrow.tip, ahead, centre(o), o.radius) for o in obstacles]
    # Of several that are biggest, the one that the arrow meets first.
    target = min(range(len(way)), key=lambda i: (-obstacles[i].radius, way[i]))
    first, biggest = obstacles[int(np.argmin(way))], obstacles[target]
    name = f"the biggest obstacle {biggest.name} (radius {biggest.radius:.1f})"
    off = float(angle_between(ahead, centre(biggest) - arrow.tip))
    beside = f"its centre lies {abs(off):.0f} degrees to the {'left' if off > 0 else 'right'}"
    missed = f"the arrow does not point at {name}: {beside}, seen from the tip {at(arrow.tip)}"
    require(way[target] < np.inf, missed)
    met = f"the arrow meets {first.name} (radius {first.radius:.1f}) before {name}"
    require(first.radius == biggest.radius, met)
    others = [o for o in obstacles if o.radius != biggest.radius]
    return f"an arrow that points at {name}", _spare(arrow, biggest, others)


def _spare(arrow: _Arrow, target: Any, others: Sequence[Any]) -> float:
    """How far the tip may move aside until the arrow passes the target, or meets one of the others first."""
    along = unit(arrow.tip - arrow.tail)

    def ahead(obstacle: Any) -> float:
        return float((centre(obstacle) - arrow.tail) @ along)

    def clear(obstacle: Any) -> float:
        """How far the ray passes an obstacle, negative where it meets it, seen at the tip of the arrow."""
        beside = abs(float(geo.cross(along, centre(obstacle) - arrow.tail))) - float(obstacle.radius)
        return beside * min(1.0, arrow.length / max(ahead(obstacle), 1e-9))

    nearer = [other for other in others if arrow.length < ahead(other) < ahead(target)]
    return min([-clear(target), *(clear(other) for other in nearer)])
