"""Execution: the plan is carried out open loop, and the judges look at the result."""

import dataclasses
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from proc3s.constraints import Violation
from proc3s.errors import blame
from proc3s.events import Emit, PlanExecuted
from proc3s.problem import Problem, carry_out
from proc3s.state import Plan, State
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
    round_: int,
    picture: Path | None,
    emit: Emit,
) -> Execution:
    """Carry a plan out in the execution world without stopping at violations; `picture` takes a PNG.
    `round_` is the round whose program the plan is from.

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
            round=round_,
            executed=executed,
            plan=[action.to_json() for action in plan],
            violations=[dataclasses.asdict(violation) for violation in trial.violations],
            goal_reached=score.reached if score else None,
            goal_reason=reason,
        )
    )
    return Execution(plan, executed, trial.violations, score, reason)


def judge(problem: Problem, final: State, plan: Plan) -> tuple[Score | None, str]:
    """All judges of the task must be satisfied; the reason of the first that is not, else of all."""
    if problem.goal != problem.task.instruction:
        return None, "nobody judges an instruction of your own"
    with blame(f"judge of {problem.name}"):
        scores = [target.load()(final, plan, **target.args) for target in problem.task.judge]
    if not scores:
        return None, "the task has no judge"
    missed = [score for score in scores if not score.reached]
    reason = missed[0].reason if missed else "; ".join(score.reason for score in scores)
    return Score(not missed, reason), reason
