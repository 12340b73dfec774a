"""Execution: the plan is carried out open loop, and the judges look at the result."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any, Literal

from proc3s.domain.margins import Violation
from proc3s.domain.room import Room, room_at_goal, tightest
from proc3s.domain.state import State
from proc3s.domain.values import Plan
from proc3s.domain.world import Score, World, make_world
from proc3s.errors import blame
from proc3s.planning.parts import Pictures
from proc3s.planning.pictures import draw_outcome
from proc3s.runs.events import Emit, PlanExecuted
from proc3s.search.problem import Problem
from proc3s.search.rollout import carry_out, judge
from proc3s.search.trial import Trial
from proc3s.specs.base import Target


@dataclass(frozen=True)
class Execution:
    """A plan that was carried out to its end, and the verdicts on it; a score is None without a judge.

    `violations` are those of the world that accepts plans. `score` is on the state that the execution world
    ended in, `expected` on that of the other, where `room` is what is tightest if nothing is violated.
    """

    plan: Plan
    executed: Literal["solution", "fallback"]
    violations: tuple[Violation, ...]
    score: Score | None
    reason: str
    expected: Score | None
    room: Room | None = None


def execute(
    problem: Problem,
    plan: Plan,
    executed: Literal["solution", "fallback"],
    place: tuple[int, int],
    pictures: Pictures | None,
    emit: Emit,
) -> Execution:
    """Carry a plan out open loop, without stopping at violations; keep its film and `pictures`.

    `place` is the round and the candidate whose program the plan is from.

    A fallback that turns out to violate nothing is a solution.
    """
    spec = problem.domain.spec
    draw = partial(draw_outcome, problem.initial, plan, pictures, emit) if pictures else None
    trial, final = _carry_out(problem, plan, spec.world, None if spec.execution else draw)
    expected, reason = judge(problem, final, plan)
    room = trial.room
    if expected and expected.reached:
        room = tightest(room, room_at_goal(problem.domain, expected.margin, reason))
    score = expected
    if spec.execution:
        _, final = _carry_out(problem, plan, spec.execution, draw)
        score, reason = judge(problem, final, plan)
    if trial.accepted:
        executed = "solution"
    room = room if trial.accepted else None
    execution = Execution(plan, executed, trial.violations, score, reason, expected, room)
    emit(_executed(execution, place))
    return execution


def _carry_out(
    problem: Problem, plan: Plan, target: Target, draw: Callable[[World[Any]], None] | None
) -> tuple[Trial, State]:
    """What a world says of the plan, and the state it ends in."""
    world = make_world(problem.domain, target)
    try:
        with blame("world"):
            trial, final = carry_out(world, problem, plan, stop=False)
        if draw is not None:
            draw(world)
    finally:
        world.close()
    return trial, final


def _executed(execution: Execution, place: tuple[int, int]) -> PlanExecuted:
    return PlanExecuted(
        round=place[0],
        candidate=place[1],
        executed=execution.executed,
        plan=[action.to_json() for action in execution.plan],
        violations=[violation.to_json() for violation in execution.violations],
        goal_reached=execution.score.reached if execution.score else None,
        goal_reason=execution.reason,
        goal_expected=execution.expected.reached if execution.expected else None,
        room=asdict(execution.room) if execution.room else None,
    )
