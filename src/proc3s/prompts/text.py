"""States as a language model reads them."""

import dataclasses
from typing import Any

from proc3s.domain.source_text import source_text
from proc3s.domain.state import State


def state_text(state: State, decimals: int = 2) -> str:
    """A state as the LLM reads it: the call that builds it, one object a line, numbers rounded."""
    lines = [f"{type(state).__name__}("]
    for item in dataclasses.fields(state):
        lines += _field_lines(item.name, getattr(state, item.name), decimals)
    return "\n".join([*lines, ")"])


def _field_lines(name: str, value: Any, decimals: int) -> list[str]:
    if isinstance(value, tuple) and value:
        return [f"    {name}=[", *(f"        {source_text(v, decimals)}," for v in value), "    ],"]
    if isinstance(value, dict) and value:
        inside = (f"        {k!r}: {source_text(v, decimals)}," for k, v in value.items())
        return [f"    {name}={{", *inside, "    },"]
    return [f"    {name}={source_text(value, decimals)},"]
