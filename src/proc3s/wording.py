"""Numbers in sentences: one thing, two things, measures, and sums of which a part is not known."""

import math
from collections.abc import Sequence
from decimal import Decimal
from typing import Any

_DECIMALS = 9
"""What arithmetic leaves of a zero reads as zero."""


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


def plain(value: float, digits: int = 2) -> str:
    """A measure as people write it: so many digits, and all of those before the point, but no exponent."""
    if not math.isfinite(value):
        return "infinity" if value > 0 else str(value)
    if abs(value) >= 10**digits:
        return f"{value:.0f}"
    return f"{Decimal(f'{value + 0.0:.{digits}g}'):f}"


def number(value: Any) -> str:
    """A coordinate to four digits and nine decimals, also within a point or pose; anything else as it is."""
    if isinstance(value, list | tuple):
        return f"({', '.join(map(number, value))})"
    return plain(round(value, _DECIMALS), 4) if isinstance(value, float) else str(value)
