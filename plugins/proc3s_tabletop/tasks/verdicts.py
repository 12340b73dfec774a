"""How judges count: a margin for each of the objects that are meant, and a score of them all."""

import math
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

from proc3s import Score
from proc3s_tabletop.tasks.final_table import Solid, listed

FEW = 2
"""More objects than this are counted where all is well, not listed."""


class Finding(NamedTuple):
    """How far one object is from being wrong, m, negative if it is, and what is wrong then.

    Infinite where no shift on the level makes it wrong, or right.
    """

    margin: float
    fault: str = ""


def verdict(
    chosen: Sequence[Solid], name: object, kind: str, find: Callable[[Solid], Finding], count: int | None
) -> Score:
    """How many of the chosen are right, of `count` or all, and what is wrong with the others.

    The margin is that of the last one needed.
    """
    if not chosen:
        return Score(False, f"there is no {name}")
    wanted = len(chosen) if count is None else count
    found = [(solid, find(solid)) for solid in chosen]
    margin = measured(nth_largest((finding.margin for _, finding in found), wanted))
    good = [solid for solid, finding in found if finding.margin >= 0]
    if len(good) >= wanted:
        return Score(True, f"{kind}: {listed(good) if len(good) <= FEW else f'{len(good)} ({name})'}", margin)
    wrong = "; ".join(f"{solid.says} {finding.fault}" for solid, finding in found if finding.margin < 0)
    return Score(False, f"{kind}: {len(good)} of {wanted} ({name}): {wrong}", margin)


def nth_largest(margins: Iterable[float], n: int) -> float:
    """The n-th largest; minus infinity of fewer than n, infinity where none is wanted."""
    ordered = sorted(margins, reverse=True)
    if n > len(ordered):
        return -math.inf
    return ordered[n - 1] if n > 0 else math.inf


def measured(margin: float) -> float | None:
    """A margin for a score: one that is infinite is none."""
    return margin if math.isfinite(margin) else None
