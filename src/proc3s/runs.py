"""Run folders: an append-only log of events beside the files a person opens first."""

import contextlib
import fcntl
import itertools
import json
import os
import platform
import re
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, entry_points, version
from pathlib import Path
from typing import Any

from proc3s.errors import UsageError
from proc3s.events import (
    AnswerReceived,
    Event,
    PlanExecuted,
    ProgramExtracted,
    PromptRendered,
    RunEnded,
    Unwritten,
)
from proc3s.llms import Message
from proc3s.plugins import GROUP
from proc3s.secrets import platform_name

LOG = "events.jsonl"


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
            _mend(path / LOG)
        except BlockingIOError as error:
            raise UsageError(f"another process is at work in {path}") from error
        except OSError as error:
            raise UsageError(f"the run folder {path} cannot be written: {error.strerror}") from error

    def emit(self, event: Event) -> Unwritten | None:
        """Append an event to the log and write the file that belongs to it; what to tell if that fails."""
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
        """Whole or not at all: written beside and then renamed."""
        part = self.path / f".{name}.part"
        part.write_text(text, encoding="utf-8", errors="backslashreplace")
        part.replace(self.path / name)

    def close(self) -> None:
        """Close the log."""
        self._log.close()


def _mend(log: Path) -> None:
    """Take away a last line that was cut off."""
    data = log.read_bytes()
    if not data.endswith(b"\n"):
        os.truncate(log, data.rfind(b"\n") + 1)


def label(round_: int, candidate: int) -> str:
    """How files name a program: its round, and its number if there are several."""
    return f"{round_}.{candidate}" if candidate else str(round_)


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


def versions() -> dict[str, str]:
    """Versions of everything a result may depend on: Python, and all that plugins come with and require."""
    plugins = {e.dist.name: e.dist for e in entry_points(group=GROUP) if e.dist}
    texts = (text.partition(";") for plugin in plugins.values() for text in plugin.requires or ())
    required = {re.split(r"[^\w.-]", need, maxsplit=1)[0] for need, _, when in texts if "dev" not in when}
    found = {"python": platform.python_version(), "platform": platform_name()}
    for name in sorted({*plugins, *required}):
        with contextlib.suppress(PackageNotFoundError):
            found[name] = version(name)
    return found


def read_events(run: Path) -> list[dict[str, Any]]:
    """All whole events of a run folder; a last line cut off by a kill is left out.

    Raises UsageError if it is no run folder.
    """
    log = run / LOG
    if not log.is_file():
        raise UsageError(f"{run} is no run folder (it has no {LOG})")
    # Bytes, and only "\n": text may hold other line ends, and a kill may cut a character in two.
    *lines, last = log.read_bytes().split(b"\n")
    events = [_parse(line, f"{log}:{number}") for number, line in enumerate(lines, start=1)]
    with contextlib.suppress(UsageError):
        events += [_parse(last, str(log))] if last else []
    return events


def _parse(line: bytes, where: str) -> dict[str, Any]:
    try:
        event = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise UsageError(f"{where}: not valid JSON: {error}") from error
    if not isinstance(event, dict) or "event" not in event:
        raise UsageError(f"{where}: not an event of a run")
    return event


def events_of(run: Path, name: str) -> list[dict[str, Any]]:
    """The events of one type."""
    return [event for event in read_events(run) if event["event"] == name]


def options_of(run: Path) -> Mapping[str, Any]:
    """The options of a run, as those who resumed it have changed them. Raises UsageError."""
    begun = [e for e in read_events(run) if e["event"] in ("run_started", "run_resumed")]
    if not begun:
        raise UsageError(f"{run} was cut off before it began")
    return _with_options(run, begun[-1])["options"]  # type: ignore[no-any-return]


def started(run: Path) -> Mapping[str, Any]:
    """The first event of a run: options, versions. Raises UsageError if it was cut off before."""
    first = events_of(run, "run_started")
    if not first:
        raise UsageError(f"{run} was cut off before it began")
    return _with_options(run, first[0])


def _with_options(run: Path, event: Mapping[str, Any]) -> Mapping[str, Any]:
    if not isinstance(event.get("options"), Mapping):
        raise UsageError(f"{run / LOG}: no log of a run: {event['event']} has no options")
    return event
