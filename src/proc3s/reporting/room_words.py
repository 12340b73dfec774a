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
    """`from 0.4 to 2.1 by 24 samples around the first plan`."""
    before, after, more = improved["room_before"], improved["room_after"], improved["samples"]
    tried = f"{count(int(more), 'sample')} around the first plan"
    if before is None or after is None or after <= before:
        return f"no more by {tried}"
    return f"from {before:.1f} to {after:.1f} by {tried}"
