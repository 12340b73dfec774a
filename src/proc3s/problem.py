"""The continuous constraint satisfaction problem as plain data, and the one pure function on it."""

import dataclasses
import hashlib
import json
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np

from proc3s.constraints import Violation, check
from proc3s.domain import Domain
from proc3s.errors import blame, not_wanted
from proc3s.specs import ScreenSpec, Target, TaskSpec
from proc3s.state import Action, Plan, State
from proc3s.watch import SECONDS, watch
from proc3s.world import Score, World


@dataclass(frozen=True)
class Problem:
    """A CCSP: a domain, an initial state, a goal in words, a program, a seed and a budget of samples.

    It hashes, pickles and replays; `scene` is the initial state as JSON. With `check_goal` a plan must
    also satisfy the judges of the task; with `robust` it must pass as many rehearsals. `screens` and
    `prefixes` switch off what only saves time. `step_limit` (wall-clock s) aborts, and decides nothing.
    """

    domain: Domain
    task: TaskSpec
    scene: str
    goal: str
    seed: int
    samples: int
    program: str = ""
    check_goal: bool = False
    robust: int = 0
    screens: Literal["all", "exact", "none"] = "all"
    prefixes: bool = True
    step_limit: float = SECONDS

    @cached_property
    def initial(self) -> State:
        """The initial state."""
        return self.domain.states.parse(json.loads(self.scene))

    @property
    def name(self) -> str:
        """`domain/task`."""
        return f"{self.domain.spec.name}/{self.task.name}"

    def __getstate__(self) -> dict[str, Any]:
        # The cached state is an instance of a class that only this process has.
        return {name: value for name, value in self.__dict__.items() if name != "initial"}

    def __hash__(self) -> int:
        return hash((self.scene, self.program, self.goal, self.seed))

    def active_screens(self, stateful: bool) -> tuple[ScreenSpec, ...]:
        """The screens that may be used, of one of the two sorts."""
        wanted = {"all": (True, False), "exact": (True,), "none": ()}[self.screens]
        return tuple(s for s in self.domain.screens if s.exact in wanted and s.stateful == stateful)

    def digest(self) -> str:
        """SHA-256 over everything that the verdict on a plan depends on."""
        spec = self.domain.spec.model_dump_json()
        return hashlib.sha256(f"{spec}\n{self.scene}\n{self.program}".encode()).hexdigest()


@dataclass(frozen=True, eq=False)
class Prefix:
    """The first steps of a plan, carried out without a violation: where they led, and their margins."""

    snapshot: Any
    state: State
    margins: tuple[Mapping[str, float], ...]


@dataclass(frozen=True)
class Failed:
    """The first steps of a plan of which the last violates something; it will do so in every such plan."""

    violations: tuple[Violation, ...]
    state: State
    margins: tuple[Mapping[str, float], ...]


class Prefixes:
    """The prefixes used last in one world and from one initial state, at most `size` of them.

    A prefix is known by the one before it and its last action, so no action of a plan is hashed twice.
    """

    def __init__(self, size: int) -> None:
        self._size = size
        self._known: OrderedDict[tuple[Prefix | None, Action], Prefix] = OrderedDict()
        self._failed: OrderedDict[tuple[Prefix | None, Action], Failed] = OrderedDict()

    def longest(self, plan: Plan) -> Prefix | None:
        """The longest known beginning of a plan, but never the whole plan."""
        found: Prefix | None = None
        for action in plan[:-1] if self._known else ():
            key = (found, action)
            if (longer := self._known.get(key)) is None:
                break
            self._known.move_to_end(key)
            found = longer
        return found

    def keep(self, before: Prefix | None, action: Action, prefix: Prefix) -> None:
        """Remember where an action led; the prefix that was not used for longest goes."""
        if self._size:
            self._known[before, action] = prefix
            if len(self._known) > self._size:
                self._known.popitem(last=False)

    def failure(self, before: Prefix | None, action: Action) -> Failed | None:
        """What is known to come of an action after a prefix, if that is a violation."""
        return self._failed.get((before, action))

    def keep_failure(self, before: Prefix | None, action: Action, failed: Failed) -> None:
        """Remember what came of an action; the failure that was found first goes."""
        if self._size:
            self._failed[before, action] = failed
            if len(self._failed) > self._size:
                self._failed.popitem(last=False)


@dataclass(frozen=True)
class Trial:
    """The verdict on one sample: a plan rolled out, or the error of the program that made none.

    `reached` counts the steps before the first violation. `margins` holds, per step that was carried
    out, the margin of every constraint that applies, in its unit. `screen` names the screen that rejected
    the plan. `rehearsals` counts those of the plan, `index` the samples of a problem from 0.
    """

    plan: Plan | None = None
    violations: tuple[Violation, ...] = ()
    reached: int = 0
    margins: tuple[Mapping[str, float], ...] = ()
    error: Exception | None = None
    screen: str | None = None
    rehearsals: int = 0
    index: int = 0
    u: tuple[float, ...] = ()

    @property
    def accepted(self) -> bool:
        """Whether the world carried the plan out without a violation."""
        return self.plan is not None and not self.violations

    @property
    def progress(self) -> float:
        """How far the sample came, more is better: the steps before its violation, then how small that is.

        The whole part counts the steps. A sample whose program failed comes last, with -1.
        """
        if self.error is not None:
            return -1.0
        # The first violation only: a screen names no others, and the order must not depend on who rejected.
        violation = -self.violations[0].margin if self.violations else 0.0
        return self.reached + 1 / (1 + max(violation, 0.0))


def rollout(world: World[Any], problem: Problem, plan: Plan, prefixes: Prefixes | None = None) -> Trial:
    """Carry a plan out in a world up to its first violating step; the goal is the last step if it counts.

    Pure: the verdict depends on the problem and the plan alone. `prefixes` saves time, and changes nothing.
    """
    trial, final = carry_out(world, problem, plan, prefixes=prefixes or Prefixes(0))
    if not problem.check_goal or not trial.accepted:
        return trial
    score, reason = judge(problem, final, plan)
    if score is None or score.reached:
        return trial
    miss = Violation("goal", len(plan), "goal", -1.0, reason)
    return dataclasses.replace(trial, violations=(miss,))


def carry_out(
    world: World[Any], problem: Problem, plan: Plan, stop: bool = True, prefixes: Prefixes | None = None
) -> tuple[Trial, State]:
    """The trial of a plan, and the state in which it ended; without `stop` it goes on after violations."""
    prefixes, within = prefixes or Prefixes(0), watch().within
    known = prefixes.longest(plan)
    if known is None:
        with within(problem.step_limit, "the reset of the world"):
            world.reset(problem.initial)
        state, margins = problem.initial, []
    else:
        world.resume(known.snapshot)
        state, margins = known.state, list(known.margins)
    if stop and (failed := prefixes.failure(known, plan[len(margins)])):
        return Trial(plan, failed.violations, len(margins), failed.margins), failed.state
    violations: list[Violation] = []
    reached = len(plan)
    for step in range(len(margins), len(plan)):
        with within(problem.step_limit, f"skill {plan[step].skill} (step {step})"):
            transition = world.step(plan[step])
        state = transition.after
        step_margins, found = check(problem.domain, transition, step)
        margins.append(step_margins)
        violations += found
        if found:
            reached = min(reached, step)
            if stop:
                prefixes.keep_failure(known, plan[step], Failed(tuple(found), state, tuple(margins)))
                break
        elif not violations:
            longer = Prefix(world.snapshot, state, tuple(margins))
            prefixes.keep(known, plan[step], longer)
            known = longer
    return Trial(plan, tuple(violations), reached, tuple(margins)), state


def judge(problem: Problem, final: State, plan: Plan) -> tuple[Score | None, str]:
    """All judges of the task must be satisfied; the reason of the first that is not, else of all."""
    if problem.goal != problem.task.instruction:
        return None, "nobody judges an instruction of your own"
    scores = [_score(problem, target, final, plan) for target in problem.task.judge]
    if not scores:
        return None, "the task has no judge"
    missed = [score for score in scores if not score.reached]
    reason = missed[0].reason if missed else "; ".join(score.reason for score in scores)
    return Score(not missed, reason), reason


def _score(problem: Problem, target: Target, final: State, plan: Plan) -> Score:
    """What one judge says. Raises SpecError if that is no score."""
    part = f"judge {target.target} of {problem.name}"
    with blame(part), watch().within(problem.step_limit, part):
        score = target.load()(final, plan, **target.args)
    if (
        isinstance(score, Score)
        and isinstance(score.reached, bool | np.bool_)
        and isinstance(score.reason, str)
    ):
        return Score(bool(score.reached), score.reason)
    raise not_wanted(part, score, "a Score of a bool and a reason in words")
