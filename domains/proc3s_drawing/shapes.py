"""Judges of the harder drawings: a spiral, and a word."""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from proc3s.domain.values import FloatArray, Plan
from proc3s.domain.world import Score
from proc3s_drawing import geometry as geo
from proc3s_drawing.geometry import StrokeGraph, angle_between
from proc3s_drawing.judges import require, verdict, within

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


def _spiral(graph: StrokeGraph, turns: float, size: float) -> str:
    require(not graph.of_degree(3), "the curve crosses or touches itself")
    require(len(graph.chains) == 1, f"a spiral is one open curve; here are {len(graph.chains)}")
    require({*graph.chains[0]} == {*graph.neighbours}, "there is a closed loop besides the curve")
    strokes = np.diff(graph.nodes[graph.chains[0]], axis=0)
    bends = angle_between(strokes[:-1], strokes[1:])
    turned = float(np.abs(bends.sum()))
    back = float(np.abs(bends).sum()) - turned
    require(back <= SHY, f"the curve turns back by {back / 2:.0f} degrees in all")
    least = 360 * turns - SHY
    require(turned >= least, f"the curve turns by {turned:.0f} degrees, {360 * turns:.0f} are wanted")
    spread = float(np.ptp(graph.nodes[graph.chains[0]], axis=0).min())
    require(spread >= size, f"the curve is {spread:.0f} units wide or high, {size:g} are wanted")
    return f"a curve that turns by {turned:.0f} degrees and never crosses itself"


class _Letter(NamedTuple):
    """A letter that was read, and its box."""

    left: float
    right: float
    bottom: float
    top: float

    @property
    def height(self) -> float:
        return self.top - self.bottom


def _hi(graph: StrokeGraph) -> str:
    parts = sorted(_parts(graph), key=lambda part: float(graph.nodes[part, 0].mean()))
    require(len(parts) == 2, f"H and I are two separate letters; here are {len(parts)} separate drawings")
    h, i = _read_h(graph, parts[0]), _read_i(graph, parts[1])
    low, high = sorted((h.height, i.height))
    within("the lower letter as a share of the higher", low / high, 0.7, 1)
    within(
        "how unlevel the letters stand, as a share of their height", abs(h.bottom - i.bottom) / high, 0, 0.2
    )
    within("the gap between the letters as a share of their height", (i.left - h.right) / high, 0.1, 2)
    return "the letters H and I, in this order"


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
    _require_straight(graph, bars[0], "the bar of the H", np.array([1.0, 0.0]), 20)
    legs = [_leg(graph, chains, fork) for fork in forks]
    (left, right), bar = legs, graph.nodes[forks].mean(axis=0)
    letter = _box(np.vstack(legs))
    wide = float(right[:, 0].mean() - left[:, 0].mean())
    within("the width of the H as a share of its height", wide / letter.height, 0.3, 1.5)
    within(
        "the height of its bar as a share of that of the H",
        (bar[1] - letter.bottom) / letter.height,
        0.25,
        0.75,
    )
    low, high = sorted(float(np.ptp(leg[:, 1])) for leg in legs)
    within("the shorter leg of the H as a share of the longer", low / high, 0.8, 1)
    level = abs(float(left[:, 1].min() - right[:, 1].min())) / letter.height
    within("how unlevel the legs of the H stand, as a share of its height", level, 0, 0.2)
    return letter


def _leg(graph: StrokeGraph, chains: Sequence[list[int]], fork: int) -> FloatArray:
    """The two ends (2, 2) of the leg that a fork lies on."""
    arms = [c for c in chains if fork in (c[0], c[-1]) and len({c[0], c[-1]} & set(graph.of_degree(3))) == 1]
    require(len(arms) == 2, "a leg of the H is no line through the end of its bar")
    for arm in arms:
        _require_straight(graph, arm, "a leg of the H", UP, 15)
    return np.array([graph.nodes[arm[-1] if arm[0] == fork else arm[0]] for arm in arms])


def _read_i(graph: StrokeGraph, part: Sequence[int]) -> _Letter:
    chains = [chain for chain in graph.chains if chain[0] in part]
    require(len(chains) == 1 and {*chains[0]} == {*part}, "the right letter is no I of one stroke")
    _require_straight(graph, chains[0], "the I", UP, 15)
    return _box(graph.nodes[[*part]])


def _require_straight(
    graph: StrokeGraph, chain: Sequence[int], what: str, way: FloatArray, most: float
) -> None:
    """Refuse a chain that is bent, or leans from a way by more than `most` degrees."""
    points = geo.simplify(graph.nodes[[*chain]], graph.tolerance)
    require(len(points) == 2, f"{what} is not straight")
    lean = abs(float(angle_between(way, points[1] - points[0])))
    within(f"{what}: degrees by which it leans", min(lean, 180 - lean), 0, most)


def _box(points: FloatArray) -> _Letter:
    (left, bottom), (right, top) = points.min(axis=0), points.max(axis=0)
    return _Letter(float(left), float(right), float(bottom), float(top))
