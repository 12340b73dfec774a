"""CMA-ES on the room of plans, around one that was accepted (Hansen and Ostermeier 2001)."""

from collections.abc import Sequence

import numpy as np
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

    population: int = Field(default=4, ge=4, description="samples of a generation")
    sigma: float = Field(default=0.05, gt=0, le=1, description="deviation of the first generation, in ranges")


class Roomier(BatchSearch):
    """Evolves a normal distribution around the best trial that it was told first; anew where it has ended.

    It gives up where a generation does not change the room: then no parameter moves what is tightest.
    """

    def __init__(self, space: Space, budget: int, rng: np.random.Generator, options: RoomierOptions) -> None:
        super().__init__()
        self._dim, self._rng, self._options = space.dim, rng, options
        self._best: Trial | None = None

    def tell(self, trials: Sequence[Trial]) -> None:
        """Take where to begin from, then the verdicts on what was asked."""
        if self._best is None:
            self._best = min(trials, key=loss)
        else:
            super().tell(trials)

    def _search(self) -> Batches[None]:
        while (yield from self._run()):
            pass
        while True:
            yield np.empty((0, self._dim))

    def _run(self) -> Batches[bool]:
        """A run of the strategy, to its end; False to give up."""
        assert self._best is not None, "it is to be told where to begin"
        options = self._options
        strategy = evolution(np.array(self._best.u), options.sigma, options.population, self._rng)
        while not strategy.stop():
            asked = strategy.ask()
            trials = yield np.clip(np.array(asked)[:, : self._dim], 0.0, BELOW_ONE)
            strategy.tell(asked, [loss(trial) for trial in trials])
            rooms = {trial.room for trial in trials if trial.accepted}
            if rooms == {self._best.room}:
                return False
            self._best = min([self._best, *trials], key=loss)
        return True


def loss(trial: Trial) -> float:
    """Less is better: accepted plans by their room, then those that came furthest."""
    if trial.accepted:
        return -min(trial.room.value, MOST) if trial.room else -MOST
    return 1.0 + 1.0 / (1.0 + max(trial.progress, 0.0))
