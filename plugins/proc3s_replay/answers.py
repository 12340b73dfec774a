"""Answer files: Markdown named by what they answer, with their origin on top."""

import re
from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict, ValidationError

from proc3s import Completion, LLMError, Request, answer
from proc3s.textfiles import read_text

_FRONT = re.compile(r"\A---\n(.*?)\n---\n", re.DOTALL)


class Origin(BaseModel):
    """Who wrote an answer; `authored` is a person, anything else names the model and the day."""

    model_config = ConfigDict(extra="forbid")

    origin: Literal["authored", "recorded"]
    model: str | None = None
    date: str | None = None


def stem(request: Request, seed: bool = True) -> str:
    """`star.proc3s`, `star.proc3s.seed3`, `star.proc3s.seed3.round1`: the name of an answer file."""
    parts = [request.task.partition("/")[2], request.template]
    parts += [f"seed{request.seed}"] if seed else []
    parts += [f"round{request.round}"] if request.round else []
    parts += [f"candidate{request.candidate}"] if request.candidate else []
    return ".".join(parts)


def find(folder: Path, request: Request) -> Path | None:
    """The file that answers a request: one for its seed, else one for every seed."""
    names = (f"{stem(request, seed)}.md" for seed in (True, False))
    return next((folder / name for name in names if (folder / name).is_file()), None)


def read(path: Path) -> Completion:
    """The completion in a file. Raises LLMError if it is no text, or does not say where it is from."""
    try:
        text = read_text(path)
    except (OSError, UnicodeDecodeError) as error:
        raise LLMError(f"the answer {path} cannot be read: {error}") from error
    front = _FRONT.match(text)
    pairs = (line.partition(":")[::2] for line in front.group(1).splitlines()) if front else ()
    try:
        origin = Origin.model_validate({key.strip(): value.strip() for key, value in pairs})
    except ValidationError as error:
        raise LLMError(
            f"{path}: an answer begins with its origin, e.g. the three lines `---`, `origin: authored`, `---`"
        ) from error
    whole = text[front.end() :].strip() + "\n" if front else text
    return answer(whole, origin.model or "nobody (authored)", origin.origin)
