"""Execution: the plan is carried out open loop, and the judges look at the result."""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from proc3s.constraints import Violation
from proc3s.events import Emit, PlanExecuted
from proc3s.problem import Problem, carry_out, judge
from proc3s.state import Plan
from proc3s.world import Score


@dataclass(frozen=True)
class Execution:
    """A plan that was carried out to its end, what it violated, and the verdict; None without a judge."""

    plan: Plan
    executed: Literal["solution", "fallback"]
    violations: tuple[Violation, ...]
    score: Score | None
    reason: str


def execute(
    problem: Problem,
    plan: Plan,
    executed: Literal["solution", "fallback"],
    place: tuple[int, int],
    picture: Path | None,
    emit: Emit,
) -> Execution:
    """Carry a plan out in the execution world without stopping at violations; `picture` takes a PNG.
    `place` is the round and the candidate whose program the plan is from.

    A fallback that turns out to violate nothing is a solution.
    """
    world = problem.domain.make_world(problem.domain.spec.execution)
    try:
        trial, final = carry_out(world, problem, plan, stop=False)
        if picture is not None:
            world.render(plan, picture)
    finally:
        world.close()
    if not trial.violations:
        executed = "solution"
    score, reason = judge(problem, final, plan)
    emit(
        PlanExecuted(
            round=place[0],
            candidate=place[1],
            executed=executed,
            plan=[action.to_json() for action in plan],
            violations=[violation.to_json() for violation in trial.violations],
            goal_reached=score.reached if score else None,
            goal_reason=reason,
        )
    )
    return Execution(plan, executed, trial.violations, score, reason)
