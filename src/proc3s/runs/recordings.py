"""The recorded answers in a cassette, a folder of cassettes, or a run folder."""

from pathlib import Path
from typing import Any

from proc3s.llm.recorder import Recording, checked, of_cassette
from proc3s.llm.types import Completion
from proc3s.runs.reading import LOG, read_events, started


def read_recordings(path: Path) -> list[Recording] | None:
    """All answers in a cassette, a folder of cassettes, or a run folder, oldest first.

    None for a folder that is neither. Raises LLMError, naming file and line, for what is damaged or cannot be
    read.
    """
    if (path / LOG).is_file():
        return _of_run(path)
    cassettes = sorted(path.glob("*.jsonl")) if path.is_dir() else [path]
    return [recording for cassette in cassettes for recording in of_cassette(cassette)] if cassettes else None


def _of_run(run: Path) -> list[Recording]:
    """The answers of a run. Answers that it was given again when it was resumed count once."""
    options = started(run)["options"]
    episode = {name: options[name] for name in ("task", "method", "seed")}
    prompts: dict[int, dict[str, Any]] = {}
    found: dict[tuple[int, int, str, Completion], Recording] = {}
    for number, event in enumerate(read_events(run), start=1):
        if event["event"] == "prompt_rendered":
            prompts[event["round"]] = {name: event[name] for name in ("sha256", "messages")}
        elif event["event"] == "answer_received":
            given = {name: event.get(name) for name in ("round", "candidate", "time", "completion")}
            given |= episode | prompts.get(event["round"], {}) | {"take": str(run), "sampling": None}
            one = checked(given, f"{run / LOG}:{number}")
            found.setdefault((one.round, one.candidate, one.sha256, one.completion), one)
    return list(found.values())
