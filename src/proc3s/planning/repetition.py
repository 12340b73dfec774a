"""A plan carried out again and again in the execution world, with other small errors each time."""

from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass
from typing import Any

import numpy as np

from proc3s.domain.values import Plan
from proc3s.domain.world import World, make_world
from proc3s.errors import UsageError, blame
from proc3s.search.problem import Problem
from proc3s.search.rollout import carry_out, judge

SEED = 2**30
"""Of errors, with the seed of the problem and the number of the time; other ones than those of rehearsals."""
MOST_MM = 50
"""What is further off is not a small error."""


@dataclass(frozen=True)
class Repetition:
    """What became of a plan one time: the judge's verdict (None without a judge) and its reason."""

    reached: bool | None
    reason: str


def repeat(problem: Problem, plan: Plan, times: int, error_mm: float | None = None) -> Iterator[Repetition]:
    """Carry a plan out so many times; time k has the same errors, however many times there are.

    Things are up to `error_mm` off, see `World.misplace`; None: disturbed, see `World.disturb`. Without
    errors (0) every time is the same, so there is one. Raises UsageError in a world without such errors.
    """
    spec = problem.domain.spec
    with closing(make_world(problem.domain, spec.execution or spec.world)) as world:
        for k in range(repetitions(times, error_mm)):
            _let_err(world, np.random.default_rng([SEED, problem.seed, k]), error_mm)
            with blame("world"):
                _, final = carry_out(world, problem, plan, stop=False)
            score, reason = judge(problem, final, plan)
            yield Repetition(score.reached if score else None, reason)


def _let_err(world: World[Any], rng: np.random.Generator, error_mm: float | None) -> None:
    if error_mm is None:
        world.disturb(rng)
    elif error_mm:
        world.misplace(rng, error_mm / 1e3)


def repetitions(times: int, error_mm: float | None) -> int:
    """How often a plan is carried out that is to be so many times: once without errors."""
    return 1 if error_mm == 0 else times


def require_error(error_mm: float) -> float:
    """The error if it is one. Raises UsageError for one that is negative, no number, or too large."""
    if not 0 <= error_mm <= MOST_MM:
        raise UsageError(f"--error: an error is 0 to {MOST_MM} mm, not {error_mm:g}")
    return error_mm
