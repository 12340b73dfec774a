"""Rollouts one after the other in this process."""

from collections.abc import Iterable, Iterator

from proc3s import Plan, Problem, Rollouts, Trial


class Serial:
    """Keeps the world of one problem, made when the first plan comes; `jobs` changes nothing."""

    def __init__(self, jobs: int = 1) -> None:
        self._problem: Problem | None = None
        self._rollouts: Rollouts | None = None

    def map(self, problem: Problem, plans: Iterable[Plan]) -> Iterator[Trial]:
        """The trial of every plan, in order, computed when it is taken."""
        for plan in plans:
            yield self._of(problem)(plan)

    def _of(self, problem: Problem) -> Rollouts:
        if self._rollouts is None or self._problem is not problem:
            self.close()
            self._problem, self._rollouts = problem, Rollouts(problem)
        return self._rollouts

    def close(self) -> None:
        """Close the world."""
        if self._rollouts is not None:
            self._rollouts.close()
            self._rollouts = None
