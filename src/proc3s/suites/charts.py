"""Charts of a suite as SVG texts."""

from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from proc3s.reporting.charts import ACCEPTED, STYLE, colors_of, svg
from proc3s.suites.results import Result, Results
from proc3s.suites.statistics import wilson
from proc3s.suites.tables import rate_of


def success_bars(results: Results) -> str | None:
    """Success rate of every method over all tasks with Wilson's interval; None where there is no rate."""
    rates = {results.label(line): rate_of(results.of(line)) for line in results.lines}
    shares = {name: wilson(*rate) for name, rate in rates.items() if not isinstance(rate, str)}
    if not shares:
        return None
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.2, 0.8 + 0.34 * len(shares)), layout="constrained")
        axes = figure.subplots()
        for k, share in enumerate(shares.values()):
            away = [[100 * (share.value - share.low)], [100 * (share.high - share.value)]]
            axes.barh(k, 100 * share.value, xerr=away, color=ACCEPTED, ecolor="#3c4454", capsize=3)
        axes.set_yticks(range(len(shares)), list(shares))
        axes.invert_yaxis()
        axes.set_xlim(0, 100)
        axes.set_xlabel("% of the episodes of all tasks, with Wilson's 95 % interval")
        return svg(figure)


def curves(results: Results) -> str | None:
    """The share of episodes that are solved after so many samples; None where none was searched."""
    lines = {results.label(line): _searched(results.of(line)) for line in results.lines}
    lines = {name: some for name, some in lines.items() if some}
    if not lines:
        return None
    most = max(r.episode.samples for some in lines.values() for r in some)
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.2, 3.2), layout="constrained")
        axes = figure.subplots()
        for (name, some), color in zip(lines.items(), colors_of([*lines]).values(), strict=True):
            taken = np.sort([r.episode.samples for r in some if r.episode.solved])
            share = 100 * np.arange(len(taken) + 1) / len(some)
            axes.step([0.9, *taken, most], [*share, share[-1]], where="post", color=color, label=name)
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}"))
        axes.set_ylim(0, 102)
        axes.set_xlabel("samples")
        axes.set_ylabel("% of the episodes solved")
        axes.legend(frameon=False, fontsize=8)
        return svg(figure)


def _searched(results: Sequence[Result]) -> list[Result]:
    """Those in which samples were drawn."""
    return [r for r in results if r.episode.samples > 0]
