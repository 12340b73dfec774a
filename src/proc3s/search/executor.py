"""Executors map rollouts over plans; the built-in ones are plugins."""

from collections.abc import Iterable, Iterator
from typing import Protocol

from proc3s.domain.values import Plan
from proc3s.search.problem import Problem
from proc3s.search.trial import Trial


class Executor(Protocol):
    """Evaluates plans somewhere. Closing the iterator that `map` returns cancels what is not done."""

    def map(self, problem: Problem, plans: Iterable[Plan]) -> Iterator[Trial]:
        """The trial of every plan, in the order of the plans, taken lazily."""
        ...

    def close(self) -> None:
        """Release worlds and workers."""
        ...
