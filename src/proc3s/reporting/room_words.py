"""What is said of the room of a plan: on the console, by `explain` and in reports."""

from collections.abc import Iterator, Mapping
from typing import Any

from proc3s.domain.room import Room
from proc3s.wording import count


def room_lines(room: Mapping[str, Any] | None, improved: Mapping[str, Any] | None) -> Iterator[str]:
    """A line for the room of a plan, and one for what was tried to make it larger, if that is known."""
    if room:
        yield f"room     {Room(**room)}"
    if improved:
        yield f"improved {improvement(improved)}"


def improvement(improved: Mapping[str, Any]) -> str:
    """`from 0.4 to 2.1 by 24 samples around the first plan; it passes its rehearsals`."""
    before, after, more = improved["room_before"], improved["room_after"], improved["samples"]
    tried = f"{count(int(more), 'sample')} around the first plan"
    if before is None or after is None or after <= before:
        words = f"not: no roomier plan among {tried}"
    else:
        words = f"from {before:.1f} to {after:.1f} by {tried}"
    held = improved.get("held")
    if held is not None:
        words += f"; it {'passes' if held else 'does not pass'} its rehearsals"
    if ended := improved.get("broken_off"):
        words += f"; ended early: {ended}"
    return words
