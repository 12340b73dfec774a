"""Several searches share one budget of samples."""

import math
from collections.abc import Sequence

from proc3s.search.search import Search


def race(searches: Sequence[Search], budget: int) -> None:
    """Divide `budget` samples among searches by successive halving, until one is solved.

    Every heat gets an equal part of what is left, shared equally; then the better half goes on. Heats run
    in order, so the outcome does not depend on clocks.
    """
    running, left = _open(searches), budget
    for heats in range(math.ceil(math.log2(max(len(running), 1))) + 1, 0, -1):
        for search in running:
            share = max(left // (heats * len(running)), 1)
            budget -= _advance(search, min(share, budget))
            if search.solution or search.broken_off:
                return
        left = budget
        running = _better_half(_open(running))
    while budget > 0 and (rest := _open(searches)):
        budget -= _advance(max(rest, key=lambda search: search.progress), budget)


def _open(searches: Sequence[Search]) -> list[Search]:
    return [search for search in searches if not search.over]


def _better_half(searches: Sequence[Search]) -> list[Search]:
    ranked = sorted(searches, key=lambda search: -search.progress)
    return ranked[: math.ceil(len(ranked) / 2)]


def _advance(search: Search, samples: int) -> int:
    """Let a search draw so many samples; gives how many it drew."""
    begun = len(search.trials)
    search.advance(samples)
    return len(search.trials) - begun
