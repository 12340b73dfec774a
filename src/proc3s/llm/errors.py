"""Errors of asking a language model."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar, Literal

if TYPE_CHECKING:
    from proc3s.llm.usage import Usage
from proc3s.errors import Proc3sError, Stopped

LLMFault = Literal[
    "missing_key",  # found before the call
    "auth",
    "quota",  # paid-for tokens are used up
    "unknown_model",
    "context",  # the conversation is too long for the model
    "filtered",
    "cut_off",  # the answer is longer than max_tokens
    "no_answer",  # nothing was recorded for this request, or for another prompt
    "rate_limit",
    "timeout",
    "connection",
    "server",
    "broken",  # not what the protocol promises
    "empty",
    "parameter",  # the provider refuses a parameter; without it the same request may succeed
    "other",
]


TRANSIENT: frozenset[LLMFault] = frozenset(
    {"rate_limit", "timeout", "connection", "server", "broken", "empty"}
)
"""Faults after which the same request may succeed."""


class LLMError(Proc3sError):
    """The language model could not be asked or did not answer (exit code 3).

    `fault` decides what happens next; `retry_after` are the seconds that the provider asks to wait, `usage`
    what it counted all the same. With fault "parameter", `parameters` are the fields of `Sampling` that it
    refuses; none if the backend words the same request otherwise from now on.
    """

    exit_code: ClassVar[int] = 3
    stopped: ClassVar[Stopped] = "llm"

    def __init__(
        self,
        message: str,
        fault: LLMFault = "other",
        retry_after: float | None = None,
        usage: "Usage | None" = None,
        parameters: Sequence[str] = (),
    ) -> None:
        super().__init__(message)
        self.fault: LLMFault = fault
        self.retry_after = retry_after
        self.usage = usage
        self.parameters = tuple(parameters)


class BudgetSpent(Proc3sError):
    """What may be spent on language models is spent; the run ends with what it has (exit code 1)."""

    exit_code: ClassVar[int] = 1
    stopped: ClassVar[Stopped] = "budget"


class Pending(Proc3sError):
    """An answer is to be given by a person later; the run can be continued then (exit code 4)."""

    exit_code: ClassVar[int] = 4
    stopped: ClassVar[Stopped] = "pending"
