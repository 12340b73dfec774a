"""Answers that are there already: recorded ones checked against their prompts, authored ones by name."""

from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from proc3s import LLM, Completion, LLMError, Request
from proc3s.runs.recordings import read_recordings
from proc3s_replay import answers
from proc3s_replay.lookup import Lookup

_WAYS_OUT = (
    "ask a model with --llm PROVIDER/MODEL and record its answers with --record PATH, which "
    "--llm replay:PATH plays (--llm manual:DIR lets you write them yourself)"
)


class Options(BaseModel):
    """Which of the recorded answers are taken."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    repeat: int = Field(
        default=0, ge=0, description="which answer, if the same prompt was answered several times; from 0"
    )
    lenient: bool = Field(
        default=False, description="take an answer to feedback with other numbers too, and say so"
    )
    stale: Literal["refuse", "accept"] = Field(
        default="refuse",
        description="what becomes of an answer to another prompt; accept: its program runs, and the run is "
        "marked stale",
    )


class Replay(LLM):
    """Plays a cassette, a folder of cassettes, a run folder, or a folder of answer files.

    An empty `path` stands for the answer files bundled with the domain; `record` is where a person would
    record what is missing, unless that is the path. Raises LLMError if there is nothing at the path, or it
    is damaged.
    """

    live = False

    def __init__(self, path: str, options: Options, record: Path | None = None) -> None:
        self._path = Path(path) if path else None
        self.bundled_only = self._path is None
        self._repeat = options.repeat
        if self._path is not None and not self._path.exists():
            raise LLMError(f"there is no {self._path} to replay; {_WAYS_OUT}", "no_answer")
        recordings = read_recordings(self._path) if self._path else None
        self._lookup = None
        if self._path is not None and recordings is not None:
            self._lookup = Lookup(
                self._path,
                record or self._path,
                recordings,
                options.repeat,
                options.lenient,
                options.stale == "accept",
            )

    def complete(self, request: Request) -> Completion:
        """The recorded or authored answer. Raises LLMError if it is missing or stale."""
        if self._lookup:
            return self._lookup.answer(request)
        folder = self._path or request.bundled
        path = answers.find(folder, request) if folder else None
        if path is None:
            names = f"{answers.stem(request, seed=False)}.md or {answers.stem(request)}.md"
            where = f"in {self._path}" if self._path else "bundled"
            raise LLMError(
                f"no answer is {where} for {request.task} with the prompt {request.template!r}, "
                f"seed {request.seed}, round {request.round} ({names}); {_WAYS_OUT}",
                "no_answer",
            )
        if self._repeat:
            raise LLMError(f"{path} is written once and has no repeat={self._repeat}", "no_answer")
        return answers.read(path)
