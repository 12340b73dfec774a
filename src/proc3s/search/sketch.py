"""What a search needs of a program with open parameters."""

from typing import Protocol

from proc3s.domain.plan_batch import PlanBatch
from proc3s.domain.samplers import Space
from proc3s.domain.values import FloatArray


class Sketch(Protocol):
    """A program with open parameters: `space` says which, `plans` grounds it."""

    @property
    def space(self) -> Space:
        """The open parameters."""
        ...

    def plans(self, u: FloatArray, first: int) -> PlanBatch:
        """The plans of the samples u, shape (n, dim), numbered from `first`.

        The number seeds what the program draws itself. Raises SketchError, with what was done before.
        """
        ...
