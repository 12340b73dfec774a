"""Solvers propose samples and learn from trials; a `Search` is the loop around one, `race` around several."""

from collections.abc import Callable, Sequence

import numpy as np

from proc3s.domain.samplers import Space
from proc3s.domain.values import FloatArray
from proc3s.errors import Interrupted, Proc3sError, blame, not_wanted
from proc3s.sandbox.errors import SketchError, SketchRuntimeError
from proc3s.search.evaluator import ALIKE, Evaluator
from proc3s.search.solver import Solver
from proc3s.search.trial import Trial


class Search:
    """One program's search, which can be continued: every trial in order, and what stopped it.

    `halted` is the program's own fault, `broken_off` is not; `alike` says that its first samples all raised
    the same exception at the same line, so that no more are drawn. `report` sees the trials batch by batch.
    `check` is called between trials and may raise what breaks the search off.
    """

    def __init__(
        self,
        space: Space,
        solver: Solver,
        evaluator: Evaluator,
        report: Callable[[Sequence[Trial]], None] = lambda trials: None,
        check: Callable[[], None] = lambda: None,
    ) -> None:
        self.space = space
        self._solver = solver
        self._evaluator = evaluator
        self._report = report
        self._check = check
        self._exhausted = False
        self.trials: list[Trial] = []
        self.alike = False
        self.halted: SketchError | None = None
        self.broken_off: Proc3sError | None = None

    @property
    def solution(self) -> Trial | None:
        """The accepted trial; it is always the last."""
        return self.trials[-1] if self.trials and self.trials[-1].accepted else None

    @property
    def over(self) -> bool:
        """Whether the search has ended: solved, stopped, or nothing left to ask."""
        return bool(self._exhausted or self.solution or self.halted or self.broken_off or self.alike)

    @property
    def progress(self) -> float:
        """That of the best trial; -1 without any."""
        return max((trial.progress for trial in self.trials), default=-1.0)

    def advance(self, samples: int) -> None:
        """Go on for at most so many samples, or until it is over.

        A problem without open parameters is evaluated once.
        """
        end = len(self.trials) + (min(samples, 1) if self.space.dim == 0 else samples)
        try:
            while len(self.trials) < end and not self.over:
                self._check()
                self._step(end - len(self.trials))
        except SketchError as error:  # a solver may run the program too, to see which parameters matter
            self.halted = error
        except Proc3sError as error:
            self.broken_off = error
        except KeyboardInterrupt:  # samples that were drawn before the interrupt count
            self.broken_off = Interrupted("interrupted")

    def _step(self, limit: int) -> None:
        with blame("solver", SketchError):
            u = np.empty((1, 0)) if self.space.dim == 0 else points(self._solver.ask(limit), self.space.dim)
        self._exhausted = self.space.dim == 0 or not len(u)
        begun = len(self.trials)
        if len(u):
            self._evaluate(u)
        if batch := self.trials[begun:]:
            self._report(batch)
        if not self.over:
            with blame("solver", SketchError):
                self._solver.tell(batch)

    def _evaluate(self, u: FloatArray) -> None:
        """Trials up to the first accepted one, and what stopped them if something did."""
        try:
            for trial in self._evaluator.stream(u):
                self.trials.append(trial)
                self.alike = len(self.trials) == ALIKE and _all_alike(self.trials)
                if trial.accepted or self.alike:
                    break
                self._check()
        except SketchError as error:
            self.halted = error
        except Proc3sError as error:
            self.broken_off = error
        except KeyboardInterrupt:
            self.broken_off = Interrupted("interrupted")


def points(asked: object, dim: int) -> FloatArray:
    """What a solver asks for as points (k, dim) of the unit cube. Raises SpecError if it is none."""
    try:
        u = np.asarray(asked, float)
    except (TypeError, ValueError) as error:
        raise not_wanted("solver", asked, "an array of numbers") from error
    if u.ndim != 2 or (len(u) and u.shape[1] != dim):
        raise not_wanted("solver", asked, f"points of shape (k, {dim})")
    if not ((u >= 0) & (u <= 1)).all():
        raise not_wanted("solver", asked, "points of the unit cube")
    return u


def _all_alike(trials: Sequence[Trial]) -> bool:
    """Whether all raised the same type of exception at the same line."""
    raised = {
        (trial.error.message.partition(":")[0], trial.error.line)
        if isinstance(trial.error, SketchRuntimeError)
        else None
        for trial in trials
    }
    return len(raised) == 1 and None not in raised
