"""The canvas in numpy: what the world would say of a whole batch of drawings, without a step in it."""

import itertools
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from proc3s import Domain, FloatArray, PlanBatch, State, Violation, sentence
from proc3s_drawing.world import CANVAS_SIZE, CLEARANCE, clear_of_obstacles, draw_line, inside

Verdicts: TypeAlias = list[Violation | None]

RULES = [inside, clear_of_obstacles]
"""What is foreseen of a line, in the order in which the first violation is found."""
_BAND = 1e-6
"""Nearer to the edge of an obstacle than this the world decides: for lines shorter than 1e-5 its own
arithmetic is not better."""
_PAIRS = 1 << 15
"""Pairs of lines and obstacles that are looked at together: their arrays stay in the processor's cache."""
_STEPS = (0, 1, 3, np.inf)
"""The steps of a plan are looked at in these groups."""
_POINT = 1e-30
"""A line whose squared length is smaller is a point."""


def segments_clear(state: State, batch: PlanBatch, domain: Domain) -> Verdicts:
    """The first violation that the canvas would report for each plan, and None for a plan without one.

    None too where the world must decide: within 1e-6 canvas units of the edge of an obstacle, behind an
    action that draws no line, and in a domain with other constraints than the canvas's own two.
    """
    if list(domain.margins.values()) != RULES:
        return [None] * len(batch)
    with np.errstate(invalid="ignore", over="ignore"):  # samples without a legal plan may hold any number
        return _Obstacles(state, domain).verdicts(batch)


class _Obstacles:
    """Centres and radii of the inflated discs of a state, and the texts of the violations."""

    def __init__(self, state: State, domain: Domain) -> None:
        within, clear = domain.spec.constraints.values()
        self._domain = domain
        obstacles: tuple[Any, ...] = getattr(state, "obstacles")  # noqa: B009 - a field of the spec
        self._x = np.array([o.x_pos for o in obstacles], np.float64)
        self._y = np.array([o.y_pos for o in obstacles], np.float64)
        self._radius = np.array([o.radius + CLEARANCE for o in obstacles], np.float64)
        self._least_inside = -within.tolerance
        self._least_clear = -clear.tolerance
        self._reasons = [(within.name, sentence(within, {"axis": axis})) for axis in "xy"]
        self._reasons += [(clear.name, sentence(clear, {"obstacle": o.name})) for o in obstacles]

    def verdicts(self, batch: PlanBatch) -> Verdicts:
        """One for each plan of the batch."""
        found: Verdicts = [None] * len(batch)
        lines, drawn = _lines(batch, self._domain)
        within, axis = _inside(lines)
        outside = within < self._least_inside
        plans, actions = _first(self._near(lines, outside | ~drawn, batch.start), batch.start)
        reason, margin = axis[actions], within[actions]
        hit = ~outside[actions]
        reason[hit], margin[hit], sure = self._touched(lines[actions[hit]])
        certain = drawn[actions]
        certain[hit] &= sure
        columns = (plans, actions - batch.start[plans], batch.skill[actions], reason, margin)
        for i, step, skill, k, value in zip(*(column[certain].tolist() for column in columns), strict=True):
            constraint, text = self._reasons[k]
            found[i] = Violation(constraint, step, batch.signatures[skill].skill, value, text)
        return found

    def _near(
        self, lines: FloatArray, stops: NDArray[np.bool_], start: NDArray[np.int64]
    ) -> NDArray[np.bool_]:
        """`stops`, and the lines, shape (n, 4), that may touch an obstacle; of each plan at least the first.

        Few plans of a crowded canvas are legal, so the lines behind a stop are not looked at.
        """
        if not len(self._x):
            return stops
        near = stops.copy()
        plan = np.repeat(np.arange(len(start) - 1), np.diff(start))
        step = np.arange(len(lines)) - start[plan]
        standing = np.ones(len(start) - 1, bool)
        for low, high in itertools.pairwise(_STEPS):
            rows = np.flatnonzero((step >= low) & (step < high) & standing[plan])
            near[rows] |= self._reached(lines[rows])
            standing[plan[rows[near[rows]]]] = False
        return near

    def _reached(self, lines: FloatArray) -> NDArray[np.bool_]:
        """Whether each line may touch an obstacle: none that does is missed."""
        reach2 = np.maximum(self._radius + self._least_clear + _BAND, 0.0)[:, None] ** 2
        size = max(1, _PAIRS // len(self._x))
        parts = [lines[at : at + size] for at in range(0, len(lines), size)]
        found = [(self._squared_distances(part) < reach2).any(axis=0) for part in parts]
        return np.concatenate(found) if found else np.zeros(0, bool)

    def _touched(self, lines: FloatArray) -> tuple[NDArray[np.int64], FloatArray, NDArray[np.bool_]]:
        """Of each line: the reason why it is refused, its clearance, and whether both are beyond doubt."""
        if not len(lines):
            return np.empty(0, np.int64), np.empty(0), np.empty(0, bool)
        clearance = np.sqrt(self._squared_distances(lines)) - self._radius[:, None]
        nearest = clearance.argmin(axis=0)
        margin = clearance[nearest, np.arange(len(lines))]
        rivals = (clearance < margin + _BAND).sum(axis=0)
        return nearest + 2, margin, (margin < self._least_clear - _BAND) & (rivals == 1)

    def _squared_distances(self, lines: FloatArray) -> FloatArray:
        """From the centre of every obstacle to every line, shape (obstacles, lines)."""
        x, y = lines[:, 0], lines[:, 1]
        along_x, along_y = lines[:, 2] - x, lines[:, 3] - y
        length2 = along_x * along_x + along_y * along_y
        inverse = np.divide(1.0, length2, out=np.zeros_like(length2), where=length2 > _POINT)
        dx, dy = self._x[:, None] - x, self._y[:, None] - y
        t = dx * (along_x * inverse)
        t += dy * (along_y * inverse)
        np.minimum(np.maximum(t, 0.0, out=t), 1.0, out=t)
        dx -= t * along_x
        dy -= np.multiply(t, along_y, out=t)
        dx *= dx
        dy *= dy
        dx += dy
        return dx


def _lines(batch: PlanBatch, domain: Domain) -> tuple[FloatArray, NDArray[np.bool_]]:
    """The line of every action, shape (n, 4), and whether it draws one; if not, the line is a point."""
    drawing = [domain.skill(s.skill) is draw_line and s.width == 4 for s in batch.signatures]
    drawn = np.array(drawing, bool)[batch.skill]
    if drawn.all():
        return batch.values.reshape(-1, 4), drawn
    lines = np.zeros((len(drawn), 4))
    lines[drawn] = batch.values[batch.offset[:-1][drawn, None] + np.arange(4)]
    return lines, drawn


def _inside(lines: FloatArray) -> tuple[FloatArray, NDArray[np.int64]]:
    """Distance of the end points from the border, and the axis along which it is that, 0 or 1."""
    ends = np.minimum(lines, CANVAS_SIZE - lines)
    by_x, by_y = np.minimum(ends[:, 0], ends[:, 2]), np.minimum(ends[:, 1], ends[:, 3])
    return np.minimum(by_x, by_y), (by_y < by_x).astype(np.int64)


def _first(
    marked: NDArray[np.bool_], start: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The plans with a marked action, and the first such action of each."""
    actions = np.flatnonzero(marked)
    place = np.searchsorted(actions, start)
    plans = np.flatnonzero(place[:-1] < place[1:])
    return plans, actions[place[plans]]
