"""Judges of the harder drawings: a spiral, and a word.

Margins are how far the end of a stroke may be moved until sizes, angles and proportions are wrong.
"""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from proc3s.domain.values import FloatArray, Plan
from proc3s.domain.world import Score
from proc3s_drawing import geometry as geo
from proc3s_drawing.geometry import StrokeGraph, angle_between
from proc3s_drawing.readings import Reading, degree, require, verdict, within

SHY = 15.0
"""By so many degrees a turn may fall short: the ends of a polygon turn on one side only."""
UP = np.array([0.0, 1.0])


def is_spiral(state: Any, plan: Plan, turns: float = 2.0, size: float = 0.0) -> Score:
    """One curve, at least `size` canvas units wide and high, that never crosses itself and turns the same
    way all along, `turns` times or more.

    Such a curve can only lead further and further out, or in.
    """
    return verdict(state, lambda graph: _spiral(graph, turns, size))


def spells_hi(state: Any, plan: Plan) -> Score:
    """An upright H of two legs and a bar, and to its right, apart from it, an I of one stroke."""
    return verdict(state, _hi)


def _spiral(graph: StrokeGraph, turns: float, size: float) -> Reading:
    require(not graph.of_degree(3), "the curve crosses or touches itself")
    require(len(graph.chains) == 1, f"a spiral is one open curve; here are {len(graph.chains)}")
    require({*graph.chains[0]} == {*graph.neighbours}, "there is a closed loop besides the curve")
    strokes = np.diff(graph.nodes[graph.chains[0]], axis=0)
    bends = angle_between(strokes[:-1], strokes[1:])
    turned = float(np.abs(bends.sum()))
    back = float(np.abs(bends).sum()) - turned
    unit = degree(float(np.linalg.norm(strokes, axis=1).min()))
    straight, far = (SHY - back) * unit, (turned - (360 * turns - SHY)) * unit
    require(straight >= 0, f"the curve turns back by {back / 2:.0f} degrees in all", straight)
    require(far >= 0, f"the curve turns by {turned:.0f} degrees, {360 * turns:.0f} are wanted", far)
    spread = float(np.ptp(graph.nodes[graph.chains[0]], axis=0).min())
    require(
        spread >= size, f"the curve is {spread:.0f} units wide or high, {size:g} are wanted", spread - size
    )
    says = f"a curve that turns by {turned:.0f} degrees and never crosses itself"
    return says, min(straight, far, spread - size)


class _Letter(NamedTuple):
    """A letter that was read, and its box."""

    left: float
    right: float
    bottom: float
    top: float
    margin: float
    """How far the end of a stroke may be moved until it is another, canvas units."""

    @property
    def height(self) -> float:
        return self.top - self.bottom


def _hi(graph: StrokeGraph) -> Reading:
    parts = sorted(_parts(graph), key=lambda part: float(graph.nodes[part, 0].mean()))
    require(len(parts) == 2, f"H and I are two separate letters; here are {len(parts)} separate drawings")
    h, i = _read_h(graph, parts[0]), _read_i(graph, parts[1])
    low, high = sorted((h.height, i.height))
    level, apart = abs(h.bottom - i.bottom) / high, (i.left - h.right) / high
    return "the letters H and I, in this order", min(
        h.margin,
        i.margin,
        within("the lower letter as a share of the higher", low / high, 0.7, 1, high),
        within("how unlevel the letters stand, as a share of their height", level, 0, 0.2, high),
        within("the gap between the letters as a share of their height", apart, 0.1, 2, high),
    )


def _parts(graph: StrokeGraph) -> Iterator[list[int]]:
    """The nodes of each connected part."""
    left = set(graph.neighbours)
    while left:
        found, todo = set[int](), [min(left)]
        while todo:
            node = todo.pop()
            if node not in found:
                found.add(node)
                todo += graph.neighbours[node]
        left -= found
        yield sorted(found)


def _read_h(graph: StrokeGraph, part: Sequence[int]) -> _Letter:
    forks = [node for node in graph.of_degree(3, 3) if node in part]
    ends = [node for node in graph.of_degree(1, 1) if node in part]
    shape = "the left letter is no H: two legs and a bar that joins their sides"
    require(len(forks) == 2 and len(ends) == 4 and not set(graph.of_degree(4)) & set(part), shape)
    forks.sort(key=lambda node: float(graph.nodes[node, 0]))
    chains = [chain for chain in graph.chains if chain[0] in part]
    bars = [chain for chain in chains if {chain[0], chain[-1]} == set(forks)]
    require(len(bars) == 1 and len(chains) == 5, shape)
    straight = _straight(graph, bars[0], "the bar of the H", np.array([1.0, 0.0]), 20)
    legs, upright = zip(*(_leg(graph, chains, fork) for fork in forks), strict=True)
    letter = _box(np.vstack(legs), min(straight, *upright))
    margin = _proportions(legs[0], legs[1], letter, float(graph.nodes[forks, 1].mean()))
    return letter._replace(margin=min(letter.margin, margin))


def _proportions(left: FloatArray, right: FloatArray, letter: _Letter, bar: float) -> float:
    """The margin of the proportions of an H of two legs (2, 2), with its bar at this height."""
    tall, wide = letter.height, float(right[:, 0].mean() - left[:, 0].mean())
    low, high = sorted(float(np.ptp(leg[:, 1])) for leg in (left, right))
    level = abs(float(left[:, 1].min() - right[:, 1].min())) / tall
    up = (bar - letter.bottom) / tall
    return min(
        within("the width of the H as a share of its height", wide / tall, 0.3, 1.5, tall),
        within("the height of its bar as a share of that of the H", up, 0.25, 0.75, tall),
        within("the shorter leg of the H as a share of the longer", low / high, 0.8, 1, high),
        within("how unlevel the legs of the H stand, as a share of its height", level, 0, 0.2, tall),
    )


def _leg(graph: StrokeGraph, chains: Sequence[list[int]], fork: int) -> tuple[FloatArray, float]:
    """The two ends (2, 2) of the leg that a fork lies on, and the margin of how upright it is."""
    arms = [c for c in chains if fork in (c[0], c[-1]) and len({c[0], c[-1]} & set(graph.of_degree(3))) == 1]
    require(len(arms) == 2, "a leg of the H is no line through the end of its bar")
    margin = min(_straight(graph, arm, "a leg of the H", UP, 15) for arm in arms)
    return np.array([graph.nodes[arm[-1] if arm[0] == fork else arm[0]] for arm in arms]), margin


def _read_i(graph: StrokeGraph, part: Sequence[int]) -> _Letter:
    chains = [chain for chain in graph.chains if chain[0] in part]
    require(len(chains) == 1 and {*chains[0]} == {*part}, "the right letter is no I of one stroke")
    return _box(graph.nodes[[*part]], _straight(graph, chains[0], "the I", UP, 15))


def _straight(graph: StrokeGraph, chain: Sequence[int], what: str, way: FloatArray, most: float) -> float:
    """The margin of a chain that may lean from a way by at most `most` degrees; a bent one is refused."""
    points = geo.simplify(graph.nodes[[*chain]], graph.tolerance)
    require(len(points) == 2, f"{what} is not straight")
    along = points[1] - points[0]
    lean = abs(float(angle_between(way, along)))
    unit = degree(float(np.linalg.norm(along)))
    return within(f"{what}: degrees by which it leans", min(lean, 180 - lean), 0, most, unit)


def _box(points: FloatArray, margin: float) -> _Letter:
    (left, bottom), (right, top) = points.min(axis=0), points.max(axis=0)
    return _Letter(float(left), float(right), float(bottom), float(top), margin)
