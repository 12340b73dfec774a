"""The continuous constraint satisfaction problem as plain data, and the one pure function on it."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from proc3s.constraints import Violation, check
from proc3s.domain import Domain
from proc3s.specs import TaskSpec
from proc3s.state import Plan, State
from proc3s.world import World


@dataclass(frozen=True)
class Problem:
    """A CCSP: a domain, an initial state, a goal in words, a program, a seed and a budget of samples.

    It hashes, pickles and replays; `scene` is the initial state as JSON.
    """

    domain: Domain
    task: TaskSpec
    scene: str
    goal: str
    seed: int
    samples: int
    program: str = ""

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

    def digest(self) -> str:
        """SHA-256 over everything that the verdict on a plan depends on."""
        spec = self.domain.spec.model_dump_json()
        return hashlib.sha256(f"{spec}\n{self.scene}\n{self.program}".encode()).hexdigest()


@dataclass(frozen=True)
class Trial:
    """The verdict on one sample: a plan rolled out, or the error of the program that made none.

    `reached` counts the steps before the first violation. `margins` holds, per step that was carried
    out, the margin of every constraint that applies. `index` counts the samples of a problem from 0.
    """

    plan: Plan | None = None
    violations: tuple[Violation, ...] = ()
    reached: int = 0
    margins: tuple[Mapping[str, float], ...] = ()
    error: Exception | None = None
    index: int = 0
    u: tuple[float, ...] = ()

    @property
    def accepted(self) -> bool:
        """Whether the world carried the plan out without a violation."""
        return self.plan is not None and not self.violations


def rollout(world: World[Any], problem: Problem, plan: Plan, stop: bool = True) -> Trial:
    """Carry a plan out in a world and test every step; `stop` ends it at the first violating step.

    Pure: the verdict depends on the problem and the plan alone.
    """
    trial, _ = carry_out(world, problem, plan, stop)
    return trial


def carry_out(world: World[Any], problem: Problem, plan: Plan, stop: bool) -> tuple[Trial, State]:
    """`rollout`, together with the state in which it ended."""
    state = problem.initial
    world.reset(state)
    violations: list[Violation] = []
    margins: list[Mapping[str, float]] = []
    reached = len(plan)
    for step, action in enumerate(plan):
        transition = world.step(action)
        state = transition.after
        step_margins, found = check(problem.domain, transition, step)
        margins.append(step_margins)
        violations += found
        if found:
            reached = min(reached, step)
            if stop:
                break
    return Trial(plan, tuple(violations), reached, tuple(margins)), state
