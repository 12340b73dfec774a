"""Which parameter matters from which step of the plan on: found by running the program again."""

from collections.abc import Mapping

import numpy as np

from proc3s.domain.plan_batch import PlanBatch
from proc3s.search.sketch import Sketch

_BASES = (0.5, 0.2, 0.8)
_MOVES = (0.35, 0.65)
"""A parameter moves by these fractions of its range, round the end."""


def influence(sketch: Sketch) -> Mapping[str, int]:
    """The first step that each parameter changes, seen from three points of the space, in one crossing.

    A parameter that changes nothing there gets the length of the plan; where the program raises, 0.
    Raises SketchError if the program has to be stopped.
    """
    samplers, dim = sketch.space.samplers, sketch.space.dim
    rows, pairs, at = [], [], 0
    for base in _BASES:
        rows.append(np.full(dim, base))
        origin = len(rows) - 1
        at = 0
        for name, sampler in samplers.items():
            for move in _MOVES:
                row = np.full(dim, base)
                row[at : at + sampler.dim] = (base + move) % 1
                pairs.append((name, origin, len(rows)))
                rows.append(row)
            at += sampler.dim
    batch = sketch.plans(np.array(rows), 0)
    found = dict.fromkeys(samplers, np.iinfo(np.int64).max)
    for name, origin, moved in pairs:
        found[name] = min(found[name], _first_difference(batch, origin, moved))
    return {name: int(step) for name, step in found.items()}


def _first_difference(batch: PlanBatch, i: int, j: int) -> int:
    if i in batch.errors or j in batch.errors:
        return 0
    one, other = batch.plan(i), batch.plan(j)
    same = (step for step, (a, b) in enumerate(zip(one, other, strict=False)) if a != b)
    return next(same, min(len(one), len(other)))
