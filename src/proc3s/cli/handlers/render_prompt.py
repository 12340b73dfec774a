"""Renderings of prompts: of one task, of a later round, compared with earlier ones."""

import difflib
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import typer

from proc3s.cli.failures import say
from proc3s.cli.streams import print_document
from proc3s.errors import UsageError
from proc3s.feedback.report import Diagnosis
from proc3s.llm.types import Message, digest, estimate_tokens
from proc3s.planning.options import RunOptions, run_options
from proc3s.planning.proposals import proposals_of
from proc3s.planning.resume import answers_of
from proc3s.planning.setup import first_messages
from proc3s.planning.typical_feedback import messages_after
from proc3s.plugins.registry import Registry
from proc3s.prompts.conversation import Exchange
from proc3s.runs.folder import markdown
from proc3s.runs.reading import LOG, events_of, read_events, started
from proc3s.textfiles import decoded

_LARGEST = 10_000_000
"""Bytes of a rendering; what is longer is none, a device without an end say."""


def require_one_source(round_: int | None, run: Path | None, failure: str | None) -> None:
    """Raises UsageError unless it is certain where the answers of the earlier rounds come from."""
    if failure is not None and (run is not None or round_ not in (None, 1)):
        raise UsageError(
            "--failure shows round 1 after an example of a failure: it takes no --from and no other --round"
        )
    if round_ and run is None and failure is None:
        raise UsageError(
            "--round needs --from RUN, which has the answers of the earlier rounds, or --failure NAME"
        )


def render(
    registry: Registry, options: RunOptions, round_: int, run: Path | None, failure: str | None
) -> tuple[Message, ...]:
    """The messages of a round; those after the first come from a run folder, or after a typical failure."""
    if failure is None:
        return first_messages(registry, options, _history(run, round_) if run else ())
    messages = messages_after(registry, options, failure)
    say([f"this is an example of the failure {failure}: no program was run"])
    return messages


def options_of(task: str, given: dict[str, Any], run: Path | None) -> RunOptions:
    """Options of a rendering: those of the run it is from, changed by what the command line gives."""
    if run is None:
        return run_options(task=task, **given)
    logged = RunOptions.model_validate(started(run)["options"])
    if logged.task != task:
        raise UsageError(f"{run} is a run of {logged.task}, not of {task}")
    own = run_options(task=task, **given)
    return logged.model_copy(update={name: getattr(own, name) for name in given})


def _history(run: Path, rounds: int) -> Iterator[Exchange]:
    texts = {
        (p.round, p.candidate): p.answer
        for a in answers_of(read_events(run))
        for p in proposals_of(a.completion, a.round, a.candidate)
    }
    ended = [e for e in events_of(run, "round_ended") if (e["round"], e["candidate"]) in texts]
    if len(ended) < rounds:
        raise UsageError(f"{run} has {len(ended)} failed round(s), so no prompt of round {rounds}")
    for e in ended[:rounds]:
        yield Exchange(texts[e["round"], e["candidate"]], Diagnosis.model_validate(e["diagnosis"]))


def show(messages: tuple[Message, ...], format_: str | None, diff: Path | None, round_: int) -> None:
    """Print a rendering, or how it differs; its SHA-256 and size go to stderr.

    Without `format_` it is that of the file to compare with, else text.
    """
    earlier = _earlier(diff, format_ or "text", round_) if diff else ""
    text = formatted(messages, format_ or _format_of(earlier))
    if diff is not None:
        text = "".join(unified_diff(earlier, text, str(diff), "now"))
    print_document(text)
    typer.echo(f"sha256 {digest(messages)}  about {estimate_tokens(messages)} tokens", err=True)


def formatted(messages: tuple[Message, ...], format_: str) -> str:
    """A rendering in one of the formats."""
    if format_ == "json":
        return json.dumps([m.model_dump() for m in messages], indent=2, ensure_ascii=False) + "\n"
    if format_ == "markdown":
        return markdown(messages)
    return "\n".join(f"[{m.role}: {m.kind}]\n{m.text.rstrip()}\n" for m in messages)


def _format_of(rendering: str) -> str:
    """Its format, by how it begins."""
    if re.match(r"<!-- \w+: \w+ -->\n", rendering):
        return "markdown"
    return "json" if re.match(r"\[\s*\{", rendering) else "text"


def _earlier(path: Path, format_: str, round_: int) -> str:
    """The text of an earlier rendering: a file or pipe, or the prompt of a round in a run folder."""
    if path.is_dir():
        return formatted(_prompt_of(path, round_), format_)
    try:
        with path.open("rb") as file:
            data = file.read(_LARGEST + 1)
        if len(data) > _LARGEST:
            raise UsageError(f"{path} is no rendering of a prompt: it has more than {_LARGEST:,} bytes")
        return decoded(data)
    except FileNotFoundError as error:
        raise UsageError(f"there is no rendering or run {path}") from error
    except UnicodeDecodeError as error:
        raise UsageError(f"{path} is no rendering of a prompt: it is no UTF-8 text") from error
    except OSError as error:
        raise UsageError(f"the rendering {path} cannot be read: {error.strerror}") from error


def _prompt_of(run: Path, round_: int) -> tuple[Message, ...]:
    if not (run / LOG).is_file():
        raise UsageError(f"{run} is no run folder (it has no {LOG}); --diff takes a run, or one rendering")
    prompts = [event for event in events_of(run, "prompt_rendered") if event["round"] == round_]
    if not prompts:
        raise UsageError(f"{run} has no prompt of round {round_}")
    return tuple(Message.model_validate(m) for m in prompts[0]["messages"])


def unified_diff(old: str, new: str, old_name: str, new_name: str) -> Iterator[str]:
    """The lines of a unified diff of two texts."""
    return difflib.unified_diff(
        old.splitlines(keepends=True), new.splitlines(keepends=True), old_name, new_name, n=2
    )
