"""The continuous constraint satisfaction problem as plain data, and the one pure function on it."""

import json
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

from proc3s.domain.domain import Domain
from proc3s.domain.state import State
from proc3s.search.watch import SECONDS
from proc3s.specs.domain import ScreenSpec, TaskSpec


@dataclass(frozen=True)
class Problem:
    """A CCSP: a domain, an initial state, a goal in words, a seed and a budget of samples.

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
        spec = self.domain.spec
        return hash((self.scene, self.goal, self.seed, repr(spec.world), repr(spec.execution)))

    def active_screens(self, stateful: bool) -> tuple[ScreenSpec, ...]:
        """The screens that may be used, of one of the two sorts."""
        wanted = {"all": (True, False), "exact": (True,), "none": ()}[self.screens]
        return tuple(s for s in self.domain.screens if s.exact in wanted and s.stateful == stateful)
