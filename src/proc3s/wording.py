"""Numbers in sentences: one thing, two things, and sums of which a part is not known."""

from collections.abc import Sequence


def count(number: int, what: str) -> str:
    """`1 call`, `2 calls`."""
    return f"{number:,} {what}" if number == 1 else f"{number:,} {what}s"


def total(parts: Sequence[float | None], form: str) -> str:
    """Their sum; at least that of the known ones if a part is not known, `?` if none is."""
    known = [part for part in parts if part is not None]
    if parts and not known:
        return "?"
    text = form.format(sum(known))
    return text if len(known) == len(parts) else f"at least {text}"
