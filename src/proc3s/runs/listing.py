"""What became of a run, in a line: read from the first and the last line of its log."""

import fcntl
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, TypeAlias

from pydantic import BaseModel, ConfigDict, ValidationError

from proc3s.runs.reading import LOG

Fate: TypeAlias = Literal["solved", "unsolved", "at work", "broken off", "error", "unreadable"]


class ListedRun(BaseModel):
    """A run among others; what its log does not say is null."""

    model_config = ConfigDict(frozen=True, use_attribute_docstrings=True)

    folder: str
    """The run folder."""
    outcome: Fate
    """`at work`: another process writes it; `broken off`: none does, and it has no end."""
    began: str | None = None
    """ISO 8601, UTC."""
    task: str | None = None
    """`domain/task`."""
    method: str | None = None
    """The method."""
    llm: str | None = None
    """The language model; null if none was asked."""
    seed: int | None = None
    """The seed of the scene and of the search."""
    samples: int | None = None
    """Samples of all rounds; null while the run has no end."""
    goal_reached: bool | None = None
    """The judge's verdict; null without one."""
    error: str | None = None
    """Why the run did not come to its end, or cannot be read."""


def listed(run: Path) -> ListedRun:
    """What a run folder says of its run; a damaged one is `unreadable`."""
    try:
        return _listed(run)
    except OSError as error:
        return ListedRun(folder=str(run), outcome="unreadable", error=error.strerror)
    except (ValueError, LookupError, TypeError, AttributeError, RecursionError, ValidationError):
        return ListedRun(folder=str(run), outcome="unreadable", error=f"{LOG} is no log of a run")


def _listed(run: Path) -> ListedRun:
    lines = (run / LOG).read_bytes().split(b"\n")[:-1]  # what follows the last line end was cut off
    if not lines:
        return ListedRun(folder=str(run), outcome=_unended(run))
    begun, latest = json.loads(lines[0]), json.loads(lines[-1])
    options = begun["options"]
    told = {name: options.get(name) for name in ("task", "method", "llm", "seed")}
    told |= {"folder": str(run), "began": begun["time"]}
    if latest["event"] != "run_ended":
        return ListedRun(**told, outcome=_unended(run))
    summary = latest["summary"]
    told |= {name: summary.get(name) for name in ("llm", "samples", "goal_reached", "error")}
    return ListedRun(**told, outcome=_ended(summary))


def _ended(summary: Mapping[str, Any]) -> Fate:
    if summary["solved"]:
        return "solved"
    if summary["error"] is None:
        return "unsolved"
    return "broken off" if summary.get("stopped") == "interrupted" else "error"


def _unended(run: Path) -> Fate:
    """Whether a process holds the lock on the log of a run."""
    with (run / LOG).open("rb") as log:
        try:
            fcntl.flock(log, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return "at work"
    return "broken off"
