"""CMA-ES on the room of plans, around one that was accepted (Hansen and Ostermeier 2001)."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

from proc3s import Space, Trial
from proc3s_solvers.batches import Batches, BatchSearch
from proc3s_solvers.evolution import evolution
from proc3s_solvers.sampling import BELOW_ONE

MOST = 1e3
"""Room beyond this counts as this."""


class RoomierOptions(BaseModel):
    """How far from the accepted plan the first generation is, and how large a generation is."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    population: int = Field(default=6, ge=4, description="samples of a generation")
    sigma: float = Field(default=0.05, gt=0, le=1, description="deviation of the first generation, in ranges")


class Roomier(BatchSearch):
    """Moves the parameters that can matter for what is tightest; begins anew when something else is.

    The first trials that it is told are those to begin from.
    """

    def __init__(self, space: Space, budget: int, rng: np.random.Generator, options: RoomierOptions) -> None:
        super().__init__()
        self._space, self._rng, self._options = space, rng, options
        self._best: Trial | None = None

    def tell(self, trials: Sequence[Trial]) -> None:
        """Take where to begin from, then the verdicts on what was asked."""
        if self._best is None:
            self._best = min(trials, key=loss)
        else:
            super().tell(trials)

    def _search(self) -> Batches[None]:
        while True:
            yield from self._run()

    def _run(self) -> Batches[None]:
        """A run of the strategy around the best so far, until other parameters matter."""
        assert self._best is not None
        centre, free = np.array(self._best.u), matters(self._space, self._best)
        options, width = self._options, int(free.sum())
        strategy = evolution(centre[free], options.sigma, options.population, self._rng)
        while not strategy.stop() and (free == matters(self._space, self._best)).all():
            asked = strategy.ask()
            u = np.tile(centre, (len(asked), 1))
            u[:, free] = np.clip(np.array(asked)[:, :width], 0.0, BELOW_ONE)
            trials = yield u
            strategy.tell(asked, [loss(trial) for trial in trials])
            self._best = min([self._best, *trials], key=loss)


def loss(trial: Trial) -> float:
    """Less is better: accepted plans by their room, then those that came furthest."""
    if trial.accepted:
        return -min(trial.room.value, MOST) if trial.room else -MOST
    return 1.0 + 1.0 / (1.0 + max(trial.progress, 0.0))


def matters(space: Space, trial: Trial) -> NDArray[np.bool_]:
    """Which coordinates (dim,) of a sample can change what is tightest: those of its step, and before it.

    All for the goal, and where none is known to.
    """
    last = trial.room.step if trial.room and trial.room.step is not None else math.inf
    names = [space.influence[name] <= last for name in space.samplers]
    found: NDArray[np.bool_] = np.repeat(names, [sampler.dim for sampler in space.samplers.values()])
    return found if found.any() else np.ones(space.dim, bool)
