"""CMA-ES on graded margins (Hansen and Ostermeier 2001), with a share of uniform draws."""

import math
from typing import TYPE_CHECKING

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from proc3s import FloatArray, Space, Trial
from proc3s_solvers.batches import Batches, BatchSearch, furthest
from proc3s_solvers.sampling import BELOW_ONE

if TYPE_CHECKING:
    from cma import CMAEvolutionStrategy


class CmaOptions(BaseModel):
    """A run of the strategy starts at the best uniform draw and ends when it no longer makes progress."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    first: int = Field(default=32, ge=1, description="uniform samples before the first run")
    population: int = Field(default=24, ge=4, description="samples of a generation; doubles at a restart")
    largest: int = Field(default=96, ge=4, description="samples of a generation at most")
    sigma: float = Field(default=0.2, gt=0, le=1, description="deviation of the first generation, in ranges")
    patience: int = Field(default=8, ge=1, description="generations without progress that end a run")
    uniform: float = Field(default=0.25, ge=0.01, le=0.9, description="share of samples drawn uniformly")


class Cma(BatchSearch):
    """Evolves a normal distribution towards samples that come further, then violate less; inside the cube."""

    def __init__(self, space: Space, budget: int, rng: np.random.Generator, options: CmaOptions) -> None:
        super().__init__()
        self._dim = space.dim
        self._rng = rng
        self._options = options

    def _search(self) -> Batches[None]:
        population = min(self._options.population, self._options.largest)
        start = furthest((yield self._rng.random((self._options.first, self._dim))))
        while True:
            start = yield from self._run(start, population)
            population = min(2 * population, self._options.largest)

    def _run(self, start: Trial, population: int) -> Batches[Trial]:
        """One run of the strategy; returns the best uniform draw that was made meanwhile."""
        strategy = evolution(np.array(start.u), self._options.sigma, population, self._rng)
        share = self._options.uniform
        extra = math.ceil(population * share / (1 - share))
        best, idle, drawn = start.progress, 0, list[Trial]()
        while idle < self._options.patience and not strategy.stop():
            points = strategy.ask()
            evolved = np.clip(np.array(points)[:, : self._dim], 0.0, BELOW_ONE)
            trials = yield np.vstack([evolved, self._rng.random((extra, self._dim))])
            scores = [trial.progress for trial in trials[:population]]
            strategy.tell(points, [-score for score in scores])
            idle = 0 if max(scores) > best else idle + 1
            best = max(best, *scores)
            drawn = [furthest(drawn + trials[population:])]
        return drawn[0]


def evolution(
    mean: FloatArray, sigma: float, population: int, rng: np.random.Generator
) -> "CMAEvolutionStrategy":
    """A strategy in the unit cube around a mean (dim,); in one dimension it has a second, to be left out."""
    import cma

    # The strategy needs two dimensions; those beyond the cube change nothing.
    return cma.CMAEvolutionStrategy(
        np.append(mean, np.full(max(2 - len(mean), 0), 0.5)),
        sigma,
        {
            "bounds": [0, 1],
            "popsize": population,
            "seed": np.nan,  # not the global generator of numpy
            "randn": lambda *shape: rng.standard_normal(shape),
            "verbose": -9,
            "verb_log": 0,
            "signals_filename": "",
        },
    )
