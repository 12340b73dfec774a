"""Judges of how many things stand to one another.

Their margins are how far one object may be shifted on the level until the goal is missed, m; there is none
where things are missing, or stand on the wrong height.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from proc3s import FloatArray, Plan, Score
from proc3s_tabletop.tasks.final_table import FinalTable
from proc3s_tabletop.tasks.selection import selector


def grid(
    state: Any,
    plan: Plan,
    rows: Sequence[Mapping[str, Any]],
    most_along: float,
    most_across: float,
    tolerance: float = 0.010,
    level: float = 0.003,
    bodies: Mapping[str, Any] | None = None,
) -> Score:
    """Each of `rows` is a row along x, in any order of the rows, equally long, all upright on the table.

    Centres lie within `tolerance` (m) of the mean y of their row and of the mean x of their column;
    neighbours in a row are at most `most_along` (m) apart, neighbouring rows `most_across`; lowest points
    are within `level` (m) of the table.
    """
    table = FinalTable(state, bodies)
    chosen = [table.chosen(row, f"grid.rows.{k}") for k, row in enumerate(rows)]
    names = [str(selector(row, "grid.rows")) for row in rows]
    if len({len(row) for row in chosen}) != 1 or not chosen[0]:
        return Score(False, f"the rows are not equally long: {', '.join(str(len(row)) for row in chosen)}")
    off = [s.says for row in chosen for s in row if not s.extent.upright or abs(s.extent.bottom) > level]
    if off:
        return Score(False, f"{', '.join(off)} not flat on the table")
    centres = np.array([sorted((s.x, s.y) for s in row) for row in chosen])
    return _regular(centres, names, (most_along, most_across), tolerance)


def _regular(centres: FloatArray, names: Sequence[str], most: tuple[float, float], tolerance: float) -> Score:
    """Whether centres (rows, columns, 2) form a grid."""
    in_rows = np.abs(centres[..., 1] - centres[..., 1].mean(axis=1, keepdims=True)).max(axis=1)
    in_columns = float(np.abs(centres[..., 0] - centres[..., 0].mean(axis=0)).max())
    along = float(np.diff(centres[..., 0], axis=1).max(initial=0.0))
    across = float(np.diff(np.sort(centres[..., 1].mean(axis=1))).max(initial=0.0))
    worst = int(in_rows.argmax())
    faults = [
        (in_rows[worst], tolerance, f"the row of {names[worst]} is crooked"),
        (in_columns, tolerance, "a column is crooked"),
        (along, most[0], "neighbours in a row are apart"),
        (across, most[1], "rows are apart"),
    ]
    margin = float(min(limit - value for value, limit, _ in faults))
    for value, limit, text in faults:
        if value > limit:
            return Score(False, f"{text}: {1000 * value:.0f} mm, more than {1000 * limit:.0f}", margin)
    text = f"{len(centres)} rows of {centres.shape[1]}, {1000 * along:.0f} mm by {1000 * across:.0f}"
    return Score(True, text, margin)


def ordered(
    state: Any,
    plan: Plan,
    what: Sequence[Mapping[str, Any]],
    most: float,
    tolerance: float = 0.020,
    level: float = 0.005,
    bodies: Mapping[str, Any] | None = None,
) -> Score:
    """One object each of `what` stands in a line along x, in this order as x grows, on the table.

    Centres lie within `tolerance` (m) of their mean y, neighbours at most `most` (m) apart along x; lowest
    points are within `level` (m) of the table.
    """
    table = FinalTable(state, bodies)
    chosen = [table.chosen(one, f"ordered.what.{k}") for k, one in enumerate(what)]
    if any(len(found) != 1 for found in chosen):
        return Score(False, f"there is not one object of each: {', '.join(str(len(c)) for c in chosen)}")
    things = [found[0] for found in chosen]
    if high := [s.says for s in things if abs(s.extent.bottom) > level]:
        return Score(False, f"{', '.join(high)} not on the table")
    x, y = np.array([(s.x, s.y) for s in things]).T
    steps, off = np.diff(x), float(np.abs(y - y.mean()).max())
    margin = float(min(tolerance - off, *steps, *(most - steps)))
    if (steps <= 0).any():
        k = int(steps.argmin())
        return Score(False, f"{things[k + 1].says} is not further along x than {things[k].says}", margin)
    if steps.max() > most or off > tolerance:
        text = f"neighbours are up to {1000 * steps.max():.0f} mm apart, centres up to {1000 * off:.0f} mm"
        text = f"{text} off the line; {1000 * most:.0f} and {1000 * tolerance:.0f} are allowed"
        return Score(False, text, margin)
    return Score(True, f"in order along x, centres within {1000 * off:.0f} mm of one line", margin)
