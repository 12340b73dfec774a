"""Several searches share one budget of samples."""

import math
from collections.abc import Sequence

from proc3s.search.search import Search


def race(searches: Sequence[Search], budget: int) -> None:
    """Divide `budget` samples among searches by successive halving, until one is solved.

    Every heat gets an equal part of what is left, shared equally; then the better half goes on. Heats run
    in order, so the outcome does not depend on clocks.
    """
    running, left = [search for search in searches if not search.over], budget
    for heats in range(math.ceil(math.log2(max(len(running), 1))) + 1, 0, -1):
        for search in running:
            begun = len(search.trials)
            search.advance(min(max(left // (heats * len(running)), 1), budget))
            budget -= len(search.trials) - begun
            if search.solution or search.broken_off:
                return
        left = budget
        alive = sorted((s for s in running if not s.over), key=lambda search: -search.progress)
        running = alive[: math.ceil(len(alive) / 2)]
    while budget > 0 and (left_out := [search for search in searches if not search.over]):
        best = max(left_out, key=lambda search: search.progress)
        begun = len(best.trials)
        best.advance(budget)
        budget -= len(best.trials) - begun
