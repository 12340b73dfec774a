"""Solvers that learn nothing from trials: uniform draws, and annealed Gaussian noise."""

from collections.abc import Sequence
from statistics import NormalDist

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from proc3s import FloatArray, Space, Trial

BELOW_ONE = np.nextafter(1.0, 0.0)
_cdf = np.vectorize(NormalDist().cdf, otypes=[float])


class BatchOptions(BaseModel):
    """Batches start small, since easy problems need few samples, and double up to the largest."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    first: int = Field(default=64, ge=1, description="samples of the first batch")
    largest: int = Field(default=1024, ge=1, description="samples of the largest batch")


class _Batches:
    """Sizes of the batches of one search; the sizes never change which samples are drawn."""

    def __init__(self, options: BatchOptions) -> None:
        self._next = min(options.first, options.largest)
        self._largest = options.largest

    def size(self, limit: int) -> int:
        size = min(self._next, limit)
        self._next = min(2 * self._next, self._largest)
        return size


class Rejection:
    """Uniform and independent draws (PRoC3S, section 4)."""

    def __init__(self, space: Space, budget: int, rng: np.random.Generator, options: BatchOptions) -> None:
        self._dim = space.dim
        self._rng = rng
        self._batches = _Batches(options)

    def ask(self, limit: int) -> FloatArray:
        """Uniform samples, shape (k, dim)."""
        return self._rng.random((self._batches.size(limit), self._dim))

    def tell(self, trials: Sequence[Trial]) -> None:
        """Learns nothing."""


class Gaussian:
    """Normal noise around u = 0.5 with a standard deviation from 0 to 1 over the budget (paper, appendix)."""

    def __init__(self, space: Space, budget: int, rng: np.random.Generator, options: BatchOptions) -> None:
        self._dim = space.dim
        self._rng = rng
        self._batches = _Batches(options)
        self._scale = np.linspace(0.0, 1.0, max(budget, 2))
        self._drawn = 0

    def ask(self, limit: int) -> FloatArray:
        """The next samples, shape (k, dim), each a little wider than the one before."""
        k = min(self._batches.size(limit), len(self._scale) - self._drawn)
        scale = self._scale[self._drawn : self._drawn + k, None]
        self._drawn += k
        u: FloatArray = _cdf(scale * self._rng.standard_normal((k, self._dim)))
        return np.minimum(u, BELOW_ONE)

    def tell(self, trials: Sequence[Trial]) -> None:
        """Learns nothing."""
