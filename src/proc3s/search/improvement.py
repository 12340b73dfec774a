"""After a plan was accepted: a solver tries samples around it, for a plan with more room."""

import dataclasses
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

from proc3s.domain.domain import Domain
from proc3s.domain.room import GOAL, errors_left, goal_left
from proc3s.domain.samplers import Space
from proc3s.domain.values import FloatArray
from proc3s.search.search import points
from proc3s.search.solver import Solver
from proc3s.search.trial import Trial

ENOUGH, LEAST = 3.0, 0.01
"""Expected errors: a plan that stands enough is not improved any further, one that stands less than the
least more than another is not better."""
Take = Callable[[FloatArray], Iterable[Trial]]
"""Gives the trials of samples (n, dim), in order."""


@dataclass
class Improvement:
    """What was tried around an accepted trial."""

    start: Trial
    trials: list[Trial] = field(default_factory=list)

    @property
    def better(self) -> list[Trial]:
        """The accepted trials with more room than at the start, the roomiest first."""
        least = room_value(self.start) + LEAST
        found = [trial for trial in self.trials if trial.accepted and room_value(trial) > least]
        return sorted(found, key=room_value, reverse=True)

    @property
    def most(self) -> float:
        """The most room so far."""
        return max(map(room_value, [self.start, *self.better[:1]]))


def room_value(trial: Trial) -> float:
    """Expected errors that an accepted trial stands; infinite where nothing limits it."""
    return trial.room.value if trial.room else math.inf


def improve(
    found: Improvement, domain: Domain, space: Space, solver: Solver, samples: int, take: Take
) -> None:
    """Try at most so many samples that a solver asks for, which is told of the accepted trial first.

    It ends early where a plan has room enough, or the solver asks for no more.
    """
    solver.tell([_measured(domain, found.start)])
    while (left := samples - len(found.trials)) > 0 and found.most < ENOUGH:
        u = points(solver.ask(left), space.dim)[:left]
        if not len(u):
            break
        begun = len(found.trials)
        for trial in take(u):
            found.trials.append(trial)
        solver.tell([_measured(domain, trial) for trial in found.trials[begun:]])


def _measured(domain: Domain, trial: Trial) -> Trial:
    """The trial with all its margins in expected errors; what a screen rejected has that of its violation."""
    found = [(v.step, v.constraint, v.skill, v.margin) for v in trial.violations]
    if trial.plan is not None and trial.margins:
        steps = enumerate(zip(trial.plan, trial.margins, strict=False))
        found = [(k, name, action.skill, m) for k, (action, here) in steps for name, m in here.items()]
    left = {
        (step, name): value
        for step, name, skill, margin in found
        if name in domain.spec.constraints and (value := errors_left(domain, name, skill, margin)) is not None
    }
    if trial.plan is not None and (value := goal_left(domain, trial.goal)) is not None:
        left[len(trial.plan), GOAL] = value
    return dataclasses.replace(trial, left=left)
