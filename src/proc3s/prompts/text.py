"""Texts of prompts: states as a language model reads them, and the Python that a prompt names."""

import dataclasses
import re
from typing import Any

from proc3s.domain.source_text import source_text
from proc3s.domain.state import State

_PYTHON = re.compile(r"\bPython \d+\.\d+\b")


def for_any_python(text: str) -> str:
    """A prompt without the version of Python that it names: that of the machine, not of the template."""
    return _PYTHON.sub("Python", text)


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
