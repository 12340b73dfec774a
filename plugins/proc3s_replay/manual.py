"""Answers given by hand: prompts go out as files, answers come back as files.

The folder is the exchange format, also for whatever else answers many prompts at once, e.g. a provider's
batch interface. A run writes `NAME.prompt.md`; whoever answers writes the text of the answer, and nothing
else, to `NAME.answer.md` beside it, in UTF-8. NAME is `DOMAIN.TASK.METHOD.seedN[.roundK][.candidateC]`,
unique in a benchmark. A prompt holds all messages in order, each under a heading `# ROLE: KIND` (ROLE is
system, user or assistant). With `wait=0` a run writes the prompts that it can ask now and ends as pending;
when it is resumed it takes the answers. An answer counts only beside the prompt that it was given to: if
the prompt has changed since, or is gone, the answer is renamed to `NAME.answer.oldN.md` and the prompt is
asked again.
"""

import itertools
import re
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from pydantic import BaseModel, ConfigDict, Field

from proc3s import LLM, Candidate, Completion, LLMError, Pending, Request
from proc3s.textfiles import read_text

_POLL_SECONDS = 0.5


class Options(BaseModel):
    """How long to wait for the person."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    wait: float | None = Field(
        default=None, ge=0, description="seconds to wait for the answer; 0: end as pending"
    )


class Manual(LLM):
    """Writes `NAME.prompt.md` into the folder and takes the answer from `NAME.answer.md`."""

    live = False

    def __init__(self, folder: str, options: Options) -> None:
        if not folder:
            raise LLMError("name the folder of prompts and answers: --llm manual:DIR")
        self._folder = Path(folder)
        self._wait = options.wait

    def complete(self, request: Request) -> Completion:
        """All candidates that are wanted, once they are there. Raises Pending if they do not come in time."""
        numbers = range(request.candidate, request.candidate + request.sampling.n)
        desk = [_Sheet(self._folder, _name(request, number)) for number in numbers]
        for sheet in desk:
            sheet.ask(_prompt(request))
        texts = self._answers(desk)
        candidates = tuple(Candidate(text=text) for text in texts)
        return Completion(candidates=candidates, source="manual", model="a person")

    def _answers(self, desk: Sequence["_Sheet"]) -> list[str]:
        """The texts of the answers, when all are there and, while there is time, written to their end."""
        end = None if self._wait is None else time.monotonic() + self._wait
        texts, settled, told = [sheet.text() for sheet in desk], self._wait == 0, False
        while not (all(texts) and settled):
            left = _POLL_SECONDS if end is None else end - time.monotonic()
            if left <= 0:
                raise Pending(f"pending: {_todo(desk)}")
            if not all(texts) and not told:
                print(_todo(desk), file=sys.stderr)
                told = True
            time.sleep(min(left, _POLL_SECONDS))
            before, texts = texts, [sheet.text() for sheet in desk]
            settled = texts == before
        return texts


class _Sheet:
    """A prompt and the answer to it."""

    def __init__(self, folder: Path, name: str) -> None:
        self.prompt = folder / f"{name}.prompt.md"
        self.answer = folder / f"{name}.answer.md"

    def ask(self, prompt: bytes) -> None:
        """Write the prompt, unless it is there. An answer to another one is put aside first."""
        try:
            if self.prompt.is_file() and self.prompt.read_bytes() == prompt:
                return
            if self.text():
                self._put_aside()
            self.prompt.parent.mkdir(parents=True, exist_ok=True)
            part = self.prompt.with_name(f".{self.prompt.name}.part")
            part.write_bytes(prompt)
            part.replace(self.prompt)
        except OSError as error:
            raise LLMError(f"the prompt {self.prompt} cannot be written: {error.strerror}") from error

    def _put_aside(self) -> None:
        names = (self.answer.with_suffix(f".old{n}.md") for n in itertools.count(1))
        aside = next(name for name in names if not name.exists())
        self.answer.replace(aside)
        print(f"{self.answer} was given to another prompt; it is now {aside}", file=sys.stderr)

    def text(self) -> str:
        """The answer so far; empty while there is none. Raises LLMError if it is not text."""
        try:
            text = read_text(self.answer) if self.answer.is_file() else ""
        except UnicodeDecodeError as error:
            raise LLMError(f"the answer {self.answer} is not UTF-8 text: {error.reason}") from error
        except OSError as error:
            raise LLMError(f"the answer {self.answer} cannot be read: {error.strerror}") from error
        return text if text.strip() else ""


def _name(request: Request, candidate: int) -> str:
    """`drawing.star.proc3s.seed0.round1.candidate2`; dots inside a name are written otherwise."""
    names = [*request.task.split("/", 1), request.method]
    parts = [re.sub(r"[^\w-]", lambda c: f"%{ord(c[0]):02x}", name) for name in names] + [
        f"seed{request.seed}"
    ]
    parts += [f"round{request.round}"] if request.round else []
    parts += [f"candidate{candidate}"] if candidate else []
    return ".".join(parts)


def _prompt(request: Request) -> bytes:
    text = "\n".join(f"# {m.role}: {m.kind}\n\n{m.text}\n" for m in request.messages)
    return text.encode("utf-8", "backslashreplace")


def _todo(desk: Sequence[_Sheet]) -> str:
    """What there is left to do, in files."""
    open_ = [sheet for sheet in desk if not sheet.text()]
    if len(open_) == 1:
        return f"read {open_[0].prompt} and write the answer to {open_[0].answer}"
    pairs = "".join(f"\n  {sheet.prompt} -> {sheet.answer}" for sheet in open_)
    return f"read these {len(open_)} prompts and write the answer to each beside it:{pairs}"
