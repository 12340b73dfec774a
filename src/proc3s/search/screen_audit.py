"""The audit: re-checks some plans that screens rejected in the world, to find wrong rejects."""

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from proc3s.domain.margins import Violation
from proc3s.domain.values import Plan
from proc3s.search.executor import Executor
from proc3s.search.problem import Problem
from proc3s.search.trial import Trial


@dataclass(frozen=True)
class Findings:
    """The verdicts of screens and world on the same rejected plans."""

    screened: tuple[Trial, ...] = ()
    world: tuple[Trial, ...] = ()

    @property
    def checked(self) -> int:
        """How many rejects were put to the world."""
        return len(self.world)

    @property
    def wrong(self) -> tuple[tuple[Plan, Violation], ...]:
        """Those that the world accepts, and why a screen did not."""
        pairs = zip(self.screened, self.world, strict=True)
        return tuple((t.plan, s.violations[0]) for s, t in pairs if t.accepted and t.plan)


class Audit:
    """A uniform choice of `size` rejects out of all that are offered, drawn by their order (a reservoir)."""

    def __init__(self, size: int, seed: int) -> None:
        self._size = size
        self._rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(2**31,)))
        self._offered = 0
        self._chosen: list[Trial] = []

    def offer(self, plan: Callable[[], Plan], trial: Trial) -> None:
        """Offer a rejected sample; its plan is only made if it is chosen."""
        self._offered += 1
        if len(self._chosen) < self._size:
            self._chosen.append(dataclasses.replace(trial, plan=plan()))
        elif (place := int(self._rng.integers(self._offered))) < self._size:
            self._chosen[place] = dataclasses.replace(trial, plan=plan())

    def check(self, problem: Problem, executor: Executor) -> Findings:
        """Roll the chosen ones out without screens; a plan that only misses the goal was no violation."""
        plain = dataclasses.replace(problem, screens="none", check_goal=False)
        trials = executor.map(plain, [trial.plan for trial in self._chosen if trial.plan])
        verdicts = (
            dataclasses.replace(trial, index=chosen.index, u=chosen.u)
            for chosen, trial in zip(self._chosen, trials, strict=True)
        )
        return Findings(tuple(self._chosen), tuple(verdicts))
