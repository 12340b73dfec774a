"""The most that a run may ask of a model and pay for, said before the first call."""

from dataclasses import dataclass

from proc3s.llm.budget import Budget
from proc3s.llm.types import Price, estimate_tokens
from proc3s.planning.proposals import Question
from proc3s.prompts.conversation import conversation
from proc3s.specs.parts import MethodSpec, PresetSpec
from proc3s.wording import count

_FEEDBACK = 2000
"""Upper bound on the tokens of one round's feedback, as measured."""


@dataclass(frozen=True)
class Bound:
    """Upper bounds: calls that bring an answer, their tokens, US dollars; None where there is no bound."""

    calls: int = 0
    tokens: int | None = 0
    cost: float | None = 0.0

    def plus(self, other: "Bound", times: int = 1) -> "Bound":
        """Both together, the other one so many times."""
        unknown = self.tokens is None or other.tokens is None
        unpriced = self.cost is None or other.cost is None
        return Bound(
            self.calls + times * other.calls,
            None if unknown else (self.tokens or 0) + times * (other.tokens or 0),
            None if unpriced else (self.cost or 0.0) + times * (other.cost or 0.0),
        )


def most_questions(method: MethodSpec, preset: PresetSpec) -> int:
    """The first question, one for each feedback round, and for each of these the repairs of the preset."""
    return (method.rounds + 1) * (preset.repairs + 1) if method.rounds else 1


def bound_of(question: Question, price: Price | None) -> Bound:
    """The most that a run may take that asks this question.

    Tokens are bounded where an answer is (`-L max_tokens=N`), with prompts as long as they may get.
    """
    prompter, sampling = question.prompter, question.sampling
    questions = most_questions(prompter.method, prompter.preset)
    calls = questions * sampling.n
    if sampling.max_tokens is None:
        return Bound(calls, None, None)
    first = estimate_tokens(conversation(prompter, question.problem, ()))
    answered = calls * sampling.max_tokens
    longer = (sampling.max_tokens + _FEEDBACK) * questions * (questions - 1) // 2
    asked = sampling.n * (questions * first + longer)
    cost = None if price is None else (asked * price.prompt + answered * price.completion) / 1e6
    return Bound(calls, asked + answered, cost)


def in_words(bound: Bound, budget: Budget) -> str:
    """The bounds, or the limits of the budget where those are lower, in a sentence without its subject."""
    calls, limits = bound.calls, [budget.max_cost, budget.max_tokens]
    said = f"at most {count(calls, 'call')}"
    if budget.max_calls is not None and budget.max_calls < calls:
        said = f"at most {count(budget.max_calls, 'call')} (--max-calls)"
    parts = [said, *_limited(bound, budget)]
    if bound.tokens is None and not any(limits):
        parts.append(
            "tokens and cost without a limit (-L max_tokens=N bounds an answer, --max-cost all of them)"
        )
    return ", ".join(parts) + "; calls that fail or are cut off are repeated"


def _limited(bound: Bound, budget: Budget) -> list[str]:
    """What is known of tokens and dollars."""
    parts = []
    if budget.max_tokens is not None and budget.max_tokens < (bound.tokens or budget.max_tokens + 1):
        parts.append(f"{budget.max_tokens:,} tokens (--max-tokens)")
    elif bound.tokens is not None:
        parts.append(f"about {bound.tokens:,} tokens")
    if budget.max_cost is not None and (bound.cost is None or budget.max_cost < bound.cost):
        parts.append(f"${budget.max_cost:g} (--max-cost)")
    elif bound.cost is not None:
        parts.append(f"about ${bound.cost:.2f}")
    elif bound.tokens is not None:
        parts.append("at an unknown price")
    return parts
