"""What a program changes of the one before it. Programs are compared as text; nothing of them runs."""

import difflib
import re
from collections.abc import Mapping

from pydantic import BaseModel, ConfigDict

from proc3s.sandbox.text import lines_of

_DEFINITION = re.compile(r"(?:async\s+)?(?:def|class)\s+(\w+)")


class Rebound(BaseModel):
    """A parameter that is sampled otherwise than before."""

    model_config = ConfigDict(frozen=True)

    parameter: str
    old: str
    new: str


class Change(BaseModel):
    """The difference of two programs: lines, where they stand, and the open parameters."""

    model_config = ConfigDict(frozen=True)

    since_round: int
    since_candidate: int
    lines_added: int
    lines_removed: int
    parts: tuple[str, ...]
    """Functions and classes with changed lines, in order; those that are new or gone as well."""
    new_parameters: Mapping[str, str] = {}
    gone_parameters: tuple[str, ...] = ()
    rebound: tuple[Rebound, ...] = ()
    diff: str
    """Unified, with two lines around each change."""


def line_changes(old: str, new: str) -> tuple[int, int, tuple[str, ...]]:
    """Lines added, lines removed, and the functions and classes that they stand in."""
    before, after = lines_of(old), lines_of(new)
    where_before, where_after = _places(before), _places(after)
    added = removed = 0
    parts: dict[str, None] = {}
    matcher = difflib.SequenceMatcher(None, before, after, autojunk=False)
    for tag, i, i_end, j, j_end in matcher.get_opcodes():
        if tag == "equal":
            continue
        removed += i_end - i
        added += j_end - j
        places = where_before[i:i_end] + where_after[j:j_end]
        lines = before[i:i_end] + after[j:j_end]
        parts |= dict.fromkeys(p for p, line in zip(places, lines, strict=True) if p and line.strip())
    return added, removed, tuple(parts)


def _places(lines: list[str]) -> list[str]:
    """For each line the outermost function or class that it stands in, empty outside of all."""
    places, current = [], ""
    for line in lines:
        if line[:1].strip():  # it begins in the first column
            found = _DEFINITION.match(line)
            current = found[1] if found else current if line[0] in ")]}#" else ""
        places.append(current)
    return places


def unified(old: str, new: str, old_name: str, new_name: str) -> str:
    """The unified diff of two programs."""
    lines = difflib.unified_diff(lines_of(old), lines_of(new), old_name, new_name, lineterm="", n=2)
    return "\n".join(lines)


def rebound(old: Mapping[str, str], new: Mapping[str, str]) -> tuple[Rebound, ...]:
    """Parameters of both programs that the newer one samples otherwise."""
    return tuple(
        Rebound(parameter=name, old=old[name], new=text)
        for name, text in new.items()
        if name in old and old[name] != text
    )
