"""Whether an answer is complete, truncated, filtered or empty; and whether the provider cut its prompt."""

from proc3s.llm.errors import LLMError
from proc3s.llm.types import Candidate, Completion, Request, estimate_tokens

_PARTS = frozenset({"length", "content_filter", "error"})
"""Finish reasons of incomplete answers."""
_TOOLS = frozenset({"tool_calls", "function_call"})


def whole(completion: Completion) -> Completion | None:
    """The completion with the candidates that have all of their text; None without any."""
    kept = tuple(c for c in completion.candidates if c.text.strip() and c.finish_reason not in _PARTS)
    return completion.model_copy(update={"candidates": kept}) if kept else None


def uncut(completion: Completion) -> Completion:
    """A replayed answer without its incomplete candidates. Raises LLMError if none is complete."""
    kept = tuple(candidate for candidate in completion.candidates if not _cut(candidate))
    if not kept:
        raise cut_off(completion)
    return completion.model_copy(update={"candidates": kept})


def cut_off(completion: Completion) -> LLMError:
    """The error of an answer that is longer than it may be."""
    tokens = completion.usage.completion_tokens
    where = f" after {tokens:,} tokens" if tokens else ""
    return LLMError(
        f"{_who(completion)}: the answer was cut off{where}; raise -L max_tokens=N, or choose a model that "
        "writes less",
        "cut_off",
    )


def room(request: Request, completion: Completion) -> int:
    """The max_tokens that the answer exceeded."""
    return request.sampling.max_tokens or completion.usage.completion_tokens or 4096


def refuse_empty(completion: Completion) -> None:
    """Raises LLMError that names why, if no candidate has a text, be it a part of one."""
    if whole(completion) or any(_cut(candidate) for candidate in completion.candidates):
        return
    refusals = [c.refusal for c in completion.candidates if c.refusal]
    if refusals:
        said = " ".join(refusals[0].split())[:300]
        raise LLMError(
            f"{_who(completion)}: the model refused ({said}); change the instruction, or choose another "
            "--llm",
            "filtered",
        )
    if any(_held_back(candidate) for candidate in completion.candidates):
        raise LLMError(
            f"{_who(completion)}: the provider's content filter held the answer back; change the "
            "instruction, or choose another --llm",
            "filtered",
        )
    if any(candidate.finish_reason == "error" for candidate in completion.candidates):
        raise LLMError(f"{_who(completion)}: the answer breaks off with an error of the provider", "broken")
    if any(candidate.finish_reason in _TOOLS for candidate in completion.candidates):
        raise LLMError(
            f"{_who(completion)}: the model called a tool instead of answering, though none was offered; "
            "choose another --llm",
        )
    what = "the answer is empty" if completion.candidates else "the answer holds no candidates"
    raise LLMError(f"{_who(completion)}: {what}; choose another --llm if it stays so", "empty")


def prompt_was_cut(request: Request, completion: Completion) -> tuple[str, ...]:
    """A note if the provider counted less than half of the tokens that the prompt must have."""
    expected, counted = estimate_tokens(request.messages), completion.usage.prompt_tokens
    if counted is None or 2 * counted >= expected:
        return ()
    return (
        f"the server counted {counted:,} tokens of a prompt of about {expected:,}: it seems to cut prompts; "
        "raise its context length",
    )


def _who(completion: Completion) -> str:
    return completion.model_asked or completion.model


def _cut(candidate: Candidate) -> bool:
    return candidate.finish_reason == "length"


def _held_back(candidate: Candidate) -> bool:
    """Whether a filter let none or only a part of the text pass."""
    return candidate.finish_reason == "content_filter"
