"""A fixed schedule of solvers: no single one is best on every problem."""

from collections.abc import Iterator, Sequence

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from proc3s import FloatArray, Solver, Space, Trial
from proc3s_solvers.backtracking import Backtracking, BacktrackingOptions
from proc3s_solvers.evolution import Cma, CmaOptions
from proc3s_solvers.sampling import BatchOptions, Rejection


class PortfolioOptions(BaseModel):
    """Lengths of the turns; those of backtracking and cma double."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    rejection: int = Field(default=64, ge=1, description="uniform samples before the first turn")
    turn: int = Field(default=128, ge=1, description="samples of the first turns of backtracking and cma")


class Portfolio:
    """Rejection first, since most problems are easy; then backtracking and cma in turns that double.

    A solver goes on where its last turn ended, and learns from its own samples only.
    """

    def __init__(
        self, space: Space, budget: int, rng: np.random.Generator, options: PortfolioOptions
    ) -> None:
        first, second, third = rng.spawn(3)
        self._rejection = Rejection(space, budget, first, BatchOptions())
        self._searches = (
            Backtracking(space, budget, second, BacktrackingOptions()),
            Cma(space, budget, third, CmaOptions()),
        )
        self._turns = self._schedule(options)
        self._solver, self._left = next(self._turns)

    def _schedule(self, options: PortfolioOptions) -> Iterator[tuple[Solver, int]]:
        yield self._rejection, options.rejection
        turn = options.turn
        while True:
            for solver in self._searches:
                yield solver, turn
            turn *= 2

    def ask(self, limit: int) -> FloatArray:
        """The next samples of the solver whose turn it is, shape (k, dim)."""
        if not self._left:
            self._solver, self._left = next(self._turns)
        return self._solver.ask(min(limit, self._left))

    def tell(self, trials: Sequence[Trial]) -> None:
        """Verdicts for the solver that asked for them."""
        self._solver.tell(trials)
        self._left -= len(trials)
