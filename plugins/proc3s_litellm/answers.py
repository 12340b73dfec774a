"""Answers in the shape of OpenAI's protocol: contents in parts, refusals, calls of tools."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

from proc3s import Candidate, Usage

_TEXTS = (None, "text", "output_text")
"""Types of the parts that are the answer; all others are reasoning, pictures, calls."""
_BROKEN_OFF = {"length": "length", "max_tokens": "length", "max_output_tokens": "length", "error": "error"}
"""Ends in the middle, which litellm may not know in this spelling, and then takes for a whole answer."""
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
        candidate(choice["message"], end)
        for choice, end in zip(choices, finishes(body), strict=True)
        if isinstance(choice, Mapping) and isinstance(choice.get("message"), Mapping)
    ]
    return tuple(found) if any(_says_something(c) for c in found) else ()


def _says_something(found: Candidate) -> bool:
    return bool(found.text or found.refusal or found.finish_reason == "tool_calls")


def counted(body: str | None) -> Usage | None:
    """The tokens that an answer speaks of, whatever else is wrong with it; None if it speaks of none."""
    usage = _object(body).get("usage")
    if not isinstance(usage, Mapping):
        return None
    for prompt, completion in _TOKENS:
        asked, answered = tokens(usage.get(prompt)), tokens(usage.get(completion))
        if asked and answered is not None:
            return Usage(prompt_tokens=asked, completion_tokens=answered)
    return None


def tokens(number: Any) -> int | None:
    """A number of tokens, or None for what cannot be one."""
    return number if isinstance(number, int) and not isinstance(number, bool) and number >= 0 else None


def finishes(body: str | None, known: Sequence[Any] | None = None) -> list[str]:
    """Why each candidate ended: as litellm knows, unless that makes a whole answer of a broken one."""
    choices = _object(body).get("choices")
    listed = choices if isinstance(choices, list) else []
    sent = [c.get("finish_reason") if isinstance(c, Mapping) else None for c in listed]
    known = sent if known is None else known
    if len(sent) != len(known):
        sent = list(known)
    return [
        _BROKEN_OFF.get(str(s).lower()) or (k if isinstance(k, str) else "stop")
        for s, k in zip(sent, known, strict=True)
    ]


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
