"""What language models may cost: an account of calls, tokens and money, and the limits on it."""

import threading
from collections.abc import Iterable
from typing import Annotated, TypeVar

from pydantic import BaseModel, ConfigDict, Field

from proc3s.errors import BudgetSpent
from proc3s.llms import Completion, Price, Request, Usage, estimate_tokens

N = TypeVar("N", int, float)
Limit = Annotated[float, Field(gt=0)]


class Budget(BaseModel):
    """Limits of a run; None is no limit."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    max_cost: Limit | None = None
    """US dollars."""
    max_tokens: Annotated[int, Field(ge=1)] | None = None
    """Tokens of prompts and answers together."""
    max_calls: Annotated[int, Field(ge=1)] | None = None


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


def total(completions: Iterable[Completion]) -> Spent:
    """What these answers cost when they were given; a text that no model wrote costs nothing."""
    given = [c for c in completions if c.source in ("live", "recorded")]
    if not given:
        return Spent()
    return Spent(
        calls=sum(c.attempts for c in given),
        prompt_tokens=_sum(c.usage.prompt_tokens for c in given),
        completion_tokens=_sum(c.usage.completion_tokens for c in given),
        cost=_sum(c.cost for c in given),
        latency=_sum(c.latency for c in given),
    )


def _sum(values: Iterable[N | None]) -> N | None:
    found = list(values)
    known = [value for value in found if value is not None]
    return sum(known[1:], start=known[0]) if known and len(known) == len(found) else None


class Account:
    """Counts live calls against a budget; several threads may use it at once.

    A call is charged with an estimate before it is made, which its true figures replace where they are
    known. So nothing is ever counted as free because a provider does not say what it cost.
    """

    def __init__(self, budget: Budget, price: Price | None = None, spent: Iterable[Completion] = ()) -> None:
        self._budget = budget
        self._price = price
        self._lock = threading.Lock()
        self._calls, self._tokens, self._cost = 0, 0, 0.0
        for completion in spent:
            self._calls += completion.attempts
            self._tokens += _tokens(completion.usage) or _length(completion)
            self._cost += self._cost_of(completion.usage, completion) or 0.0

    def charge(self, request: Request) -> Usage:
        """Before a call: count it, with its prompt. Raises BudgetSpent if that is more than is left."""
        prompt = Usage(prompt_tokens=estimate_tokens(request.messages), completion_tokens=0)
        tokens, cost = prompt.prompt_tokens or 0, self._cost_of(prompt) or 0.0
        with self._lock:
            self._check("--max-calls", self._budget.max_calls, self._calls, 1, "calls")
            self._check("--max-tokens", self._budget.max_tokens, self._tokens, tokens, "tokens")
            self._check("--max-cost", self._budget.max_cost, self._cost, cost, "US dollars")
            self._calls += 1
            self._tokens += tokens
            self._cost += cost
        return prompt

    def settle(self, charged: Usage, completion: Completion) -> Completion:
        """After a call: put the true figures in place of the estimate, and the cost into the completion."""
        prompt = charged.prompt_tokens or 0
        counted = completion.usage if _tokens(completion.usage) else _estimate(prompt, completion)
        cost = self._cost_of(counted, completion)
        with self._lock:
            self._tokens += (_tokens(counted) or 0) - prompt
            self._cost += (cost or 0.0) - (self._cost_of(charged) or 0.0)
        known = self._cost_of(completion.usage, completion)
        return completion.model_copy(update={"cost": known})

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
