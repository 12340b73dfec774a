"""How a drawing is read: what it shows and how far from not showing it, or why it does not."""

import math
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np

from proc3s.domain.values import FloatArray
from proc3s.domain.world import Score
from proc3s_drawing import geometry as geo
from proc3s_drawing.geometry import StrokeGraph

Reading: TypeAlias = tuple[str, float]
"""What a drawing shows, and how far the end of a stroke may be moved until it does not, canvas units."""


class Refusal(Exception):
    """Why the drawing is not what it should be, and by how much if that is known, canvas units, negative."""

    def __init__(self, reason: str, margin: float = math.inf) -> None:
        super().__init__(reason)
        self.margin = margin


def require(holds: bool, reason: str, margin: float = math.inf) -> None:
    """Refuse for a reason where something does not hold; `margin` says by how much."""
    if not holds:
        raise Refusal(reason, margin)


def within(what: str, value: float, low: float, high: float, unit: float) -> float:
    """How far a figure is from its bounds, canvas units, where an end that moves by `unit` changes it by one.

    Refuses a figure outside. Bounds of 0 and 1 are those that no drawing passes, and leave out nothing.
    """
    spare = min(value - low if low else math.inf, high - value if high != 1 else math.inf)
    reason = f"{what}: {value:.2f}, it should be {low:g} to {high:g}"
    require(low <= value <= high, reason, spare * unit)
    return spare * unit


def degree(length: float) -> float:
    """How far the end of a stroke moves when that turns by a degree: the unit of figures in degrees."""
    return math.radians(length)


def verdict(state: Any, read: Callable[[StrokeGraph], Reading]) -> Score:
    """What a reader of the drawing says of a state; it returns a reading or raises Refusal."""
    lines = [(line.p1_x, line.p1_y, line.p2_x, line.p2_y) for line in state.drawn_lines]
    try:
        graph = geo.stroke_graph(np.array(lines, dtype=np.float64).reshape(-1, 4))
        require(bool(graph.edges), "nothing is drawn, or only dots")
        says, margin = read(graph)
        return Score(True, says, float(margin) if math.isfinite(margin) else None)
    except Refusal as refusal:
        return Score(False, str(refusal), float(refusal.margin) if math.isfinite(refusal.margin) else None)
    except geo.TangledError as error:
        return Score(False, str(error))


def at(point: FloatArray) -> str:
    """A point for people."""
    return f"({point[0]:.1f}, {point[1]:.1f})"


def centre(obstacle: Any) -> FloatArray:
    """Of a round obstacle."""
    return np.array([obstacle.x_pos, obstacle.y_pos], dtype=np.float64)


def unit(vector: FloatArray) -> FloatArray:
    """A vector of length one."""
    result: FloatArray = vector / max(float(np.linalg.norm(vector)), 1e-12)
    return result
