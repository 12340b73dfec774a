"""Run folders: an append-only log of events beside the files a person opens first."""

import fcntl
import itertools
import json
import os
import re
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from proc3s.errors import UsageError
from proc3s.llm.types import Message
from proc3s.runs.events import (
    AnswerReceived,
    Event,
    PlanExecuted,
    ProgramExtracted,
    PromptRendered,
    RunEnded,
    Unwritten,
)
from proc3s.runs.reading import LOG, label


class RunFolder:
    """Writes a run as it happens. Every line is whole when written, so a killed run can be read.

    What cannot be written any more is told once, and then no more is written: a log has no holes. With
    `resume` it goes on with the log that is there. Raises UsageError if the folder cannot be written to begin
    with, has something in it that should not be there, or another process writes it.
    """

    def __init__(self, path: Path, resume: bool = False) -> None:
        self.path = path
        self._broken = False
        try:
            path.mkdir(parents=True, exist_ok=True)
            if not resume and any(path.iterdir()):
                raise UsageError(f"the folder {path} is not empty; give another --out, or --resume {path}")
            self._log = (path / LOG).open("ab", buffering=0)
            fcntl.flock(self._log, fcntl.LOCK_EX | fcntl.LOCK_NB)
            _repair(path / LOG)
        except BlockingIOError as error:
            raise UsageError(f"another process is at work in {path}") from error
        except OSError as error:
            raise UsageError(f"the run folder {path} cannot be written: {error.strerror}") from error

    def emit(self, event: Event) -> Unwritten | None:
        """Append an event to the log and write its file; returns an error message if that fails."""
        if self._broken:
            return None
        try:
            self._append(event)
            self._write_file(event)
        except OSError as error:
            self._broken = True
            text = f"the run folder {self.path} cannot be written any more: {error.strerror}; it lacks "
            return Unwritten(text=f"{text}everything from the event {event.event} on")
        return None

    def _append(self, event: Event) -> None:
        """Add a line to the log, whole or not at all. Raises OSError."""
        line = {"time": datetime.now(UTC).isoformat(timespec="milliseconds"), **event.model_dump(mode="json")}
        data = (json.dumps(line, ensure_ascii=False) + "\n").encode("utf-8", "backslashreplace")
        end = os.fstat(self._log.fileno()).st_size
        try:
            while data:  # what was written in part only raises when it is gone on with
                data = data[self._log.write(data) :]
        except OSError:
            self._log.truncate(end)
            raise

    def _write_file(self, event: Event) -> None:
        if isinstance(event, PromptRendered):
            self._write(f"prompt-{event.round}.md", markdown(event.messages))
        elif isinstance(event, AnswerReceived):
            for number, candidate in enumerate(event.completion.candidates, start=event.candidate):
                self._write(f"answer-{label(event.round, number)}.md", candidate.text)
        elif isinstance(event, ProgramExtracted):
            self._write(f"program-{label(event.round, event.candidate)}.py", event.source)
        elif isinstance(event, PlanExecuted):
            self._write("plan.json", _pretty(event.plan))
            score = {"goal_reached": event.goal_reached, "goal_reason": event.goal_reason}
            self._write("score.json", _pretty(score))
        elif isinstance(event, RunEnded):
            self._write("summary.json", _pretty(event.summary))

    def _write(self, name: str, text: str) -> None:
        """Write a file atomically: to a temporary name, then renamed."""
        part = self.path / f".{name}.part"
        part.write_text(text, encoding="utf-8", errors="backslashreplace")
        part.replace(self.path / name)

    def close(self) -> None:
        """Close the log."""
        self._log.close()


def _repair(log: Path) -> None:
    """Remove an incomplete last line of the log."""
    data = log.read_bytes()
    if not data.endswith(b"\n"):
        os.truncate(log, data.rfind(b"\n") + 1)


def _pretty(data: Any) -> str:
    return json.dumps(data, indent=2, ensure_ascii=False) + "\n"


def markdown(messages: tuple[Message, ...]) -> str:
    """Messages as one Markdown document, a heading for each."""
    return "\n".join(f"<!-- {m.role}: {m.kind} -->\n\n{m.text.rstrip()}\n" for m in messages)


def new_folder(parent: Path, task: str, method: str, seed: int) -> Path:
    """A new folder under `parent` that nobody else has, sorting by time. Raises UsageError."""
    stamp = datetime.now().strftime("%Y%m%d-%H%M%S")
    base = f"{stamp}-{re.sub(r'[^A-Za-z0-9]+', '-', task)}-{method}-seed{seed}"
    for name in (base if n == 1 else f"{base}-{n}" for n in itertools.count(1)):
        try:
            (parent / name).mkdir(parents=True)
        except FileExistsError:
            continue
        except OSError as error:
            raise UsageError(f"the run folder {parent / name} cannot be written: {error.strerror}") from error
        return parent / name
    raise AssertionError("itertools.count never ends")
