"""What language models may cost: an account of calls, tokens and money, and the limits on it."""

import threading
from collections.abc import Callable
from typing import TypeVar

from pydantic import BaseModel, ConfigDict, Field

from proc3s.llm.errors import BudgetSpent, LLMError, LLMFault
from proc3s.llm.types import Completion, Price, Request, estimate_tokens
from proc3s.llm.usage import Usage

N = TypeVar("N", int, float)
_NOTHING = Usage(prompt_tokens=0, completion_tokens=0)
_FREE: frozenset[LLMFault] = frozenset(
    (
        "missing_key",
        "auth",
        "quota",
        "unknown_model",
        "context",
        "parameter",
        "no_answer",
        "rate_limit",
        "connection",
        "server",
    )
)
"""Faults after which nothing is charged: the provider did not begin an answer."""


class Budget(BaseModel):
    """Limits of a run; None is no limit."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)

    max_cost: float | None = Field(None, gt=0)
    """US dollars that live answers may cost"""
    max_tokens: int | None = Field(None, ge=1)
    """tokens that live prompts and answers may take"""
    max_calls: int | None = Field(None, ge=1)
    """live calls that may be made"""


class Spent(BaseModel):
    """Sums over answers; a sum is None if one of its parts is unknown."""

    model_config = ConfigDict(frozen=True)

    calls: int = 0
    prompt_tokens: int | None = 0
    completion_tokens: int | None = 0
    cost: float | None = 0.0
    """US dollars."""
    latency: float | None = 0.0
    """Seconds that the providers took; for recorded answers, when they were recorded."""

    def plus(self, other: "Spent") -> "Spent":
        """Both together."""
        return Spent(
            calls=self.calls + other.calls,
            prompt_tokens=_sum(self.prompt_tokens, other.prompt_tokens),
            completion_tokens=_sum(self.completion_tokens, other.completion_tokens),
            cost=_sum(self.cost, other.cost),
            latency=_sum(self.latency, other.latency),
        )


def spent_on(completion: Completion, calls: int) -> Spent:
    """What an answer cost."""
    return _spent(completion.usage, calls, completion.cost, completion.latency)


def _spent(usage: Usage, calls: int, cost: float | None, latency: float | None) -> Spent:
    return Spent(
        calls=calls,
        prompt_tokens=usage.prompt_tokens,
        completion_tokens=usage.completion_tokens,
        cost=cost,
        latency=latency,
    )


def _sum(one: N | None, other: N | None) -> N | None:
    return None if one is None or other is None else one + other


class Ledger(BaseModel):
    """What counts against a budget, with estimates for unknown figures; and what is known to be spent."""

    model_config = ConfigDict(frozen=True)

    calls: int = 0
    tokens: int = 0
    cost: float | None = 0.0
    """US dollars; None once the price of a call is unknown."""
    spent: Spent = Spent()


class Account:
    """Counts live calls against a budget; several threads may use it at once.

    A call is charged with an estimate before it is made, which its true figures replace where they are
    known. So a call is never counted as free because its provider reports no cost. `record` gets the
    ledger whenever it changed after a call; an account that begins with it goes on from there.
    """

    def __init__(
        self,
        budget: Budget,
        price: Price | None = None,
        ledger: Ledger | None = None,
        record: Callable[[Ledger], None] = lambda ledger: None,
    ) -> None:
        self._budget = budget
        self._price = price
        self._ledger = ledger or Ledger()
        self._record = record
        self._lock = threading.Lock()

    def charge(self, request: Request) -> Usage:
        """Before a call: count it, with its prompt. Raises BudgetSpent if that is more than is left."""
        prompt = Usage(prompt_tokens=estimate_tokens(request.messages), completion_tokens=0)
        tokens, cost = _tokens(prompt) or 0, self._cost_of(prompt) or 0.0
        budget = self._budget
        with self._lock:
            ledger = self._ledger
            self._check("--max-calls", budget.max_calls, ledger.calls, 1, "calls")
            self._check("--max-tokens", budget.max_tokens, ledger.tokens, tokens, "tokens")
            self._check("--max-cost", budget.max_cost, ledger.cost or 0.0, cost, "US dollars")
            self._add(1, tokens, cost, Spent())
        return prompt

    def settle(self, charged: Usage, completion: Completion) -> Completion:
        """After a call: put the true figures in place of the estimate, and the cost into the completion.

        If that is more than the budget allows, the answer says so among its notes.
        """
        completion = completion.model_copy(update={"cost": self._cost_of(completion.usage, completion)})
        prompt = charged.prompt_tokens or 0
        counted = completion.usage if _tokens(completion.usage) else _estimate(prompt, completion)
        with self._lock:
            cost = self._beyond(charged, self._cost_of(counted, completion))
            self._add(0, (_tokens(counted) or 0) - prompt, cost, spent_on(completion, 1))
            over = self._over()
            self._record(self._ledger)
        return completion.model_copy(update={"notes": (*completion.notes, *over)})

    def release(self, charged: Usage, error: LLMError) -> None:
        """After a call that failed: what was counted stays, else the estimate if work may have been done."""
        used = error.usage or (_NOTHING if error.fault in _FREE else Usage())
        tokens, cost = _tokens(used), self._cost_of(used)
        spent = _spent(used, 1, 0.0 if tokens == 0 else cost, 0.0)
        with self._lock:
            if tokens is None:
                self._add(0, 0, None if self._price is None else 0.0, spent)
            else:
                self._add(0, tokens - (_tokens(charged) or 0), self._beyond(charged, spent.cost), spent)
            self._record(self._ledger)

    def _beyond(self, charged: Usage, cost: float | None) -> float | None:
        """What a call cost beyond its estimate, US dollars; None if unknown."""
        return None if cost is None else cost - (self._cost_of(charged) or 0.0)

    def _add(self, calls: int, tokens: int, cost: float | None, spent: Spent) -> None:
        ledger = self._ledger
        self._ledger = Ledger(
            calls=ledger.calls + calls,
            tokens=ledger.tokens + tokens,
            cost=_sum(ledger.cost, cost),
            spent=ledger.spent.plus(spent),
        )

    def _over(self) -> list[str]:
        """What is spent beyond the budget, in words."""
        budget, ledger = self._budget, self._ledger
        limits = (
            ("--max-tokens", budget.max_tokens, ledger.tokens, "tokens"),
            ("--max-cost", budget.max_cost, ledger.cost, "US dollars"),
        )
        return [
            f"budget: {_number(spent)} {unit} are spent, more than {option} {_number(limit)}; no call follows"
            for option, limit, spent, unit in limits
            if limit is not None and spent is not None and spent > limit
        ]

    def _cost_of(self, usage: Usage, completion: Completion | None = None) -> float | None:
        """US dollars: what the provider says, else by the price; None if neither is known."""
        if completion is not None and completion.cost is not None:
            return completion.cost
        if self._price is None or usage.prompt_tokens is None or usage.completion_tokens is None:
            return None
        millionths = (
            usage.prompt_tokens * self._price.prompt + usage.completion_tokens * self._price.completion
        )
        return millionths / 1e6

    def _check(self, option: str, limit: float | None, spent: float, next_: float, unit: str) -> None:
        if limit is not None and spent + next_ > limit:
            raise BudgetSpent(
                f"budget: {_number(spent)} of {_number(limit)} {unit} are spent, and the next call takes "
                f"about {_number(next_)} more; {option} can be raised when the run is resumed"
            )


def _tokens(usage: Usage) -> int | None:
    if usage.prompt_tokens is None or usage.completion_tokens is None:
        return None
    return usage.prompt_tokens + usage.completion_tokens


def _estimate(prompt: int, completion: Completion) -> Usage:
    return Usage(prompt_tokens=prompt, completion_tokens=_length(completion))


def _length(completion: Completion) -> int:
    return sum(len(candidate.text) // 4 for candidate in completion.candidates)


def _number(value: float) -> str:
    return f"{value:,.6f}".rstrip("0").rstrip(".") if isinstance(value, float) else f"{value:,}"
