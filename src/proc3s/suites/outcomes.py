"""The outcome of an episode in one word: the same in tables, files, page, console and comparison."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, TypeAlias

from proc3s.errors import Interrupted, OutOfTime, Proc3sError, UsageError
from proc3s.llm.errors import BudgetSpent, LLMError, Pending
from proc3s.specs.suite import Cell

Word: TypeAlias = Literal[
    "goal reached",
    "goal missed",
    "no plan",
    "not judged",
    "out of budget",
    "out of time",
    "pending",
    "interrupted",
    "error",
]
FINISHED: tuple[Word, ...] = ("goal reached", "goal missed", "no plan", "not judged")
UNFINISHED: tuple[Word, ...] = ("out of budget", "out of time", "pending", "interrupted", "error")
"""Could not be carried out: in no rate, and tried again by `--resume`."""
ALWAYS: tuple[Word, ...] = ("goal reached", "goal missed", "no plan", "out of budget", "error")
"""Told even of suites that have none; the others where there are some."""

_OF_STOPPED: dict[str, Word] = {
    "budget": "out of budget",
    "time": "out of time",
    "pending": "pending",
    "interrupted": "interrupted",
}
_ERRORS: dict[str, type[Proc3sError]] = {
    kind.stopped: kind for kind in (LLMError, BudgetSpent, OutOfTime, Pending, Interrupted)
}
_GRAVEST: tuple[Word, ...] = ("error", "pending", "out of time", "out of budget", "interrupted")
MOST_REASONS = 5


@dataclass(frozen=True)
class Unfinished:
    """An episode that could not be carried out, and is to be tried again; `stopped` as in a summary.

    That is `crashed` where the process ended without one.
    """

    cell: Cell
    stopped: str
    error: str

    @property
    def word(self) -> Word:
        """Which kind of unfinished."""
        return _OF_STOPPED.get(self.stopped, "error")


def told(words: Iterable[Word]) -> str:
    """How many of each, as `2 error, 1 pending`."""
    return ", ".join(f"{count} {word}" for word, count in Counter(words).most_common())


def reasons(unfinished: Iterable[Unfinished]) -> list[str]:
    """Why episodes are not finished, the commonest first, each with how many and one that it struck."""
    where: dict[tuple[Word, str], list[Cell]] = {}
    for one in unfinished:
        where.setdefault((one.word, one.error), []).append(one.cell)
    ranked = sorted(where.items(), key=lambda item: -len(item[1]))
    lines = [
        f"{len(cells)} {word} ({cells[0].folder}{', …' if len(cells) > 1 else ''}): {error}"
        for (word, error), cells in ranked[:MOST_REASONS]
    ]
    more = sum(len(cells) for _, cells in ranked[MOST_REASONS:])
    return [*lines, *([f"{more} for other reasons"] if more else [])]


def as_error(unfinished: Iterable[Unfinished], message: str) -> Proc3sError:
    """The error that a suite ends with: of the kind that the gravest episode ended with."""
    gravest = min(unfinished, key=lambda one: (_GRAVEST.index(one.word), one.stopped == "llm"))
    return _ERRORS.get(gravest.stopped, UsageError)(message)
