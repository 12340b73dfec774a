"""What a solver is: it asks for trials of samples, and is told them."""

from collections.abc import Sequence
from typing import Protocol

from proc3s.domain.values import FloatArray
from proc3s.search.trial import Trial


class Solver(Protocol):
    """Decides by trials, never by clocks; all its random numbers come from the generator it was given."""

    def ask(self, limit: int) -> FloatArray:
        """The next samples, shape (k, dim) with k <= limit, in [0, 1); none: it gives up."""
        ...

    def tell(self, trials: Sequence[Trial]) -> None:
        """Verdicts on what was asked last, in order; fewer if one was accepted."""
        ...
