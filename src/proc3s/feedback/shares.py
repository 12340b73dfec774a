"""Shares of samples: honest, and stable where a run with a few samples more would say the same."""

from collections.abc import Sequence

_STEP = 5
NEARLY_ALL = 99
"""Stands for more than 95 percent and not all."""


def shares(counts: Sequence[float], whole: float, room: int = 100) -> list[int]:
    """Percents of counts that exclude each other, rounded to 5, together no more than `room`.

    0 stands for less than 5 percent, `NEARLY_ALL` for more than 95 but not all. Where rounding makes the sum
    too large, those that it raised most are rounded down.
    """
    exact = [100 * count / whole for count in counts]
    rounded = [_STEP * round(percent / _STEP) for percent in exact]
    raised = [i for i, percent in enumerate(exact) if rounded[i] > percent]
    raised.sort(key=lambda i: (round(exact[i] - rounded[i], 6), -i))  # of equals the last
    while sum(rounded) > room and any(rounded):
        lowered = raised.pop(0) if raised else rounded.index(max(rounded))
        rounded[lowered] -= _STEP
    whole -= 1e-9 * whole
    return [NEARLY_ALL if r == 100 and c < whole else r for r, c in zip(rounded, counts, strict=True)]


def portion(share: int) -> str:
    """A share in words and figures."""
    return {0: "under 5 %", NEARLY_ALL: "over 95 %"}.get(share, f"{share} %")
