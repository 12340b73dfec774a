"""Reads the log of a run folder."""

import contextlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from proc3s.errors import UsageError

LOG = "events.jsonl"


def label(round_: int, candidate: int) -> str:
    """How files name a program: its round, and its number if there are several."""
    return f"{round_}.{candidate}" if candidate else str(round_)


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
