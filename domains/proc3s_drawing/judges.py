"""Judges of the Drawing domain: does the picture show what was asked for?

They see a drawing as a person does: gaps and overshoots under 1 % of its size do not count, nor do the
order, direction, repetition and splitting of its lines.

The margin of a score is how far the end of a stroke may be moved until proportions, angles and places are
wrong, canvas units; that lines meet and do not cross where they must not has none.
"""

import math
from collections.abc import Sequence
from itertools import combinations
from typing import Any

import numpy as np

from proc3s.domain.values import FloatArray, Plan
from proc3s.domain.world import Score
from proc3s_drawing import geometry as geo
from proc3s_drawing.arrows import read_arrow
from proc3s_drawing.geometry import StrokeGraph, angle_between
from proc3s_drawing.readings import Reading, Refusal, at, centre, degree, require, unit, verdict, within


def is_star(state: Any, plan: Plan) -> Score:
    """A closed star of at least 5 points, drawn as crossing strokes or as an outline."""
    return verdict(state, _star)


def is_arrow(state: Any, plan: Plan) -> Score:
    """A shaft with a head of two or three strokes whose ray meets the biggest obstacle before any other."""
    return verdict(state, lambda graph: read_arrow(graph, state.obstacles))


def is_letter_m(state: Any, plan: Plan) -> Score:
    """Four strokes end to end that a person reads as a capital M, tilted by 20 degrees at most."""
    return verdict(state, _letter_m)


def encloses(state: Any, plan: Plan, count: int = 2, exact: bool = False) -> Score:
    """One closed curve that does not cross itself, with at least `count` whole obstacles inside; if `exact`,
    just so many, and it cuts no other."""
    return verdict(state, lambda graph: _enclosure(graph, state.obstacles, count, exact))


def _star(graph: StrokeGraph) -> Reading:
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
    return f"a closed star with {len(tips)} points", _all_round(ring, tips)


def _require_closed(graph: StrokeGraph) -> None:
    loose = graph.of_degree(1, 1)
    if len(loose) == 1:
        raise Refusal(f"not closed: a stroke ends loose at {at(graph.nodes[loose[0]])}")
    if loose:
        a, b = min(combinations(loose, 2), key=graph.length)
        ends = f"{at(graph.nodes[a])} and {at(graph.nodes[b])}"
        raise Refusal(f"the outline is not closed: {graph.length((a, b)):.1f} units between {ends}")


def _all_round(ring: FloatArray, tips: FloatArray) -> float:
    """The margin of how its points stand around.

    Seen from its middle, a star runs round once, and its points reach far enough in all directions.
    """
    middle = tips.mean(axis=0)
    around = angle_between(ring - middle, np.roll(ring, -1, axis=0) - middle)
    zigzag = f"a closed zigzag, no star: it does not run once around its middle {at(middle)}"
    require(bool(np.all(around > 0)), zigzag)
    reach = np.linalg.norm(tips - middle, axis=1)
    short, long = reach.min(), reach.max()
    spread = angle_between(tips - middle, np.roll(tips, -1, axis=0) - middle).max()
    return min(
        within("the shortest point of the star as a share of the longest", short / long, 0.4, 1, long),
        within("degrees between two points of the star", spread, 0, round(648 / len(tips)), degree(short)),
    )


def _letter_m(graph: StrokeGraph) -> Reading:
    points = _four_strokes(graph)
    up = _upright(points)
    tilt = float(angle_between(np.array([0.0, 1.0]), up))
    require(abs(tilt) < 100, f"upside down, more like a W: {abs(tilt):.0f} degrees from upright")
    spare = (24 - abs(tilt)) * degree(float(np.ptp(points @ up)))
    require(abs(tilt) <= 24, f"tilted by {abs(tilt):.0f} degrees, more than 20", spare)
    margin = _proportions(points @ np.array([[up[1], up[0]], [-up[0], up[1]]]))
    return f"a letter M, {abs(tilt):.0f} degrees from upright", min(spare, margin)


def _four_strokes(graph: StrokeGraph) -> FloatArray:
    """Foot, top, middle, top, foot: shape (5, 2), from either side."""
    forks, rule = graph.of_degree(3), "the four strokes of an M join end to end, from foot to foot"
    crossings = ", ".join(at(graph.nodes[fork]) for fork in forks)
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
    legs = unit(top - foot) + unit(other_top - other_foot)
    side_by_side = bool(np.linalg.norm(legs) > 1)
    require(side_by_side, "the first and the last stroke of an M are legs that stand side by side")
    across = unit(other_top - top) + unit(other_foot - foot)
    normal = np.array([-across[1], across[0]])
    return unit(unit(legs) + unit(normal if normal @ legs > 0 else -normal))


def _proportions(points: FloatArray) -> float:
    """The margin of the proportions of an M that stands upright in its own frame, x to the right, y up."""
    foot, top, middle, other_top, other_foot = points if points[1, 0] < points[3, 0] else points[::-1]
    slants = [
        within(
            "a zigzag, no M: degrees by which a leg slants", np.degrees(np.arctan2(x, y)), -20, 20, degree(y)
        )
        for x, y in (top - foot, other_top - other_foot)
    ]
    short, long = sorted([top[1] - foot[1], other_top[1] - other_foot[1]])
    height, wide, base = (short + long) / 2, other_top[0] - top[0], other_foot[0] - foot[0]
    level = max(abs(top[1] - other_top[1]), abs(foot[1] - other_foot[1])) / height
    depth, across = ((top[1] + other_top[1]) / 2 - middle[1]) / height, (middle[0] - top[0]) / wide
    return min(
        *slants,
        within("the shorter leg of the M as a share of the longer", short / long, 0.7, 1, long),
        within("how much higher one leg of the M stands as a share of its height", level, 0, 0.25, height),
        within("the width of the M as a share of its height", (wide + base) / 2 / height, 0.35, 2, height),
        within(
            "the distance of the feet of the M as a share of that of its tops", base / wide, 0.7, 2.5, wide
        ),
        within("how far down the middle of the M reaches as a share of its height", depth, 0.3, 1.1, height),
        within("how far from leg to leg the middle of the M stands", across, 0.25, 0.75, wide),
    )


def _enclosure(graph: StrokeGraph, obstacles: Sequence[Any], count: int, exact: bool) -> Reading:
    curves = geo.outlines(graph)
    if not curves:
        _require_closed(graph)
    require(bool(curves), "no closed curve is wide enough to hold anything")
    found = [[_position(obstacle, curve) for obstacle in obstacles] for curve in curves]
    best = max(found, key=lambda positions: positions.count("inside"))
    curve = curves[found.index(best)]
    within = [o.name for o, position in zip(obstacles, best, strict=True) if position == "inside"]
    cut = [o.name for o, position in zip(obstacles, best, strict=True) if position == "cut"]
    reason = f"the closed curve has {len(within)} of {count} obstacles wholly inside"
    reason += f": {', '.join(within)}" if within else ""
    reason += f"; it cuts {', '.join(cut)}" if cut else ""
    reason += f"; there are {len(curves)} curves, each counts by itself" if len(curves) > 1 else ""
    require(len(within) >= count and not (exact and (cut or len(within) > count)), reason)
    clear = [_clear(o, curve) for o, position in zip(obstacles, best, strict=True) if position == "inside"]
    needed = [_clear(o, curve) for o in obstacles] if exact else sorted(clear, reverse=True)[:count]
    return f"a closed curve encloses {', '.join(within)}", min(needed, default=math.inf)


def _position(obstacle: Any, curve: FloatArray) -> str:
    if _clear(obstacle, curve) < 0:
        return "cut"
    return "inside" if geo.inside(centre(obstacle), curve) else "outside"


def _clear(obstacle: Any, curve: FloatArray) -> float:
    """How far a closed curve keeps from an obstacle, negative where it cuts it."""
    distances = geo.segment_distance(centre(obstacle), curve, np.roll(curve, -1, axis=0))
    return float(distances.min() - obstacle.radius)
