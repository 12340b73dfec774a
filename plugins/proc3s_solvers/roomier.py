"""Linear programs for the tightest margin of a plan, around one that was accepted (Madsen 1975)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

from proc3s import FloatArray, Space, Trial
from proc3s_solvers.batches import Batches, BatchSearch
from proc3s_solvers.sampling import BELOW_ONE

WIDER, NARROWER = 1.5, 0.4
"""What the reach is multiplied by, after a move that makes more room and after one that does not."""
FEW, LOOKS = 4, 2
"""So many dimensions are looked along at once, and so often along each while that makes no more room."""
FAILURES, GAIN = 3, 0.01
"""It looks again after so many moves in a row without more room, or where less than the gain is promised."""
TIE = 0.02
"""Margins that are tighter than the tightest and this, in expected errors, are as tight."""
SHORTEST = 1e-3
"""Moves that are shorter, in ranges, teach no more than one of this length."""
THRIFT = 0.01
"""What a move of one range costs, in expected errors: parameters that change nothing are left alone."""


class RoomierOptions(BaseModel):
    """How far it looks around the accepted sample, how far it moves at first, and to where."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    step: float = Field(default=0.02, gt=0, le=0.5, description="length of the first moves, in ranges")
    reach: float = Field(default=0.1, gt=0, le=1, description="how far it moves next at most, in ranges")
    aim: float = Field(default=4.0, gt=0, description="room that is enough, in expected errors")


class Roomier(BatchSearch):
    """Moves to where the smallest margin is largest if all are linear near the best sample so far.

    Their slopes are learned by Broyden's rule from every trial: first from steps along a few dimensions that
    may matter for the tightest margin. How far it moves is bounded, and depends on success. Where it is stuck
    it looks along others, then to their other side; then it gives up.
    """

    def __init__(self, space: Space, budget: int, rng: np.random.Generator, options: RoomierOptions) -> None:
        super().__init__()
        self._space, self._options = space, options
        self._looks = np.zeros(space.dim, dtype=np.int64)
        self._best: Trial  # from the first that is told
        self._begun = False

    def tell(self, trials: Sequence[Trial]) -> None:
        """Take where to begin from, then the verdicts on what was asked."""
        if not self._begun:
            self._begun, self._best = True, trials[0]
            self._names = [*self._best.left]
            self._slopes = np.zeros((len(self._names), self._space.dim))
        else:
            super().tell(trials)

    def _search(self) -> Batches[None]:
        while (dimensions := self._dimensions()).size:
            around = self._around(dimensions)
            self._looks[dimensions] += 1
            if (yield from self._run(around)):
                self._looks[:] = 0
        while True:
            yield np.empty((0, self._space.dim))

    def _run(self, around: FloatArray) -> Batches[bool]:
        """Look around, and move while that promises something; whether there is more room then."""
        before, reach, failed = self._best, self._options.reach, 0
        self._learn((yield around))
        while failed < FAILURES and (move := self._move(reach)) is not None:
            better = self._learn((yield (self._u + move).clip(0.0, BELOW_ONE)[None]))
            reach, failed = (reach * WIDER, 0) if better else (reach * NARROWER, failed + 1)
        return self._best is not before

    @property
    def _u(self) -> FloatArray:
        return np.array(self._best.u)

    def _dimensions(self) -> NDArray[np.intp]:
        """The next to look along: of those that begin to matter up to the tightest steps, the last ones."""
        samplers, influence = self._space.samplers, self._space.influence
        begins = np.repeat([influence[name] for name in samplers], [s.dim for s in samplers.values()])
        most = _room(self._best) + TIE
        last = max((step for (step, _), margin in self._best.left.items() if margin <= most), default=0)
        order: NDArray[np.intp] = np.lexsort((last - begins, self._looks))
        return order[(begins[order] <= last) & (self._looks[order] < LOOKS)][:FEW]

    def _around(self, dimensions: NDArray[np.intp]) -> FloatArray:
        """Samples a step away from the best, each along one of the dimensions; later to its other side."""
        away = np.zeros((len(dimensions), self._space.dim))
        side = np.where(self._looks[dimensions] % 2, -1.0, 1.0)
        away[np.arange(len(dimensions)), dimensions] = side * self._options.step
        there = self._u + away
        # The cube has room on one side at least.
        return np.where((there < 0.0) | (there > BELOW_ONE), self._u - away, there).clip(0.0, BELOW_ONE)

    def _learn(self, trials: Sequence[Trial]) -> bool:
        """Learn the slopes that trials show, and go on from the best of all; whether it is one of them."""
        base = self._margins(self._best)
        for trial in trials:
            away = np.array(trial.u, dtype=np.float64) - self._u
            wrong = self._margins(trial) - base - self._slopes @ away
            seen = np.isfinite(wrong)
            self._slopes[seen] += np.outer(wrong[seen], away) / max(float(away @ away), SHORTEST**2)
        best, self._best = self._best, max([self._best, *trials], key=_room)
        return self._best is not best

    def _margins(self, trial: Trial) -> FloatArray:
        """Margins of a trial in the order of their names, NaN where it has none."""
        return np.array([trial.left.get(name, np.nan) for name in self._names], dtype=np.float64)

    def _move(self, reach: float) -> FloatArray | None:
        """The move of the best sample, shape (dim,), that makes most room; None if there is none."""
        from scipy.optimize import linprog  # takes a third of a second

        dim = self._space.dim
        base = self._margins(self._best)
        known, u = np.isfinite(base), self._u
        slopes = self._slopes[known]
        # Each move is the difference of two that are not negative; the last variable is the room.
        found = linprog(
            [THRIFT] * 2 * dim + [-1.0],
            np.hstack([-slopes, slopes, np.ones((len(slopes), 1))]),
            base[known],
            bounds=[
                *((0.0, most) for most in np.minimum(reach, BELOW_ONE - u)),
                *((0.0, most) for most in np.minimum(reach, u)),
                (None, self._options.aim),
            ],
        )
        if found.x is None or found.x[-1] < _room(self._best) + GAIN:
            return None
        move: FloatArray = found.x[:dim] - found.x[dim:-1]
        return move


def _room(trial: Trial) -> float:
    """What an accepted plan stands; none counts as endless where nothing limits it."""
    if not trial.accepted:
        return -1.0
    return trial.room.value if trial.room else np.inf
