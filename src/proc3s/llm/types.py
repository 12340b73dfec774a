"""Language models as typed data: messages in, candidates out. The backends are plugins."""

import hashlib
import json
from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Literal

from pydantic import Field

from proc3s.llm.usage import FrozenData, Usage

Source = Literal["live", "recorded", "authored", "manual", "none"]


Role = Literal["system", "user", "assistant"]


Kind = Literal["system", "example", "task", "reply", "feedback"]


Effort = Literal["minimal", "low", "medium", "high"]


class Message(FrozenData):
    """One message of a conversation; `kind` says which part of it this is.

    System message and examples are the same for every task of a domain, and always come first.
    """

    role: Role
    kind: Kind
    text: str


class Sampling(FrozenData):
    """How answers are drawn. None leaves it to the provider."""

    temperature: float | None = None
    """0 for the likeliest answer; most providers take up to 1 or 2."""
    seed: int | None = None
    n: int = Field(default=1, ge=1)
    """Candidates wanted in one answer."""
    max_tokens: int | None = Field(default=None, ge=1)
    """Longest answer."""
    reasoning_effort: Effort | None = None

    def without(self, names: Iterable[str]) -> "Sampling":
        """The same, with these parameters left to the provider."""
        return self.model_copy(update={name: type(self).model_fields[name].default for name in names})


class Request(FrozenData):
    """What is asked, and which answer of which run it is: that is how recorded answers are found."""

    messages: tuple[Message, ...]
    task: str
    """`domain/task`."""
    method: str
    template: str
    """Name of the method's prompt template; methods that share it share their authored answers."""
    seed: int
    """Seed of the run."""
    round: int = 0
    candidate: int = 0
    """Number of the first candidate that is wanted; `sampling.n` of them in all."""
    sampling: Sampling = Sampling()
    bundled: Path | None = None
    """Folder of the answers that the domain brings."""


class Candidate(FrozenData):
    """One answer to a request; `finish_reason` "length" says that it was cut off."""

    text: str
    finish_reason: str | None = "stop"
    refusal: str | None = None
    """What the model said instead of an answer, if it refused to give one."""


class Completion(FrozenData):
    """What a call brought: at least one candidate, and where it is from. Unknown figures are None."""

    candidates: tuple[Candidate, ...]
    source: Source = "live"
    model: str
    """The model that answered, as it calls itself."""
    model_asked: str | None = None
    """The model that was asked for, where that may be another."""
    usage: Usage = Usage()
    cost: float | None = Field(default=None, ge=0)
    """US dollars."""
    latency: float | None = None
    """Seconds that the provider took when it was asked; a replay keeps the figure of then."""
    answered: str | None = None
    """When a recorded answer was given, ISO 8601."""
    stale: bool = False
    """It was given to another prompt than that of the run (`-L stale=accept`)."""
    attempts: int = 1
    """Calls it took, those that failed included."""
    dropped: tuple[str, ...] = ()
    """Parameters of `Sampling` that the provider does not take."""
    sampling: Sampling | None = None
    """The parameters in effect: what was asked for, without what was dropped."""
    notes: tuple[str, ...] = ()
    """Notes for the user."""

    @property
    def text(self) -> str:
        """The first candidate's."""
        return self.candidates[0].text


def answer(text: str, model: str, source: Source = "live") -> Completion:
    """The plainest completion: one whole text."""
    return Completion(candidates=(Candidate(text=text),), source=source, model=model)


class Price(FrozenData):
    """US dollars for a million tokens."""

    prompt: float = Field(ge=0)
    completion: float = Field(ge=0)


class LLM(ABC):
    """A language model. Backends inherit this and write `complete`; failures are retried around it."""

    live = True
    """Whether asking costs: calls, tokens, money."""
    bundled_only = False
    """Whether it has but the answers that domains bring, which fit the tasks' own instructions."""
    price: Price | None = None
    """None if it is not known."""

    def prepare(self) -> None:  # noqa: B027 - there is mostly nothing to prepare
        """Do slow preparations before the first call, e.g. import a library; may be called repeatedly.

        Counts neither as time of the model nor against the time limit of a call. Raises LLMError.
        """

    @abstractmethod
    def complete(self, request: Request) -> Completion:
        """One call. Raises LLMError, whose `fault` says whether trying again may help.

        If fewer than `request.sampling.n` candidates come back, the missing ones are asked for one by one.
        """


class WrappedLLM(LLM):
    """An LLM around another one, which it prepares and costs as."""

    def __init__(self, llm: LLM) -> None:
        self._llm = llm
        self.live, self.bundled_only = llm.live, llm.bundled_only

    def prepare(self) -> None:
        """Prepare the other one."""
        self._llm.prepare()


def digest(messages: Sequence[Message]) -> str:
    """SHA-256 of the roles and texts of messages, as hexadecimal digits."""
    plain = json.dumps([[m.role, m.text] for m in messages], ensure_ascii=False)
    return hashlib.sha256(plain.encode("utf-8", "backslashreplace")).hexdigest()


def estimate_tokens(messages: Sequence[Message]) -> int:
    """A rough count of tokens: four characters each, and four tokens a message."""
    return sum(len(message.text) // 4 + 4 for message in messages)
