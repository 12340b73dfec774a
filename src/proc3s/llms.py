"""Language models as typed data: messages in, a completion out. The backends are plugins."""

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Literal, Protocol

from pydantic import BaseModel, ConfigDict

Source = Literal["live", "recorded", "authored", "manual", "none"]
Role = Literal["system", "user", "assistant"]


class Message(BaseModel):
    """One message of a conversation; `kind` says which part of it this is."""

    model_config = ConfigDict(frozen=True)

    role: Role
    kind: Literal["system", "example", "task", "reply", "feedback"]
    text: str


class Request(BaseModel):
    """What is asked, and which answer of which run it is: that is how replayed answers are found."""

    model_config = ConfigDict(frozen=True)

    messages: tuple[Message, ...]
    task: str
    """`domain/task`."""
    template: str
    """Name of the method's prompt template; methods that share it share their answers."""
    seed: int
    round: int = 0
    candidate: int = 0
    bundled: Path | None = None
    """Folder of the answers that the domain brings."""


class Completion(BaseModel):
    """An answer and where it is from. Unknown figures are None, never 0."""

    model_config = ConfigDict(frozen=True)

    text: str
    source: Source
    model: str
    finish_reason: str | None = None
    prompt_tokens: int | None = None
    completion_tokens: int | None = None


class LLM(Protocol):
    """A language model. `complete` raises LLMError when there is no answer."""

    def complete(self, request: Request) -> Completion:
        """The answer to a request."""
        ...


def digest(messages: Sequence[Message]) -> str:
    """SHA-256 of the roles and texts of messages, as hexadecimal digits."""
    plain = json.dumps([[m.role, m.text] for m in messages], ensure_ascii=False)
    return hashlib.sha256(plain.encode("utf-8", "backslashreplace")).hexdigest()


def estimate_tokens(messages: Sequence[Message]) -> int:
    """A rough count of tokens: four characters each, and four tokens a message."""
    return sum(len(message.text) // 4 + 4 for message in messages)
