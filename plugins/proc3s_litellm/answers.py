"""Answers in the shape of OpenAI's protocol: contents in parts, refusals, calls of tools."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

from proc3s import Candidate, Usage

_TEXTS = (None, "text", "output_text")
"""Types of the parts that are the answer; all others are reasoning, pictures, calls."""
_TOKENS = (("prompt_tokens", "completion_tokens"), ("input_tokens", "output_tokens"))


def candidate(message: Mapping[str, Any], finish: str | None) -> Candidate:
    """The candidate of a message, whose content is a text, a part, or parts.

    One without a text says why in `refusal` or `finish_reason`.
    """
    parts = _parts(message.get("content"))
    text = "".join(_text(part) for part in parts)
    refusals = [message.get("refusal"), *(p.get("refusal") for p in parts if isinstance(p, Mapping))]
    refusal = next((r for r in refusals if isinstance(r, str) and r), None)
    if not text and (message.get("tool_calls") or message.get("function_call")):
        finish = "tool_calls"
    return Candidate(text=text, finish_reason=finish, refusal=refusal)


def _parts(content: Any) -> Sequence[Any]:
    if isinstance(content, list):
        return content
    return [] if content is None else [content]


def _text(part: Any) -> str:
    if isinstance(part, Mapping):
        said = part.get("text") if part.get("type") in _TEXTS else None
        part = said.get("value") if isinstance(said, Mapping) else said
    return part if isinstance(part, str) else ""


def readable(body: str | None) -> tuple[Candidate, ...]:
    """The candidates of an answer that litellm makes an error of, e.g. since its contents are in parts."""
    choices = _object(body).get("choices")
    if error_in(body) or not isinstance(choices, list):
        return ()
    found = [
        candidate(choice["message"], choice.get("finish_reason"))
        for choice in choices
        if isinstance(choice, Mapping) and isinstance(choice.get("message"), Mapping)
    ]
    return tuple(found) if any(_says_something(c) for c in found) else ()


def _says_something(found: Candidate) -> bool:
    return bool(found.text or found.refusal or found.finish_reason == "tool_calls")


def counted(body: str | None) -> Usage | None:
    """The tokens that an answer speaks of, whatever else is wrong with it; None if it speaks of none."""
    usage = _object(body).get("usage")
    for prompt, completion in _TOKENS:
        tokens = [usage.get(prompt), usage.get(completion)] if isinstance(usage, Mapping) else []
        if tokens and all(isinstance(t, int) and t >= 0 for t in tokens):
            return Usage(prompt_tokens=tokens[0], completion_tokens=tokens[1])
    return None


def model_in(body: str | None) -> str | None:
    """The model that an answer names."""
    name = _object(body).get("model")
    return name if isinstance(name, str) else None


def error_in(body: str | None) -> bool:
    """Whether an answer is an error that was sent as a success."""
    return bool(_object(body).get("error"))


def _object(body: str | None) -> Mapping[str, Any]:
    try:
        data = json.loads(body or "")
    except (ValueError, RecursionError):
        return {}
    return data if isinstance(data, dict) else {}
