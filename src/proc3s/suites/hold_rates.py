"""How often plans hold: counts of field tests with Wilson's intervals, as rows and as a chart."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from proc3s.benchmark.execution_test import FieldTest
from proc3s.reporting.charts import STYLE, colors_of, svg
from proc3s.suites.statistics import Estimate, wilson
from proc3s.wording import count

ALL = "all"


@dataclass(frozen=True)
class HoldRate:
    """The field tests of a program (or all), rehearsed and improved so much, in an engine, with an error."""

    program: str
    rehearsals: int
    improve: int
    engine: str | None
    error_mm: float | None
    tests: tuple[FieldTest, ...]

    @property
    def plans(self) -> int:
        """Searches that found a plan."""
        return sum(test.solved for test in self.tests)

    @property
    def samples(self) -> int:
        """Of all searches."""
        return sum(test.samples for test in self.tests)

    @property
    def times(self) -> int:
        """How often plans were carried out."""
        return sum(test.times for test in self.tests)

    @property
    def held(self) -> int:
        """How often the judge was satisfied."""
        return sum(test.satisfied for test in self.tests)

    @property
    def rate(self) -> Estimate | None:
        """The share that held with Wilson's 95 % interval; None where nothing was carried out."""
        return wilson(self.held, self.times) if self.times else None


def hold_rates(done: Sequence[FieldTest]) -> list[HoldRate]:
    """One for every program, way of searching, engine and error, and one for all programs together."""
    of_programs = _grouped((test.case, test) for test in done)
    return [*of_programs, *_grouped((ALL, test) for test in done)]


def _grouped(named: Iterable[tuple[str, FieldTest]]) -> list[HoldRate]:
    groups: dict[tuple[str, int, int, str | None, float | None], list[FieldTest]] = {}
    for name, test in named:
        key = (name, test.robust, test.improve, test.engine, test.error_mm)
        groups.setdefault(key, []).append(test)
    return [HoldRate(*key, tuple(tests)) for key, tests in groups.items()]


def chart(rates: Sequence[HoldRate]) -> str | None:
    """Hold rates of all programs over the error as SVG, a line for each engine and number of rehearsals.

    None where no error was given, or no plan carried out.
    """
    lines: dict[str, list[tuple[float, Estimate]]] = {}
    for one in rates:
        if one.program == ALL and one.error_mm is not None and one.rate:
            lines.setdefault(_label(one), []).append((one.error_mm, one.rate))
    if not lines:
        return None
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.2, 3.4), layout="constrained")
        axes = figure.subplots()
        for k, (name, color) in enumerate(colors_of([*lines]).items()):
            draw(axes, sorted(lines[name]), name, color, k - (len(lines) - 1) / 2)
        axes.set_ylim(0, 104)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.set_xlabel("largest error of stands and placements, mm (and half as many degrees)")
        axes.set_ylabel("% that reach the goal, 95 % intervals")
        figure.legend(frameon=False, fontsize=8, loc="outside upper center", ncols=2)
        return svg(figure)


def _label(one: HoldRate) -> str:
    rehearsed = count(one.rehearsals, "rehearsal") if one.rehearsals else "no rehearsals"
    improved = f"{count(one.improve, 'sample')} for room" if one.improve else None
    parts = [one.engine, rehearsed, improved, count(one.plans, "plan")]
    return ", ".join(part for part in parts if part)


def draw(
    axes: Axes, points: list[tuple[float, Estimate]], name: str, color: str, aside: float, **style: Any
) -> None:
    """A line with its intervals, a little aside, so that those of several lines can be told apart."""
    if not points:
        return
    apart = 0.012 * max(at for at, _ in points)
    x = [at + aside * apart for at, _ in points]
    y = [100 * rate.value for _, rate in points]
    away = [[100 * (r.value - r.low) for _, r in points], [100 * (r.high - r.value) for _, r in points]]
    looks = {"color": color, "label": name, "marker": "o", "markersize": 4, "capsize": 3, "linewidth": 1.2}
    axes.errorbar(x, y, yerr=away, **{**looks, **style})
