"""What is certain of a place without a simulation."""

from dataclasses import dataclass

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop import sentences
from proc3s_tabletop.constraints import UNMEASURED, collision, placement
from proc3s_tabletop.robot.settings import TABLE_BOUNDS, ReferenceSettings
from proc3s_tabletop.screens.batch import BAND, BatchScreening
from proc3s_tabletop.screens.layout import Bools, Layout, Rows
from proc3s_tabletop.screens.pick import reject_contacts
from proc3s_tabletop.telemetry import TABLE

SETTINGS = ReferenceSettings()
PLACED = 0.0003
"""How far from where it was to be set down an object may stand, m (measured: less)."""
CAUGHT = 0.012
"""What falls off one thing onto another less than this below may stay there, m."""
EDGE = 0.004
"""A middle so far beyond everything it could rest on falls, m (measured: 2 mm)."""


@dataclass(frozen=True)
class Descent:
    """Objects on their way down, of the plans `rows`: which, where to, and how high their bottoms end."""

    rows: Rows
    at: FloatArray
    """Commanded points (rows, 3)."""
    which: Rows
    goal: FloatArray
    """Where their middles would come (rows, 3)."""
    under: FloatArray
    """How deep other bodies certainly lie below them, seen from above (rows, n), m."""
    maybe: FloatArray
    """The same, where it is possible that they do."""
    tops: FloatArray
    """How high the bodies may reach there (rows, n), z in m."""

    @property
    def count(self) -> int:
        """How many."""
        return len(self.rows)

    def only(self, kept: Bools) -> "Descent":
        """Those of the plans that are kept."""
        return Descent(*(values[kept] for values in vars(self).values()))


def screen_place(screening: BatchScreening, layout: Layout, step: int, rows: Rows, at: FloatArray) -> None:
    """Reject places at points (rows, 3) that are certain to fail; note where the others' objects stand."""
    for check in (_full, _within_bounds):
        kept = check(screening, layout, step, rows, at)
        rows, at = rows[kept], at[kept]
    descent = _descent(layout, rows, at)
    for condition in (_not_too_high, _clear_of_hand, _supported, _standing):
        descent = descent.only(condition(screening, layout, step, descent))
    _stand(layout, descent)


def _full(screening: BatchScreening, layout: Layout, step: int, rows: Rows, at: FloatArray) -> Bools:
    """Whether there is something in the hand; what is unknown of it is left to the world."""
    empty: Bools = layout.held[rows] < 0
    margins = np.full(int(empty.sum()), -UNMEASURED)
    why = {"why": sentences.NOTHING_TO_SET_DOWN}
    screening.reject(step, placement, rows[empty], margins, lambda i: why)
    unknown = ~empty & ~np.isfinite(layout.slack[rows, layout.held[rows]])
    screening.leave(rows[unknown])
    kept: Bools = ~empty & ~unknown
    return kept


def _within_bounds(screening: BatchScreening, layout: Layout, step: int, rows: Rows, at: FloatArray) -> Bools:
    """Whether the commanded point lies above the table."""
    low, high = np.array(TABLE_BOUNDS).T
    inside = np.minimum(at[:, :2] - low, high - at[:, :2]).min(axis=1)
    outside: Bools = inside < 0
    why = {"why": sentences.out_of_bounds(sentences.TARGET)}
    screening.reject(step, placement, rows[outside], inside[outside], lambda i: why)
    return ~outside


def _descent(layout: Layout, rows: Rows, at: FloatArray) -> Descent:
    which = layout.held[rows]
    goal = at + layout.offset[rows]
    spare = BAND + layout.slack[rows] + layout.slack[rows, which][:, None]
    under = layout.beside(rows, which, goal, layout.bodies.inner) - spare
    maybe = layout.beside(rows, which, goal, layout.bodies.outer) + spare
    return Descent(rows, at, which, goal, under, maybe, layout.tops(rows, which, goal, spare))


def _bottom(layout: Layout, descent: Descent) -> FloatArray:
    """Height of their bottoms at the commanded z."""
    bottom: FloatArray = descent.goal[:, 2] - layout.bodies.outer[descent.which, 2]
    return bottom


def _highest(descent: Descent, depth: FloatArray) -> FloatArray:
    """The highest top of the bodies with a positive depth and of the table, shape (rows,)."""
    tops: FloatArray = np.where(depth > 0, descent.tops, 0.0)
    highest: FloatArray = tops.max(axis=1, initial=0.0)
    return highest


def _not_too_high(screening: BatchScreening, layout: Layout, step: int, descent: Descent) -> Bools:
    """Whether nothing stands in the way well above the commanded z."""
    limit = screening.args(collision).get("highest", np.inf)
    tops = np.where(descent.under > 0, descent.tops, -np.inf)
    over = tops.max(axis=1, initial=-np.inf) - _bottom(layout, descent) - limit - BAND
    blocked: Bools = over > 0
    names, which = layout.bodies.names, tops[blocked].argmax(axis=1) if blocked.any() else []
    own = descent.which[blocked]

    def met(i: int) -> dict[str, str]:
        held, other = screening.called(names[own[i]]), screening.called(names[which[i]])
        return sentences.collides(sentences.in_hand(held), other, sentences.MET_TOO_EARLY)

    screening.reject(step, collision, descent.rows[blocked], -over[blocked], met)
    return ~blocked


def _clear_of_hand(screening: BatchScreening, layout: Layout, step: int, descent: Descent) -> Bools:
    """Whether there is room for the fingers around the object, closed and then open."""
    # To stand on what rises above the limit would be no better.
    limit = screening.args(collision).get("highest", np.inf)
    bottom = _bottom(layout, descent)
    low = np.where(descent.tops < (bottom + limit + BAND)[:, None], descent.maybe, -np.inf)
    rise = np.maximum(_highest(descent, low) - bottom, 0.0)
    at = descent.at + np.stack([0 * rise, 0 * rise, rise], axis=1)
    free = np.ones(descent.count, bool)
    for margin, stage in ((0.0, "descent"), (2 * SETTINGS.open_margin, "release")):
        for k in np.unique(descent.which[free]):
            mine = np.flatnonzero(free & (descent.which == k))
            gap = 2 * layout.bodies.outer[k, 1] + margin
            depth = (
                layout.met(descent.rows[mine], at[mine], screening.hand.columns(gap), SETTINGS.hover) - BAND
            )
            hit = depth.max(axis=1, initial=-np.inf) > 0
            free[mine[hit]] = False
            reject_contacts(screening, layout, step, descent.rows[mine[hit]], depth[hit], stage)
    return free


def _supported(screening: BatchScreening, layout: Layout, step: int, descent: Descent) -> Bools:
    """Whether there is something to stand on not far below."""
    lowest = screening.args(placement).get("lowest", np.inf)
    tops = np.where(descent.maybe > 0, descent.tops, -np.inf)
    drop = _bottom(layout, descent) - _highest(descent, descent.maybe) - lowest - BAND
    high: Bools = drop > 0
    names, own = layout.bodies.names, descent.which[high]
    below = np.hstack([np.zeros((len(drop), 1)), tops])[high].argmax(axis=1)
    on = [(TABLE, *names)[k] for k in below]

    def why(i: int) -> dict[str, str]:
        return {"why": sentences.drops(screening.called(names[own[i]]), screening.called(on[i]))}

    screening.reject(step, placement, descent.rows[high], -drop[high], why)
    return ~high


def _standing(screening: BatchScreening, layout: Layout, step: int, descent: Descent) -> Bools:
    """Whether the middle may lie above what the object could rest on."""
    beyond = _beyond(layout, descent) - EDGE
    beyond[~layout.bodies.flat[descent.which]] = -np.inf
    falls: Bools = beyond > 0
    names, own = layout.bodies.names, descent.which[falls]

    def why(i: int) -> dict[str, str]:
        return {"why": sentences.does_not_stay(screening.called(names[own[i]]))}

    screening.reject(step, placement, descent.rows[falls], -beyond[falls], why)
    return ~falls


def _beyond(layout: Layout, descent: Descent) -> FloatArray:
    """How far the middle lies outside the box around all that the object could rest on, seen from above."""
    rows, goal = descent.rows, descent.goal
    highest = _highest(descent, descent.under)
    carries = (descent.maybe > 0) & (descent.tops > highest[:, None] - CAUGHT)
    spare = layout.bodies.outer[:, :2] + (layout.slack[rows] + BAND)[..., None]
    middles = layout.centres[rows, :, :2]
    low = np.where(carries[..., None], middles - spare, np.inf).min(axis=1, initial=np.inf)
    high = np.where(carries[..., None], middles + spare, -np.inf).max(axis=1, initial=-np.inf)
    beyond = np.maximum(low - goal[:, :2], goal[:, :2] - high).max(axis=1)
    # The table is everywhere.
    outside: FloatArray = np.where(highest < CAUGHT, -np.inf, beyond)
    return outside


def _stand(layout: Layout, descent: Descent) -> None:
    """The objects stand; on what is not flat or not certain to lie below, only a simulation tells where."""
    rows, which = descent.rows, descent.which
    certain, possible = (_highest(descent, depth) for depth in (descent.under, descent.maybe))
    odd = ((descent.maybe > 0) & ~layout.bodies.flat).any(axis=1) | (certain < possible)
    goal = descent.goal.copy()
    goal[:, 2] = possible + layout.bodies.outer[which, 2]
    layout.centres[rows, which] = goal
    layout.slack[rows, which] = np.where(odd, np.inf, layout.slack[rows, which] + PLACED)
    layout.held[rows] = -1
