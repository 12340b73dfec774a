"""What a person sees of a suite: a table that fills, the time left, what it costs; then the results."""

import sys
import time
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType

from rich.console import Console, Group
from rich.live import Live
from rich.markup import escape
from rich.table import Table as RichTable
from rich.text import Text

from proc3s.specs.suite import SuiteSpec
from proc3s.suites.episode import Episode
from proc3s.suites.outcomes import Unfinished
from proc3s.suites.results import Result
from proc3s.suites.runner import EpisodeOutcome
from proc3s.suites.tables import SuiteTable
from proc3s.wording import count

_WIDTH = 150
"""Columns of the results; a narrower terminal wraps its lines."""


class SuiteConsole:
    """Fills a table on a terminal, and elsewhere writes a line an episode; `quiet` says nothing."""

    def __init__(self, spec: SuiteSpec, finished: Sequence[Episode], quiet: bool) -> None:
        self._spec, self._episodes, self._quiet = spec, list(finished), quiet
        self._total = len(list(spec.cells()))
        self._began, self._ended = time.monotonic(), 0
        self._spent = "0.0000"
        self._left: list[Unfinished] = []
        self._err = Console(stderr=True, quiet=quiet, highlight=False)
        self._live = Live(console=self._err, transient=True) if sys.stderr.isatty() and not quiet else None

    def __enter__(self) -> "SuiteConsole":
        if self._live:
            self._live.start()
            self._live.update(self._table())
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._live:
            self._live.stop()

    def add(self, outcome: EpisodeOutcome, spent: str) -> None:
        """An episode has ended."""
        self._ended, self._spent = self._ended + 1, spent
        if isinstance(outcome, Episode):
            self._episodes.append(outcome)
        else:
            self._left.append(outcome)
        if self._live:
            self._live.update(self._table())
        else:
            self._err.print(f"{outcome.cell.folder}: {_word(outcome)}", soft_wrap=True, markup=False)

    def _table(self) -> Group:
        """Successes and episodes of every method and task, and how it goes on."""
        table = RichTable("method", *self._spec.tasks, box=None, pad_edge=False, title=self._spec.name)
        for method in self._spec.methods:
            table.add_row(method, *(self._cell(method, task) for task in self._spec.tasks))
        return Group(table, Text(self._state()))

    def _cell(self, method: str, task: str) -> str:
        some = [e for e in self._episodes if (e.method, e.task) == (method, task)]
        left = sum((u.cell.method, u.cell.task) == (method, task) for u in self._left)
        rate = f"{sum(e.goal_reached is True for e in some)}/{len(some)}" if some else "·"
        return f"{rate} ({left} not finished)" if left else rate

    def _state(self) -> str:
        """Progress, the time left and the spend, in a line."""
        done, left = len(self._episodes), self._total - len(self._episodes)
        pace = (time.monotonic() - self._began) / self._ended if self._ended else None
        ahead = f"about {_duration(pace * left)} left" if pace is not None else "no time known yet"
        return f"{done} of {self._total} episodes, {ahead}, {self._spent} $ spent"

    def result(self, tables: Sequence[SuiteTable], folder: Path) -> None:
        """The first tables, and where everything is."""
        out = Console(highlight=False, width=max(_WIDTH, Console().width))
        for table in tables:
            rich = RichTable(*map(escape, table.head), box=None, pad_edge=False)
            for line in table.lines:
                rich.add_row(*(_bold(cell) for cell in line))
            out.print(f"[bold]{escape(table.title)}[/]")
            out.print(rich)
        out.print(f"folder   {folder}  (results.md, .csv, .json, .html)", soft_wrap=True, markup=False)


def _word(outcome: EpisodeOutcome) -> str:
    if isinstance(outcome, Unfinished):
        return f"not finished, {outcome.word}: {outcome.error}"
    state = "solved" if outcome.solved else "unsolved"
    stale = ", stale" if outcome.stale else ""
    return f"{state}, {Result(outcome).word}, {count(outcome.samples, 'sample')}{stale}"


def _bold(cell: str) -> str:
    return f"[bold]{escape(cell[2:-2])}[/]" if cell.startswith("**") else escape(cell)


def _duration(seconds: float) -> str:
    minutes = round(seconds / 60)
    return f"{minutes // 60} h {minutes % 60} min" if minutes >= 60 else f"{minutes} min"
