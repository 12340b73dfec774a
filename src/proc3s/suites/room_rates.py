"""How often plans hold by their room: made on the even seeds, and checked on the odd ones."""

from bisect import bisect
from collections.abc import Sequence
from dataclasses import dataclass, replace

import matplotlib as mpl
from matplotlib.figure import Figure

from proc3s.benchmark.execution_test import FieldTest
from proc3s.reporting.charts import STYLE, colors_of, svg
from proc3s.suites.hold_rates import ALL, HoldRate, draw
from proc3s.suites.statistics import Estimate

ROOMS = (0.5, 1.0, 2.0, 3.0)
"""Ends of the intervals of room that are told apart."""


@dataclass(frozen=True)
class RoomRate(HoldRate):
    """The field tests of plans whose room is in the interval number `k`, in an engine, with an error."""

    k: int = 0

    @property
    def room(self) -> str:
        """The interval in words."""
        return _interval(self.k)

    def of_seeds(self, odd: bool) -> "RoomRate":
        """Those of the odd seeds, or of the even ones."""
        return replace(self, tests=tuple(test for test in self.tests if test.seed % 2 == odd))


def room_rates(done: Sequence[FieldTest]) -> list[RoomRate]:
    """One for every interval, engine and error; without plans of which no room is known.

    A first plan that was not improved is in the tests twice, and counts once.
    """
    groups: dict[tuple[int, str | None, float | None], list[FieldTest]] = {}
    once = {(t.case, t.run, t.seed, t.room, t.engine, t.error_mm): t for t in done if t.solved}
    for test in once.values():
        if test.room is not None:
            groups.setdefault((bisect(ROOMS, test.room), test.engine, test.error_mm), []).append(test)
    keys = sorted(groups, key=lambda key: (key[0], key[1] or "", key[2] or 0.0))
    return [RoomRate(ALL, 0, 0, e, mm, tuple(groups[k, e, mm]), k) for k, e, mm in keys]


def room_chart(rates: Sequence[RoomRate]) -> str | None:
    """Hold rates over the room as SVG: for each engine and error a line for the even seeds, and hollow points
    for the odd ones. None where no plan was carried out.
    """
    lines: dict[str, list[RoomRate]] = {}
    for one in rates:
        if one.times:
            lines.setdefault(_label(one), []).append(one)
    if not lines:
        return None
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.2, 3.6), layout="constrained")
        axes = figure.subplots()
        for i, (name, color) in enumerate(colors_of([*lines]).items()):
            aside = 2 * i - len(lines) + 0.5
            draw(axes, _points(lines[name], odd=False), f"{name} even seeds", color, aside)
            hollow = {"linestyle": "none", "markerfacecolor": "white"}
            draw(axes, _points(lines[name], odd=True), f"{name} odd seeds", color, aside + 1, **hollow)
        axes.set_ylim(0, 104)
        axes.set_xticks(range(len(ROOMS) + 1), [_interval(k) for k in range(len(ROOMS) + 1)])
        axes.set_xlabel("room of the plan, expected errors")
        axes.set_ylabel("% that reach the goal, 95 % intervals")
        figure.legend(frameon=False, fontsize=8, loc="outside upper center", ncols=2)
        return svg(figure)


def _label(one: RoomRate) -> str:
    error = "" if one.error_mm is None else f"{one.error_mm:g} mm,"
    return " ".join(part for part in (one.engine, error) if part)


def _points(rates: Sequence[RoomRate], odd: bool) -> list[tuple[float, Estimate]]:
    return [(one.k, rate) for one in rates if (rate := one.of_seeds(odd).rate)]


def _interval(k: int) -> str:
    if k == len(ROOMS):
        return f"{ROOMS[-1]:g} and more"
    return f"{ROOMS[k - 1] if k else 0:g} to {ROOMS[k]:g}"
