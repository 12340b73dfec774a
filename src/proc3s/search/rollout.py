"""Carries a plan out in a world: the pure function that gives a trial."""

import dataclasses
import math
from collections.abc import Callable
from numbers import Real
from typing import Any

import numpy as np

from proc3s.domain.margins import Violation, check
from proc3s.domain.room import room_at_goal, tightest
from proc3s.domain.state import State
from proc3s.domain.values import Plan
from proc3s.domain.world import Score, World
from proc3s.errors import blame, not_wanted
from proc3s.search.prefix_cache import Failed, Prefix, Prefixes
from proc3s.search.problem import Problem
from proc3s.search.trial import Trial
from proc3s.search.watch import watch
from proc3s.specs.base import Target


def rollout(world: World[Any], problem: Problem, plan: Plan, prefixes: Prefixes | None = None) -> Trial:
    """Carry a plan out in a world up to its first violating step; the goal is the last step if it counts.

    Pure: the verdict depends on the problem and the plan alone. `prefixes` saves time, and changes nothing.
    """
    trial, final = carry_out(world, problem, plan, prefixes=prefixes or Prefixes(0))
    if not problem.check_goal or not trial.accepted:
        return trial
    score, reason = judge(problem, final, plan)
    if score is None:
        return trial
    if score.reached:
        room = tightest(trial.room, room_at_goal(problem.domain, score.margin, reason))
        return dataclasses.replace(trial, room=room, goal=score.margin)
    miss = Violation("goal", len(plan), "goal", -1.0, reason)
    return dataclasses.replace(trial, violations=(miss,), goal=score.margin)


def carry_out(
    world: World[Any],
    problem: Problem,
    plan: Plan,
    stop: bool = True,
    prefixes: Prefixes | None = None,
    visit: Callable[[State], None] = lambda state: None,
) -> tuple[Trial, State]:
    """The trial of a plan, and the state in which it ended; without `stop` it goes on after violations.

    `visit` is told of the state after every step that is carried out.
    """
    prefixes, within = prefixes or Prefixes(0), watch().within
    known = prefixes.longest(plan)
    if known is None:
        with within(problem.step_limit, "the reset of the world"):
            world.reset(problem.initial)
        state, margins, room = problem.initial, [], None
    else:
        world.resume(known.snapshot)
        state, margins, room = known.state, list(known.margins), known.room
    if stop and (failed := prefixes.failure(known, plan[len(margins)])):
        return Trial(plan, failed.violations, len(margins), failed.margins), failed.state
    violations: list[Violation] = []
    reached = len(plan)
    for step in range(len(margins), len(plan)):
        with within(problem.step_limit, f"skill {plan[step].skill} (step {step})"):
            transition = world.step(plan[step])
        state = transition.after
        visit(state)
        left, found, here = check(problem.domain, transition, step)
        margins.append(left)
        room = tightest(room, here)
        violations += found
        if found:
            reached = min(reached, step)
            if stop:
                prefixes.keep_failure(known, plan[step], Failed(tuple(found), state, tuple(margins)))
                break
        elif not violations:
            longer = Prefix(world.snapshot, state, tuple(margins), room)
            prefixes.keep(known, plan[step], longer)
            known = longer
    room = None if violations else room
    return Trial(plan, tuple(violations), reached, tuple(margins), room=room), state


def judge(problem: Problem, final: State, plan: Plan) -> tuple[Score | None, str]:
    """All judges of the task must be satisfied; the reason of the first that is not, else of all.

    The margin is the least of those that there are.
    """
    if problem.goal != problem.task.instruction:
        return None, "custom goals are not judged"
    scores = [_score(problem, target, final, plan) for target in problem.task.judge]
    if not scores:
        return None, "the task has no judge"
    missed = [score for score in scores if not score.reached]
    reason = missed[0].reason if missed else "; ".join(score.reason for score in scores)
    margin = min((score.margin for score in scores if score.margin is not None), default=None)
    return Score(not missed, reason, margin), reason


def _score(problem: Problem, target: Target, final: State, plan: Plan) -> Score:
    """What one judge says. Raises SpecError if that is no score."""
    part = f"judge {target.target} of {problem.name}"
    with blame(part), watch().within(problem.step_limit, part):
        score = target.load()(final, plan, **target.args)
    if (
        isinstance(score, Score)
        and isinstance(score.reached, bool | np.bool_)
        and isinstance(score.reason, str)
        and (score.margin is None or _is_number(score.margin))
    ):
        margin = None if score.margin is None else float(score.margin)
        return Score(bool(score.reached), score.reason, margin)
    raise not_wanted(part, score, "a Score of a bool and a reason in words, and a number as its margin")


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool) and not math.isnan(value)
