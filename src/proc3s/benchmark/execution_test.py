"""The field test: plans that the world accepted are carried out again and again, with small errors each time.

Fixed programs are searched as by preset `best`, with and without rehearsals; every plan found is carried out
in the execution world under disturbances of its own, and the judge looks at the outcome. No LLM.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from proc3s.benchmark.cases import Case
from proc3s.domain.values import Plan
from proc3s.domain.world import make_world
from proc3s.errors import UsageError
from proc3s.planning.grounding import open_sketch
from proc3s.planning.options import RunOptions
from proc3s.planning.parts import Setup
from proc3s.planning.setup import make_setup
from proc3s.plugins.registry import Registry
from proc3s.search.evaluator import Evaluator
from proc3s.search.problem import Problem
from proc3s.search.rollout import carry_out, judge
from proc3s.search.start import start_search
from proc3s.search.trial import Trial

SEED = 2**30
"""Disturbances of field tests are drawn from other seeds than those of rehearsals."""


@dataclass(frozen=True)
class FieldTest:
    """What became of the plan found for a case and a seed, with so many rehearsals before it was accepted.

    `satisfied` counts the outcomes, of `times`, with which the judge was satisfied; none without a plan.
    """

    case: str
    robust: int
    seed: int
    solved: bool
    samples: int
    rehearsals: int
    times: int
    satisfied: int


def judged(cases: Sequence[Case], registry: Registry) -> list[Case]:
    """The cases whose task has a judge and whose world knows disturbances. Raises UsageError if none has."""
    found = [case for case in cases if _testable(case, registry)]
    if not found:
        raise UsageError("none of these programs has a task with a judge and a world with disturbances")
    return found


def _testable(case: Case, registry: Registry) -> bool:
    from proc3s.domain.world import World

    domain, task = registry.task(case.task)
    targets = [domain.spec.world, domain.spec.execution or domain.spec.world]
    return bool(task.judge) and all(target.load().disturb is not World.disturb for target in targets)


def field_tests(
    registry: Registry, case: Case, seed: int, robust: Sequence[int], times: int, samples: int | None
) -> Iterator[FieldTest]:
    """Find a plan with each number of rehearsals, and carry it out so many times."""
    for rehearsals in robust:
        setup = _setup(registry, case, seed, rehearsals, samples)
        try:
            evaluator, solution = _search(setup, case.program)
        finally:
            setup.executor.close()
        plan = solution.plan if solution else None
        yield FieldTest(
            case=case.label,
            robust=rehearsals,
            seed=seed,
            solved=plan is not None,
            samples=evaluator.samples,
            rehearsals=evaluator.rehearsals,
            times=times if plan else 0,
            satisfied=sum(outcomes(setup.problem, plan, times)) if plan else 0,
        )


def _setup(registry: Registry, case: Case, seed: int, robust: int, samples: int | None) -> Setup:
    given = {"task": case.task, "seed": seed, "robust": robust, "samples": samples}
    options = RunOptions.model_validate({**given, "domain_options": case.scene, "world_options": case.world})
    return make_setup(registry, options, goal_needed=False)


def _search(setup: Setup, program: str) -> tuple[Evaluator, Trial | None]:
    problem = setup.problem
    with open_sketch(setup, program) as opened:
        evaluator = Evaluator(problem, opened.sketch, setup.executor)
        search = start_search(evaluator, setup.make_solver, problem.samples)
        search.advance(problem.samples)
        if search.broken_off is not None:
            raise search.broken_off
        return evaluator, search.solution


def outcomes(problem: Problem, plan: Plan, times: int) -> Iterator[bool]:
    """Whether the judge is satisfied, each time that a plan is carried out with other small errors."""
    spec = problem.domain.spec
    world = make_world(problem.domain, spec.execution or spec.world)
    try:
        for k in range(times):
            world.disturb(np.random.default_rng([SEED, problem.seed, k]))
            _, final = carry_out(world, problem, plan, stop=False)
            score, _ = judge(problem, final, plan)
            yield score is not None and score.reached
    finally:
        world.close()
