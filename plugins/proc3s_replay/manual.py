"""Answers given by hand: prompts go out as files, answers come back as files."""

import sys
import time
from pathlib import Path

from pydantic import BaseModel, ConfigDict, Field

from proc3s import Completion, LLMError, Pending, Request
from proc3s_replay.answers import stem

_POLL_SECONDS = 0.5


class Options(BaseModel):
    """How long to wait for the person."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    wait: float | None = Field(None, ge=0, description="seconds to wait for the answer; 0: end as pending")


class Manual:
    """Writes `NAME.prompt.md` into the folder and takes the answer from `NAME.answer.md`."""

    def __init__(self, folder: str, options: Options) -> None:
        if not folder:
            raise LLMError("name the folder of prompts and answers: --llm manual:DIR")
        self._folder = Path(folder)
        self._wait = options.wait

    def complete(self, request: Request) -> Completion:
        """The answer, once it is there and not empty. Raises Pending when the waiting is over."""
        domain = request.task.partition("/")[0]
        name = f"{domain}.{stem(request)}"
        prompt, answer = self._folder / f"{name}.prompt.md", self._folder / f"{name}.answer.md"
        if self._wait != 0 and not _text(answer):
            print(f"read {prompt}\nand write the answer to {answer}", file=sys.stderr)
        try:
            _ask(_prompt(request), prompt, answer)
        except OSError as error:
            raise LLMError(f"the prompt {prompt} cannot be written: {error.strerror}") from error
        begun = time.monotonic()
        while not (text := _text(answer)):
            if self._wait is not None and time.monotonic() - begun >= self._wait:
                raise Pending(
                    f"pending: read {prompt}, write the answer to {answer}, then run the same command again"
                )
            time.sleep(_POLL_SECONDS)
        return Completion(text=text, source="manual", model="a person", finish_reason="stop")


def _ask(text: str, prompt: Path, answer: Path) -> None:
    """Write the prompt. An answer to another prompt of the same name is put aside."""
    prompt.parent.mkdir(parents=True, exist_ok=True)
    if prompt.is_file() and prompt.read_text(encoding="utf-8") != text and answer.is_file():
        answer.replace(answer.with_suffix(".old.md"))
    prompt.write_text(text, encoding="utf-8")


def _prompt(request: Request) -> str:
    return "\n".join(f"# {m.role}: {m.kind}\n\n{m.text.rstrip()}\n" for m in request.messages)


def _text(answer: Path) -> str:
    """The answer so far; empty while there is none. Raises LLMError if it is not text."""
    try:
        text = answer.read_text(encoding="utf-8") if answer.is_file() else ""
    except UnicodeDecodeError as error:
        raise LLMError(f"the answer {answer} is not UTF-8 text: {error.reason}") from error
    return text if text.strip() else ""
