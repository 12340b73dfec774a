"""How every search begins: a solver over the parameters of a sketch, with random numbers of its own."""

import dataclasses
from collections.abc import Callable, Sequence
from typing import TypeAlias

import numpy as np

from proc3s.domain.samplers import Space
from proc3s.search.evaluator import Evaluator
from proc3s.search.influence import influence
from proc3s.search.search import Search
from proc3s.search.solver import Solver
from proc3s.search.trial import Trial

MakeSolver: TypeAlias = Callable[[Space, int, np.random.Generator], Solver]
"""A solver of a space, for a budget of samples, with a generator of its own."""


def start_search(
    evaluator: Evaluator,
    make_solver: MakeSolver,
    budget: int,
    key: tuple[int, ...] = (0,),
    report: Callable[[Sequence[Trial]], None] = lambda trials: None,
    check: Callable[[], None] = lambda: None,
) -> Search:
    """A search that has not drawn a sample yet; `report` hears of its trials, `check` may break it off.

    The seed of the problem and `key` decide what is drawn: no search draws the numbers that made the scene.
    """
    space = space_of(evaluator)
    seed = np.random.SeedSequence(evaluator.problem.seed, spawn_key=key)
    return Search(space, make_solver(space, budget, np.random.default_rng(seed)), evaluator, report, check)


def space_of(evaluator: Evaluator) -> Space:
    """The open parameters, with what a solver may find out about them: the first step that each changes."""
    return dataclasses.replace(evaluator.sketch.space, probe=lambda: influence(evaluator.sketch))
