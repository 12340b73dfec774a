"""Backtracking on prefixes: what the world accepted is kept, what comes after it is drawn again."""

from bisect import bisect_right
from collections.abc import Iterator
from functools import cached_property

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from proc3s import FloatArray, Space, Trial
from proc3s_solvers.batches import Batches, BatchSearch, furthest


class BacktrackingOptions(BaseModel):
    """How long a prefix is given before the search backs up."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    children: int = Field(default=16, ge=1, description="samples of a batch that extends a prefix")
    tries: int = Field(default=32, ge=1, description="samples for a prefix before the search backs up")


def _reluctant_doubling() -> Iterator[int]:
    """1, 1, 2, 1, 1, 2, 4, ...: the restarts of Luby, Sinclair and Zuckerman (1993) in Knuth's form."""
    u = v = 1
    while True:
        yield v
        u, v = (u + 1, 1) if u & -u == v else (u, 2 * v)


class Backtracking(BatchSearch):
    """Draws again only the parameters that matter from the failing step on, as `space.influence` says.

    A step that stays infeasible makes it back up by 1, 2, 4 ... levels; when none is left it starts anew with
    uniform draws, and now and then with twice the patience. So no point of the space is out of its reach, and
    where every parameter matters from the first step, it is rejection sampling.
    """

    def __init__(
        self, space: Space, budget: int, rng: np.random.Generator, options: BacktrackingOptions
    ) -> None:
        super().__init__()
        self._space = space
        self._rng = rng
        self._options = options

    @cached_property
    def _starts(self) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
        """The first step that each dimension of the cube changes; asking for it runs the program."""
        names, samplers = list(self._space.samplers), self._space.samplers.values()
        steps = np.array([self._space.influence[name] for name in names], dtype=np.int64)
        return np.repeat(steps, [sampler.dim for sampler in samplers])

    def _search(self) -> Batches[None]:
        for patience in _reluctant_doubling():
            tries = patience * self._options.tries
            fresh = yield self._rng.random((tries, self._space.dim))
            yield from self._extend(furthest(fresh), tries)

    def _extend(self, best: Trial, tries: int) -> Batches[None]:
        """Extend the prefix of a trial until backing up has left nothing of it."""
        back, further = 0, 1
        while (level := self._level(best.reached) - back) > 0:
            found = yield from self._children(best, level, tries)
            if found.reached > best.reached:
                best, back, further = found, 0, 1
            elif back and found.reached == best.reached:
                best, back = found, 0
            else:
                back, further = further, 2 * further

    def _level(self, step: int) -> int:
        """Which of the steps where parameters come in is the last up to `step`."""
        return bisect_right(self._levels, step) - 1

    @cached_property
    def _levels(self) -> list[int]:
        found: list[int] = np.unique(self._starts).tolist()
        return found

    def _children(self, parent: Trial, level: int, tries: int) -> Batches[Trial]:
        """The furthest of up to `tries` samples that keep what comes in before a level, batch by batch."""
        best = None
        while tries and (best is None or best.reached <= parent.reached):
            size = min(self._options.children, tries)
            trials = yield self._draw(parent, level, size)
            best = furthest([best, *trials] if best else trials)
            tries -= size
        assert best is not None
        return best

    def _draw(self, parent: Trial, level: int, size: int) -> FloatArray:
        u = self._rng.random((size, self._space.dim))
        return np.where(self._starts < self._levels[level], parent.u, u)
