"""Rolls out plans of one problem in one worker: with its world, stateful screens and prefix cache."""

import dataclasses
import hashlib
import json
from typing import Any

import numpy as np

from proc3s.domain.margins import Violation
from proc3s.domain.values import Plan
from proc3s.domain.world import make_world
from proc3s.errors import blame, not_wanted
from proc3s.search.prefix_cache import Prefixes
from proc3s.search.problem import Problem
from proc3s.search.rollout import rollout
from proc3s.search.trial import Trial
from proc3s.search.watch import watch

REHEARSAL = "rehearsal"
"""Named as the constraint of a violation that only a disturbed world finds."""


def _words(plan: Plan) -> list[int]:
    """A plan as numbers that seed a generator."""
    digest = hashlib.sha256(json.dumps([action.to_json() for action in plan]).encode()).digest()
    return [int(word) for word in np.frombuffer(digest, np.uint32)]


class Rollouts:
    """Gives the trial of a plan; executors make one in each of their workers. Close it after use."""

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._screens: list[tuple[str, Any]] = []
        for spec in problem.active_screens(stateful=True):
            with blame(f"screen {spec.name}"):
                self._screens.append((spec.name, spec.load()(problem.domain, **spec.args)))
        with blame("world"):
            self._world = make_world(problem.domain)
        self._prefixes = Prefixes(self._world.most_prefixes if problem.prefixes else 0)

    def __call__(self, plan: Plan) -> Trial:
        """The verdict of the first screen that rejects the plan, else of the world."""
        for name, screen in self._screens:
            with blame(f"screen {name}"), watch().within(self._problem.step_limit, f"screen {name}"):
                violation = screen.check(self._problem.initial, plan)
            if not isinstance(violation, Violation | None):
                raise not_wanted(f"screen {name}", violation, "a Violation or None")
            if violation is not None:
                return Trial(plan, (violation,), violation.step, screen=name)
        with blame("world"):
            trial = rollout(self._world, self._problem, plan, self._prefixes)
            return self._rehearsed(plan, trial) if trial.accepted else trial

    def _rehearsed(self, plan: Plan, trial: Trial) -> Trial:
        """The trial of an accepted plan after its rehearsals: with errors, too, it must violate nothing.

        The errors depend on the plan alone, are as large as they get, and come in opposite pairs.
        """
        for k in range(self._problem.robust):
            rng = np.random.default_rng([self._problem.seed, k // 2, *_words(plan)])
            try:
                self._world.disturb(rng, corner=k)
                again = rollout(self._world, self._problem, plan)
            finally:
                self._world.disturb(None)
            trial = dataclasses.replace(trial, rehearsals=k + 1)
            if not again.accepted:
                first = again.violations[0]
                told = dataclasses.replace(first, constraint=REHEARSAL, text=f"rehearsed: {first.text}")
                return dataclasses.replace(trial, violations=(told,), reached=again.reached)
        return trial

    def close(self) -> None:
        """Close the world, and the screens that can be closed."""
        for _, screen in self._screens:
            if hasattr(screen, "close"):
                screen.close()
        self._world.close()
