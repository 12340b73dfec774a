"""What is certain of a pick without a simulation."""

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop import sentences
from proc3s_tabletop.constraints import PAD_WIDTH, UNMEASURED, collision, grasp
from proc3s_tabletop.robot.hand_profile import GAPS, WIDEST
from proc3s_tabletop.robot.settings import INSIDE, ReferenceSettings
from proc3s_tabletop.screens.batch import BAND, BatchScreening
from proc3s_tabletop.screens.layout import Bools, Layout, Rows
from proc3s_tabletop.telemetry import TABLE

SETTINGS = ReferenceSettings()
OPEN = max(GAPS)
"""Distance of the pads of the open hand, m."""

HAND = "gripper"


def screen_pick(screening: BatchScreening, layout: Layout, step: int, rows: Rows, at: FloatArray) -> None:
    """Reject picks at points (rows, 3) that are certain to fail; note what the others hold."""
    for check in (_empty, _free_way_down, _free_table):
        kept = check(screening, layout, step, rows, at)
        rows, at = rows[kept], at[kept]
    target = _between(screening, layout, step, rows, at)
    kept = target >= 0
    rows, at, target = rows[kept], at[kept], target[kept]
    kept = _free_way_up(screening, layout, step, rows, target)
    _hold(layout, rows[kept], at[kept], target[kept])


def _empty(screening: BatchScreening, layout: Layout, step: int, rows: Rows, at: FloatArray) -> Bools:
    """Whether the hand has nothing yet."""
    full: Bools = layout.held[rows] >= 0
    names = [layout.bodies.names[k] for k in layout.held[rows[full]]]
    margins = np.full(len(names), -UNMEASURED)
    screening.reject(
        step,
        grasp,
        rows[full],
        margins,
        lambda i: {"why": sentences.holds_already(screening.called(names[i]))},
    )
    return ~full


def _free_way_down(screening: BatchScreening, layout: Layout, step: int, rows: Rows, at: FloatArray) -> Bools:
    """Whether the open hand may come down beside everything."""
    depth = layout.met(rows, at, screening.hand.columns(OPEN), SETTINGS.hover) - BAND
    met: Bools = depth.max(axis=1, initial=-np.inf) > 0
    if met.any():
        _reject_ways_down(screening, layout, step, rows[met], at[met], depth[met])
    return ~met


def _reject_ways_down(
    screening: BatchScreening, layout: Layout, step: int, rows: Rows, at: FloatArray, depth: FloatArray
) -> None:
    """To come down on the body nearest to the point is a bad grasp, on any other a collision."""
    away = np.linalg.norm(layout.centres[rows] - at[:, None], axis=2)
    meant: Bools = depth.argmax(axis=1) == away.argmin(axis=1)
    _reject_on_target(screening, layout, step, rows[meant], at[meant], depth[meant])
    reject_contacts(screening, layout, step, rows[~meant], depth[~meant], "approach")


def _reject_on_target(
    screening: BatchScreening, layout: Layout, step: int, rows: Rows, at: FloatArray, depth: FloatArray
) -> None:
    """Fingers that come down on the body they are to grasp, since they are off, or it is too wide."""
    target = depth.argmax(axis=1)
    wide = _too_wide(layout, rows, at)[target, np.arange(len(rows))]

    def why(i: int) -> dict[str, str]:
        what = screening.called(layout.bodies.names[target[i]])
        return {"why": sentences.too_wide(what, WIDEST) if wide[i] else sentences.comes_down_on(what)}

    screening.reject(step, grasp, rows, -depth.max(axis=1), why)


def reject_contacts(
    screening: BatchScreening, layout: Layout, step: int, rows: Rows, depth: FloatArray, stage: str
) -> None:
    """The hand against the body that it meets most, by depths (rows, n) in m."""
    names = [layout.bodies.names[k] for k in depth.argmax(axis=1)]

    def contact(i: int) -> dict[str, str]:
        return _touching(screening, screening.called(HAND), names[i], stage)

    screening.reject(step, collision, rows, -depth.max(axis=1), contact)


def _free_table(screening: BatchScreening, layout: Layout, step: int, rows: Rows, at: FloatArray) -> Bools:
    """Whether the tips of the open hand may stay above the table."""
    height = at[:, 2] + screening.hand.columns(OPEN)[:, 3].min() + BAND
    low: Bools = height < 0
    screening.reject(
        step,
        collision,
        rows[low],
        height[low],
        lambda i: _touching(screening, screening.called(HAND), TABLE, "approach"),
    )
    return ~low


def _too_wide(layout: Layout, rows: Rows, at: FloatArray) -> Bools:
    """Which bodies are too wide for the hand at points (rows, 3): shape (n, rows)."""
    count = len(layout.bodies.names)
    found = [layout.bodies.too_wide(k, layout.centres[rows, k], at) for k in range(count)]
    return np.array(found, bool).reshape(count, len(rows))


def _touching(screening: BatchScreening, body: str, other: str, stage: str) -> dict[str, str]:
    """The details of a collision."""
    return sentences.collides(body, screening.called(other), sentences.COLLISIONS[stage])


def _between(screening: BatchScreening, layout: Layout, step: int, rows: Rows, at: FloatArray) -> Rows:
    """The number of the body between the fingers, shape (rows,); -1 where the plan is looked at no more."""
    spare = BAND + layout.slack[rows]
    most, likely = _cover(layout, rows, at, spare), _cover(layout, rows, at, np.zeros_like(spare))
    least = SETTINGS.min_cover
    poor = most.max(axis=1, initial=0.0) < least
    _reject_grasps(screening, layout, step, rows[poor], at[poor], most[poor])
    target = likely.argmax(axis=1)
    index = np.arange(len(rows))
    best = likely[index, target]
    most[index, target] = 0.0
    sure = ~poor & (best >= least) & (most.max(axis=1, initial=0.0) < best)
    screening.leave(rows[~sure])
    return np.where(sure, target, -1)


def _cover(layout: Layout, rows: Rows, at: FloatArray, spare: FloatArray) -> FloatArray:
    """The share of the grid of rays between the pads that meets the box around every body, shape (rows, n);
    `spare` (rows, n) widens the boxes."""
    away = np.abs(layout.centres[rows] - at[:, None])
    signed = layout.centres[rows] - at[:, None]
    half = layout.bodies.outer + spare[..., None]
    across = np.abs(signed[..., 0, None] - SETTINGS.cover_across) <= half[..., 0, None]
    along = np.abs(signed[..., 2, None] + SETTINGS.cover_along) <= half[..., 2, None]
    inside = away[..., 1] <= half[..., 1] + OPEN / 2 * INSIDE
    share: FloatArray = across.mean(axis=2) * along.mean(axis=2) * inside
    return share


def _reject_grasps(
    screening: BatchScreening, layout: Layout, step: int, rows: Rows, at: FloatArray, cover: FloatArray
) -> None:
    """Too little between the fingers, or nothing at all."""
    away = np.linalg.norm(layout.centres[rows] - at[:, None], axis=2)
    names, least = layout.bodies.names, SETTINGS.min_cover * PAD_WIDTH
    best, wide = cover.max(axis=1, initial=0.0), _too_wide(layout, rows, at)
    margins = np.where(best > 0, (best - SETTINGS.min_cover) * PAD_WIDTH, -away.min(axis=1, initial=least))
    margins = np.minimum(margins, -UNMEASURED)

    def why(i: int) -> dict[str, str]:
        if wide[:, i].any():
            return {"why": sentences.too_wide(screening.called(names[int(wide[:, i].argmax())]), WIDEST)}
        if best[i] > 0:
            return {"why": sentences.too_little(screening.called(names[int(cover[i].argmax())]))}
        return {"why": sentences.nothing_between(screening.called(names[int(away[i].argmin())]))}

    screening.reject(step, grasp, rows, margins, why)


def _free_way_up(screening: BatchScreening, layout: Layout, step: int, rows: Rows, target: Rows) -> Bools:
    """Whether nothing lies above what is lifted."""
    where = layout.centres[rows, target]
    depth = layout.beside(rows, target, where, layout.bodies.inner) - BAND
    depth -= layout.slack[rows] + layout.slack[rows, target][:, None]
    bottoms = layout.centres[rows, :, 2] - layout.bodies.outer[:, 2]
    top = (where[:, 2] + layout.bodies.outer[target, 2])[:, None]
    depth[(bottoms < top - 2 * BAND) | (bottoms > top + SETTINGS.hover - SETTINGS.lift_off)] = -np.inf
    buried: Bools = depth.max(axis=1, initial=-np.inf) > 0
    above = depth[buried].argmax(axis=1)
    names, own = layout.bodies.names, target[buried]
    screening.reject(
        step,
        collision,
        rows[buried],
        -depth[buried].max(axis=1, initial=0.0),
        lambda i: _touching(
            screening, sentences.in_hand(screening.called(names[own[i]])), names[above[i]], "carry"
        ),
    )
    return ~buried


def _hold(layout: Layout, rows: Rows, at: FloatArray, target: Rows) -> None:
    """The fingers centre what they close on."""
    layout.held[rows] = target
    layout.offset[rows] = layout.centres[rows, target] - at
    layout.offset[rows, 1] = 0.0
    layout.slack[rows, target] = np.where(layout.bodies.flat[target], layout.slack[rows, target], np.inf)
