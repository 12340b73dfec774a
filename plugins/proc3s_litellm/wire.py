"""Messages as they go out, with marks for providers that cache what they are told to."""

import re
from collections.abc import Sequence
from typing import Any

from proc3s import Message

_TAKES_MARKS = re.compile(r"(anthropic|openrouter/anthropic|vertex_ai/claude)")
_MAY_TAKE_MARKS = re.compile(r"bedrock/.*anthropic\.claude")
_STABLE = ("system", "example")
_MARK = {"type": "ephemeral"}


def takes_marks(litellm: Any, model: str) -> bool:
    """Whether the provider caches up to a mark. Bedrock refuses marks for the models that cannot."""
    if _MAY_TAKE_MARKS.match(model):
        return bool(litellm.utils.supports_prompt_caching(model=model))
    return _TAKES_MARKS.match(model) is not None


def plain(messages: Sequence[Message]) -> list[dict[str, Any]]:
    """Role and text of each."""
    return [{"role": message.role, "content": message.text} for message in messages]


def marked(messages: Sequence[Message]) -> list[dict[str, Any]]:
    """The same, with a mark where the part ends that is equal for all tasks of a domain."""
    out = plain(messages)
    stable = next((k for k, m in enumerate(messages) if m.kind not in _STABLE), len(messages))
    if stable:
        last = out[stable - 1]
        last["content"] = [{"type": "text", "text": last["content"], "cache_control": _MARK}]
    return out
