"""What a person sees of a suite: successes as they come, the time left, what it costs; then the results."""

import sys
import time
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType

from rich.console import Console, Group
from rich.live import Live
from rich.markup import escape
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
from rich.table import Table as RichTable

from proc3s.cli.console.tables import print_table
from proc3s.sandbox.text import clean
from proc3s.specs.suite import Cell, SuiteSpec
from proc3s.suites.episode import Episode
from proc3s.suites.outcomes import Unfinished
from proc3s.suites.results import Result
from proc3s.suites.runner import EpisodeOutcome
from proc3s.suites.tables import SuiteTable
from proc3s.wording import count

_LINE = 1000
"""Characters of a line about an episode, which may repeat what foreign code raised."""

FREE = f"{0:.4f}"
"""What is spent where nothing costs money; that is not said."""


class SuiteConsole:
    """A table that fills above a bar on a terminal, elsewhere a line an episode; `quiet` says nothing."""

    def __init__(self, spec: SuiteSpec, finished: Sequence[Episode], quiet: bool) -> None:
        self._spec, self._episodes, self._quiet = spec, list(finished), quiet
        self._total = len(list(spec.cells()))
        self._began, self._ended = time.monotonic(), 0
        self._left: list[Unfinished] = []
        self._err = Console(stderr=True, quiet=quiet, highlight=False)
        self._progress = Progress(
            BarColumn(24), MofNCompleteColumn(), TextColumn("episodes{task.fields[state]}"), console=self._err
        )
        self._bar = self._progress.add_task("", total=self._total, completed=len(finished), state="")
        self._live = Live(console=self._err, transient=True) if sys.stderr.isatty() and not quiet else None

    def __enter__(self) -> "SuiteConsole":
        if self._live:
            self._live.start()
            self._live.update(self._shown())
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._live:
            self._live.stop()

    def add(self, outcome: EpisodeOutcome, spent: str) -> None:
        """An episode has ended; `spent` is what all have cost up to now, US dollars."""
        self._ended += 1
        if isinstance(outcome, Episode):
            self._episodes.append(outcome)
        else:
            self._left.append(outcome)
        settled = len(self._episodes) + len(self._left)
        known = ("" if spent == FREE else f"{spent} $", self._ahead(self._total - settled))
        state = ", ".join(filter(None, known))
        self._progress.update(self._bar, completed=settled, state=f", {state}")
        if self._live:
            self._live.update(self._shown())
        if not self._live or not _well(outcome):
            line = f"[{settled}/{self._total}] {self._called(outcome.cell)}: {_word(outcome)}"
            line += f" ({state})" if state else ""
            self._err.print(clean(line, _LINE), soft_wrap=not self._live, markup=False)

    def _called(self, cell: Cell) -> str:
        preset = f" ({cell.preset})" if len(self._spec.presets) > 1 else ""
        return f"{cell.task} {cell.method}{preset} seed {cell.seed}"

    def _ahead(self, left: int) -> str:
        """The time left, by the pace up to now."""
        pace = (time.monotonic() - self._began) / self._ended
        return f"about {_duration(pace * left)} left" if left else ""

    def _shown(self) -> Group | Progress:
        """Successes of every method and task that has episodes, and how it goes on."""
        seen = [*(e.cell for e in self._episodes), *(u.cell for u in self._left)]
        methods = [m for m in self._spec.methods if any(cell.method == m for cell in seen)]
        if not methods:
            return self._progress
        table = RichTable(box=None, pad_edge=False)
        for name in ("task", *methods):
            table.add_column(name, overflow="fold")
        for task in self._spec.tasks:
            if any(cell.task == task for cell in seen):
                table.add_row(escape(task), *(self._cell(method, task) for method in methods))
        return Group(table, self._progress)

    def _cell(self, method: str, task: str) -> str:
        some = [e for e in self._episodes if (e.method, e.task) == (method, task)]
        left = sum((u.cell.method, u.cell.task) == (method, task) for u in self._left)
        rate = f"{sum(e.goal_reached is True for e in some)}/{len(some)}" if some else ""
        return f"{rate} +{left} not finished".strip() if left else rate

    def result(self, tables: Sequence[SuiteTable], folder: Path) -> None:
        """The tables, and where everything is."""
        out = Console(highlight=False)
        for table in tables:
            out.print(f"[bold]{escape(table.title)}[/]")
            print_table(out, table.head, table.lines)
        out.print(f"folder   {folder}  (results.md, .csv, .json, .html)", soft_wrap=True, markup=False)


def _well(outcome: EpisodeOutcome) -> bool:
    """Whether nobody need read why."""
    return isinstance(outcome, Episode) and Result(outcome).word in ("goal reached", "not judged")


def _word(outcome: EpisodeOutcome) -> str:
    """What became of it, and the reason where it failed."""
    if isinstance(outcome, Unfinished):
        return f"not finished, {outcome.word}: {outcome.error}"
    state = "solved" if outcome.solved else "unsolved"
    stale = ", stale" if outcome.stale else ""
    reason = "" if _well(outcome) else outcome.failure or outcome.goal_reason
    told = f"{state}, {Result(outcome).word}, {count(outcome.samples, 'sample')}{stale}"
    return f"{told}: {reason}" if reason else told


def _duration(seconds: float) -> str:
    minutes = round(seconds / 60)
    if minutes >= 60:
        return f"{minutes // 60} h {minutes % 60} min"
    return f"{minutes} min" if minutes > 1 else f"{seconds:.0f} s"
