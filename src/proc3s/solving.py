"""Solvers propose samples and learn from trials; `solve` is the loop around them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from proc3s.errors import Interrupted, Proc3sError
from proc3s.evaluation import Evaluator
from proc3s.problem import Trial
from proc3s.samplers import Space
from proc3s.sketch.errors import SketchError
from proc3s.state import FloatArray


class Solver(Protocol):
    """Decides by trials, never by clocks; all its random numbers come from the generator it was given."""

    def ask(self, limit: int) -> FloatArray:
        """The next samples, shape (k, dim) with k <= limit, in [0, 1); none: it gives up."""
        ...

    def tell(self, trials: Sequence[Trial]) -> None:
        """Verdicts on what was asked last, in order; fewer if one was accepted."""
        ...


@dataclass(frozen=True)
class Search:
    """What a search found: every trial in order, the accepted one, or why it was stopped.

    `halted` is the program's own fault, `broken_off` is not.
    """

    trials: tuple[Trial, ...]
    halted: SketchError | None = None
    broken_off: Proc3sError | None = None

    @property
    def solution(self) -> Trial | None:
        """The accepted trial; it is always the last."""
        return self.trials[-1] if self.trials and self.trials[-1].accepted else None


def solve(
    space: Space,
    solver: Solver,
    evaluator: Evaluator,
    budget: int,
    report: Callable[[Sequence[Trial]], None],
) -> Search:
    """Search until a trial is accepted, `budget` samples are spent, or the solver gives up.

    A problem without open parameters is evaluated once. `report` sees the trials batch by batch.
    """
    trials: list[Trial] = []
    limit = min(budget, 1) if space.dim == 0 else budget
    try:
        while len(trials) < limit:
            u = np.empty((1, 0)) if space.dim == 0 else solver.ask(limit - len(trials))
            if not len(u):
                break
            done = _evaluate(evaluator, u)
            trials += done.trials
            report(done.trials)
            if done.halted or done.broken_off or done.solution:
                return Search(tuple(trials), done.halted, done.broken_off)
            solver.tell(done.trials)
    except SketchError as error:  # a solver may run the program too, to see which parameters matter
        return Search(tuple(trials), halted=error)
    except KeyboardInterrupt:  # wherever it strikes, what was sampled counts
        return Search(tuple(trials), broken_off=Interrupted("interrupted"))
    return Search(tuple(trials))


def _evaluate(evaluator: Evaluator, u: FloatArray) -> Search:
    """Trials up to the first accepted one, and what stopped them if something did."""
    batch: list[Trial] = []
    try:
        for trial in evaluator.stream(u):
            batch.append(trial)
            if trial.accepted:
                break
    except SketchError as error:
        return Search(tuple(batch), halted=error)
    except Proc3sError as error:
        return Search(tuple(batch), broken_off=error)
    except KeyboardInterrupt:
        return Search(tuple(batch), broken_off=Interrupted("interrupted"))
    return Search(tuple(batch))
