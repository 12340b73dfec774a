"""The audit: some of what screens rejected is put to the world after all, to see who was right."""

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from proc3s.constraints import Violation
from proc3s.executors import Executor
from proc3s.problem import Problem
from proc3s.state import Plan


@dataclass(frozen=True)
class Findings:
    """How many rejects were put to the world, and which of them it accepts."""

    checked: int
    wrong: tuple[tuple[Plan, Violation], ...]


class Audit:
    """A uniform choice of `size` rejects out of all that are offered, drawn by their order (a reservoir)."""

    def __init__(self, size: int, seed: int) -> None:
        self._size = size
        self._rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(2**31,)))
        self._offered = 0
        self._chosen: list[tuple[Plan, Violation]] = []

    def offer(self, plan: Callable[[], Plan], violation: Violation) -> None:
        """A reject; its plan is only made if it is chosen."""
        self._offered += 1
        if len(self._chosen) < self._size:
            self._chosen.append((plan(), violation))
        elif (place := int(self._rng.integers(self._offered))) < self._size:
            self._chosen[place] = (plan(), violation)

    def check(self, problem: Problem, executor: Executor) -> Findings:
        """Roll the chosen ones out without screens; a plan that only misses the goal was no violation."""
        plain = dataclasses.replace(problem, screens="none", check_goal=False)
        trials = executor.map(plain, [plan for plan, _ in self._chosen])
        pairs = zip(self._chosen, trials, strict=True)
        return Findings(len(self._chosen), tuple(chosen for chosen, trial in pairs if trial.accepted))
