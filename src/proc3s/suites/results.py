"""Episodes in groups, each with its final verdict: a person's before the judge's."""

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from proc3s.errors import UsageError
from proc3s.specs.suite import Cell, SuiteSpec
from proc3s.suites.episode import Episode
from proc3s.suites.outcomes import Unfinished, Word
from proc3s.suites.store import JudgeVerdict, Store
from proc3s.textfiles import read_text


@dataclass(frozen=True)
class Result:
    """An episode and the verdict of a person, if there is one."""

    episode: Episode
    verdict: JudgeVerdict | None = None

    @property
    def success(self) -> bool | None:
        """Whether the instruction is fulfilled; None for a task without a judge."""
        if self.verdict is not None:
            return self.verdict.reached
        return bool(self.episode.goal_reached) if self.episode.judged else None

    @property
    def word(self) -> Word:
        """What became of it."""
        if self.success:
            return "goal reached"
        if self.episode.executed == "none":
            return "no plan"
        return "not judged" if self.success is None else "goal missed"

    @property
    def wrong(self) -> bool:
        """The world accepted the plan, and yet the instruction is not fulfilled."""
        return self.episode.solved and self.success is False

    @property
    def authored(self) -> bool:
        """The answers were written by hand, so that success says nothing about a model."""
        return self.episode.source == "authored"


class Results:
    """All results of a suite, by line (method and preset) and task, and what could not be carried out.

    Those of stale answers are among `all`, and by line and task in `stale` alone.
    """

    def __init__(
        self,
        spec: SuiteSpec,
        results: Sequence[Result],
        facts: Mapping[str, Any],
        unfinished: Sequence[Unfinished] = (),
        stale: bool = False,
    ) -> None:
        self.spec, self.all, self.facts = spec, results, facts
        self.unfinished, self._stale = unfinished, stale
        self.lines = [(method, preset) for method in spec.methods for preset in spec.presets]

    def of(self, line: tuple[str, str], task: str | None = None) -> list[Result]:
        """Those of a method with a preset, of a task or of all."""
        return [
            r
            for r in self.all
            if (r.episode.method, r.episode.preset) == line
            and task in (None, r.episode.task)
            and r.episode.stale == self._stale
        ]

    @property
    def stale(self) -> "Results":
        """The same, of answers to another prompt."""
        return Results(self.spec, [r for r in self.all if r.episode.stale], self.facts, stale=True)

    def words(self, line: tuple[str, str], task: str | None = None) -> list[Word]:
        """What became of the episodes of a method with a preset, those that are not finished included."""
        left = [
            one.word for one in self.unfinished if one.cell[1:3] == line and task in (None, one.cell.task)
        ]
        return [*(result.word for result in self.of(line, task)), *left]

    def label(self, line: tuple[str, str]) -> str:
        """What a line is called."""
        method, preset = line
        return method if len(self.spec.presets) == 1 else f"{method} ({preset})"


def read_results(folder: Path) -> Results:
    """The results of a suite's folder. Raises UsageError if it has none."""
    store = Store(folder)
    facts = store.facts()
    if "spec" not in facts:
        raise UsageError(f"{folder} was cut off before its suite began")
    spec = SuiteSpec.model_validate(facts["spec"])
    verdicts = store.verdicts()
    results = [Result(e, verdicts.get(e.cell)) for e in store.episodes()]
    order: dict[Cell, int] = {cell: k for k, cell in enumerate(spec.cells())}
    return Results(
        spec,
        sorted(results, key=lambda r: order.get(r.episode.cell, 0)),
        facts,
        sorted(store.unfinished(), key=lambda one: order.get(one.cell, 0)),
    )


Figures = Mapping[tuple[str, str, str], tuple[float, float | None]]
"""(quantity, method, domain/task) -> mean and standard deviation, as published."""


def read_figures(path: Path | None) -> Figures:
    """Published figures from a CSV file, rows without a mean left out; none without a file.

    Raises UsageError for a file that is not so.
    """
    if path is None:
        return {}
    try:
        return {
            (row["quantity"], row["method"], f"{row['domain']}/{row['task']}"): (
                float(row["mean"]),
                float(row["std"]) if row["std"] else None,
            )
            for row in csv.DictReader(read_text(path).splitlines(keepends=True))
            if row["mean"]
        }
    except (OSError, KeyError, ValueError) as error:
        raise UsageError(f"the published figures {path} cannot be read: {error}") from error
