"""Checks before a model is asked: every part of a run can be imported and made."""

from contextlib import closing

from proc3s.domain.world import flaws_of, make_world
from proc3s.errors import UsageError, blame
from proc3s.search.problem import Problem
from proc3s.search.watch import watch
from proc3s.search.worker import Rollouts
from proc3s.specs.base import Target


def check_parts(problem: Problem) -> None:
    """Import every target of a task, make its screens, and put the scene into its worlds.

    An answer costs money, and what is wrong with a simulator or a scene shows at the first plan otherwise.
    Raises SpecError or UsageError.
    """
    domain = problem.domain
    domain.require(problem.task)
    for screen in domain.screens:
        screen.load()
    Rollouts(problem).close()
    if flaws := flaws_of(domain, problem.initial):
        raise UsageError(f"the scene of {problem.name}, seed {problem.seed}: {'; '.join(flaws)}")
    _set_up(problem, "world", domain.spec.world)
    if domain.spec.execution is not None:
        _set_up(problem, "execution world", domain.spec.execution)


def _set_up(problem: Problem, what: str, target: Target) -> None:
    limited = watch().within(problem.step_limit, f"the reset of the {what}")
    with blame(what), closing(make_world(problem.domain, target)) as world, limited:
        world.reset(problem.initial)
