"""Searches written as generators: they yield a batch of samples and are sent its trials."""

from abc import ABC, abstractmethod
from collections.abc import Generator, Sequence
from typing import TypeAlias, TypeVar

import numpy as np

from proc3s import FloatArray, Trial

R = TypeVar("R")
Batches: TypeAlias = Generator[FloatArray, list[Trial], R]
"""Yields samples of shape (k, dim), is sent their k trials, and returns R."""


class BatchSearch(ABC):
    """`ask` and `tell` around a generator; a limit cuts a batch in pieces without changing what it holds."""

    def __init__(self) -> None:
        self._batches: Batches[None] | None = None
        self._batch: FloatArray = np.empty((0, 0))
        self._trials: list[Trial] = []

    @abstractmethod
    def _search(self) -> Batches[None]:
        """The whole search; it never returns."""

    def ask(self, limit: int) -> FloatArray:
        """What is left of the current batch, shape (k, dim), as far as the limit allows."""
        if self._batches is None:
            self._batches = self._search()
            self._batch = next(self._batches)
        told = len(self._trials)
        return self._batch[told : told + limit]

    def tell(self, trials: Sequence[Trial]) -> None:
        """Collect the verdicts; a batch that is complete is sent to the search."""
        self._trials += trials
        if self._batches is not None and len(self._trials) == len(self._batch):
            self._batch, self._trials = self._batches.send(self._trials), []


def furthest(trials: Sequence[Trial]) -> Trial:
    """The trial with the most progress, the first of equals."""
    return max(trials, key=lambda trial: trial.progress)
