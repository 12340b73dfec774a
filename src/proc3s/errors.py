"""Errors meant for people: a message without a traceback, and the exit code that goes with it."""

import reprlib
import sys
import traceback
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from difflib import get_close_matches
from typing import ClassVar, Literal

Stopped = Literal["usage", "llm", "budget", "pending", "interrupted", "time"]


class Proc3sError(Exception):
    """An error that the user can fix. The message says what was wrong, where, and what to do."""

    exit_code: ClassVar[int] = 2
    stopped: ClassVar[Stopped] = "usage"
    """What ended a run, in a word."""


class UsageError(Proc3sError):
    """A wrong name, option or file on the command line (exit code 2)."""


class Notice(UserWarning):
    """What a plugin has to say that is no error; the command line shows it as its own notices."""


def refuse_windows() -> None:
    """Raises UsageError on Windows: it has none of the file locks, signals and filters that runs need."""
    if sys.platform == "win32":
        raise UsageError(
            "proc3s needs Linux: on Windows, install it inside of WSL 2, or run it in a container "
            "(docs/how-to/container.md)"
        )


class OutOfTime(Proc3sError):
    """A limit of wall-clock time broke the run off, which says nothing of its programs (exit code 1)."""

    exit_code: ClassVar[int] = 1
    stopped: ClassVar[Stopped] = "time"


class Interrupted(Proc3sError):
    """Ctrl-C (exit code 130)."""

    exit_code: ClassVar[int] = 130
    stopped: ClassVar[Stopped] = "interrupted"


@dataclass(frozen=True)
class Issue:
    """One mistake in a spec: `where` is `path:line` or a name, `field` a dotted path."""

    where: str
    field: str
    message: str

    def __str__(self) -> str:
        return ": ".join(part for part in (self.where, self.field, self.message) if part)


class SpecError(Proc3sError):
    """A spec file or a registered spec is wrong; all its mistakes at once (exit code 2)."""

    def __init__(self, issues: Sequence[Issue]) -> None:
        self.issues = tuple(issues)
        super().__init__("\n".join(str(issue) for issue in self.issues))

    def __reduce__(self) -> tuple[type["SpecError"], tuple[tuple[Issue, ...]]]:
        return type(self), (self.issues,)  # crosses from worker processes as it is


@contextmanager
def blame(field: str, *passing: type[BaseException]) -> Iterator[None]:
    """Turn whatever code of a plugin raises into a SpecError that names the part and the line.

    That is also what no `except Exception` sees, SystemExit say: no plugin ends the process. Errors for
    people pass, Ctrl-C does, and those of `passing`, which the caller knows.
    """
    known: tuple[type[BaseException], ...] = (Proc3sError, KeyboardInterrupt, *passing)
    try:
        yield
    except known:
        raise
    except BaseException as error:
        raise SpecError([Issue(_raised_at(error), field, f"raised {worded(error)}")]) from error


def not_wanted(part: str, value: object, wanted: str) -> SpecError:
    """The error of a plugin's function that returned something else than it must."""
    return SpecError([Issue(part, "target", f"returned {reprlib.repr(value)}, not {wanted}")])


def worded(error: BaseException) -> str:
    """An error without its traceback: as it is if it is for people, else after its type."""
    if isinstance(error, Proc3sError):
        return str(error)
    return f"{type(error).__name__}: {error}".removesuffix(": ")


def _raised_at(error: BaseException) -> str:
    """`file:line` of the mistake: of the innermost frame that is a file."""
    if isinstance(error, SyntaxError) and error.filename:
        return f"{error.filename}:{error.lineno}"
    frames = traceback.extract_tb(error.__traceback__)
    files = [frame for frame in frames if not frame.filename.startswith("<")] or frames
    return f"{files[-1].filename}:{files[-1].lineno}"


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """A hint to append to a message: the nearest known name, or all of them if none is near."""
    names = sorted(known)
    if near := get_close_matches(name, names, n=1, cutoff=0.6):
        return f"; did you mean {near[0]!r}?"
    return f"; there is {', '.join(names)}" if names else ""
