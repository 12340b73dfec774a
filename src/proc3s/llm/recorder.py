"""Recordings: answers of language models, each with the request that it answers."""

import json
import re
import secrets
import tempfile
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from proc3s.errors import UsageError
from proc3s.llm.cassette import Cassette
from proc3s.llm.errors import LLMError
from proc3s.llm.types import LLM, Completion, Message, Request, Sampling, WrappedLLM, digest
from proc3s.redaction import redacted


class Recording(BaseModel):
    """An answer with the request that it was given to, as a cassette or the log of a run keeps it.

    Task, method and seed are the episode; its completion answers `candidate` and as many of the numbers
    after it as there are further candidates. Nothing else of the request is kept, and no option of a backend.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    task: str
    method: str
    seed: int
    round: int
    candidate: int
    time: str
    """When the answer was recorded, ISO 8601 in UTC."""
    take: str
    """Names the run that it was recorded in; the same episode may be recorded any number of times."""
    sampling: Sampling | None
    """What was asked for; None in a run folder, and where no model was asked."""
    sha256: str
    """Digest of the messages."""
    messages: tuple[Message, ...]
    completion: Completion
    """As it was received; `source` is that of then."""
    where: str = Field(default="", exclude=True)
    """`file:line`."""


class Recorder(WrappedLLM):
    """An LLM that passes requests on and keeps every answer in a cassette before it returns it.

    `path` is a cassette (`.jsonl`), or a folder of one cassette a task. One Recorder records one run; a run
    that is recorded by several gives each of them the same `take`. It wraps `RetryingLLM`, so that it
    records the answers that the run received. Raises UsageError if the path cannot be written, LLMError if
    the cassettes there cannot be read.
    """

    def __init__(self, llm: LLM, path: Path, take: str | None = None) -> None:
        super().__init__(llm)
        self._path = path
        self._take = take or secrets.token_hex(4)
        self._cassettes: dict[Path, Cassette] = {}
        if path.is_dir() or not path.suffix:
            _prepare_folder(path)
        elif path.suffix == ".jsonl":
            self._cassettes[path] = _prepare_file(path)
        else:
            raise UsageError(f"answers are recorded in a file NAME.jsonl or in a folder, not in {path}")

    def complete(self, request: Request) -> Completion:
        """The answer of the wrapped LLM. One that is paid for is returned even if it cannot be recorded."""
        cassette = self._cassette(request.task)
        completion = self._llm.complete(request)
        recording = _recording(request, completion, self._take).model_dump()
        try:
            _refuse_secrets(recording)
            cassette.append(recording)
        except (OSError, LLMError) as error:
            note = f"the answer is not recorded in {cassette.path}: {error}"
            return completion.model_copy(update={"notes": (*completion.notes, note)})
        return completion

    def _cassette(self, task: str) -> Cassette:
        """The cassette of a task, after a look at whether it can be written and read."""
        path = self._path
        if path.is_dir():
            path /= re.sub(r"[^A-Za-z0-9]+", "-", task) + ".jsonl"
        if path not in self._cassettes:
            self._cassettes[path] = _prepare_file(path)
        return self._cassettes[path]


def _prepare_folder(path: Path) -> None:
    try:
        path.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path):
            pass
    except OSError as error:
        raise UsageError(f"the folder {path} cannot be written: {error.strerror}") from error


def _prepare_file(path: Path) -> Cassette:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("ab"):
            pass
    except OSError as error:
        raise UsageError(f"the cassette {path} cannot be written: {error.strerror}") from error
    of_cassette(path)
    return Cassette(path)


def _recording(request: Request, completion: Completion, take: str) -> Recording:
    return Recording(
        task=request.task,
        method=request.method,
        seed=request.seed,
        round=request.round,
        candidate=request.candidate,
        time=datetime.now(UTC).isoformat(timespec="seconds"),
        take=take,
        sampling=request.sampling if completion.source == "live" else None,
        sha256=digest(request.messages),
        messages=request.messages,
        completion=completion,
    )


def _refuse_secrets(recording: Mapping[str, Any]) -> None:
    """Raises LLMError; blackening a text instead would make it another one than the model saw or gave."""
    plain = json.dumps(recording, ensure_ascii=False)
    if redacted(plain) != plain:
        raise LLMError("it holds the value of a key, token or password in the environment")


def of_cassette(path: Path) -> list[Recording]:
    """The answers in a cassette, in the order in which they were recorded. Raises LLMError."""
    try:
        entries = Cassette(path).entries()
    except OSError as error:
        raise LLMError(f"the cassette {path} cannot be read: {error.strerror}") from error
    return [checked(entry.value, f"{path}:{entry.line}") for entry in entries]


def checked(data: Mapping[str, Any], where: str) -> Recording:
    """Raises LLMError if it is no recording, or its messages are others than its SHA-256 says."""
    try:
        recording = Recording.model_validate({**data, "where": where})
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        field = ".".join(map(str, first["loc"]))
        raise LLMError(f"{where}: no recorded answer of this proc3s ({field}: {first['msg']})") from error
    if digest(recording.messages) != recording.sha256:
        raise LLMError(f"{where}: damaged: the messages have another SHA-256 than the entry says")
    return recording
