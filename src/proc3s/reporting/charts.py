"""Charts of a report as SVG texts that need nothing from outside, drawn by matplotlib."""

import io
import math
import re
from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from proc3s.reporting.history import ProgramRecord
from proc3s.reporting.trials import Samples, StepReport

STYLE: dict[Any, Any] = {
    "font.size": 9.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#98a0ae",
    "axes.labelcolor": "#3c4454",
    "xtick.color": "#5a6373",
    "ytick.color": "#5a6373",
    "text.parse_math": False,  # names come from programs
    "svg.hashsalt": "proc3s",
    "svg.fonttype": "path",
}
"""How all charts look, for `matplotlib.rc_context`."""
_COLORS = ("#d55e00", "#0072b2", "#cc79a7", "#e69f00", "#56b4e9", "#7a5cc4", "#8c564b", "#666666")
ACCEPTED = "#009e73"
"""Colour of what the world accepted."""
_WIDEST = 4
_MOST = 24
"""Parameters that are drawn; a program may have any number."""
_NUMBER = r"(-?\d+(?:\.\d+)?(?:e[-+]?\d+)?)"
_BOUNDS = re.compile(rf"^ContinuousSampler\(min={_NUMBER}, max={_NUMBER}\)$")


def colors_of(names: Sequence[str]) -> dict[str, str]:
    """A color for each constraint and kind of error, the same on a whole page."""
    return {name: _COLORS[i % len(_COLORS)] for i, name in enumerate(names)}


def by_parameter(program: ProgramRecord, colors: Mapping[str, str]) -> str | None:
    """A plot for each open parameter: its values against the step that samples reached.

    None where nothing was sampled.
    """
    columns = _columns(program)[:_MOST]
    if not columns or not program.samples.u:
        return None
    with mpl.rc_context(STYLE):
        wide = min(_WIDEST, len(columns))
        rows = math.ceil(len(columns) / wide)
        figure = Figure(figsize=(2.5 * wide, 2.1 * rows), layout="constrained")
        grid = figure.subplots(rows, wide, squeeze=False, sharey=True)
        for axes, column in zip(grid.flat, columns, strict=False):
            _draw(axes, program.samples, column, colors)
        for axes in grid.flat[len(columns) :]:
            axes.set_visible(False)
        for row in grid:
            row[0].set_ylabel("steps carried out")
        return svg(figure)


def _columns(program: ProgramRecord) -> list[tuple[str, int, float, float]]:
    """(label, column of u, least value, greatest value) of every dimension that is searched.

    Where the sampler is not one between bounds, u itself is drawn, from 0 to 1.
    """
    width = len(program.samples.u[0]) if program.samples.u else 0
    dims = program.dims or dict.fromkeys(program.parameters, 1)
    if sum(dims.values()) != width:  # an earlier version's log does not say which columns are whose
        return [(f"dimension {i}", i, 0.0, 1.0) for i in range(width)]
    found: list[tuple[str, int, float, float]] = []
    for name, dim in dims.items():
        bounds = _bounds(program.parameters.get(name, "")) if dim == 1 else None
        low, high = bounds or (0.0, 1.0)
        labels = [name if bounds else f"{name} (u)"] if dim == 1 else [f"{name} (u{i})" for i in range(dim)]
        found += [(label, len(found) + i, low, high) for i, label in enumerate(labels)]
    return found


def _bounds(sampler: str) -> tuple[float, float] | None:
    """What u = 0 and u = 1 stand for, as far as the sampler's text says it."""
    found = _BOUNDS.search(sampler)
    return (float(found[1]), float(found[2])) if found else None


def _draw(
    axes: Axes, samples: Samples, column: tuple[str, int, float, float], colors: Mapping[str, str]
) -> None:
    name, at, low, high = column
    u = np.array(samples.u)[:, at]
    x = low * (1 - u) + high * u
    # Samples that reached the same step lie beside each other: those with another number a little higher.
    y = np.array(samples.reached) + 0.7 * ((np.arange(len(u)) * 0.618034) % 1) - 0.35
    accepted = np.array(samples.accepted)
    kinds = np.array([kind or "" for kind in samples.violation])
    for kind, color in colors.items():
        here = (kinds == kind) & ~accepted
        axes.scatter(x[here], y[here], s=6, color=color, alpha=0.55, linewidths=0, rasterized=True)
    axes.scatter(x[accepted], y[accepted], s=90, marker="*", color=ACCEPTED, zorder=3)
    axes.set_xlabel(name[:40])
    margin = 0.03 * (high - low) or 0.5  # a sampler may allow one value only
    axes.set_xlim(low - margin, high + margin)
    axes.set_ylim(min(samples.reached) - 0.5, max(samples.reached) + 0.5)
    axes.yaxis.set_major_locator(MaxNLocator(integer=True, nbins=6, min_n_ticks=1))


def by_step(steps: Sequence[StepReport], colors: Mapping[str, str]) -> str | None:
    """Bars of the samples that failed at each step, stacked by constraint; None if none did at a step."""
    at_steps = [report for report in steps if report.step is not None]
    if not at_steps:
        return None
    numbers = sorted({report.step for report in at_steps if report.step is not None})
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.2, 0.7 + 0.32 * len(numbers)), layout="constrained")
        axes = figure.subplots()
        ends = dict.fromkeys(numbers, 0.0)
        for report in at_steps:
            assert report.step is not None
            color = colors.get(report.constraint, _COLORS[-1])
            axes.barh(numbers.index(report.step), report.share, left=ends[report.step], color=color)
            ends[report.step] += report.share
        axes.set_yticks(range(len(numbers)), [_step_name(number, at_steps) for number in numbers])
        axes.invert_yaxis()
        axes.set_xlabel("% of the samples")
        return svg(figure)


def _step_name(step: int, reports: Sequence[StepReport]) -> str:
    skill = next((report.skill for report in reports if report.step == step and report.skill), "")
    return f"{step}  {skill[:40]}".rstrip()


def svg(figure: Figure) -> str:
    """A figure as an SVG text, the same for the same figure."""
    stream = io.StringIO()
    figure.savefig(stream, format="svg", transparent=True, dpi=150, metadata={"Date": None})
    return stream.getvalue()
