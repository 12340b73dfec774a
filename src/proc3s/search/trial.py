"""The verdict on one sample."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from proc3s.domain.margins import Violation
from proc3s.domain.room import Room
from proc3s.domain.values import Plan


@dataclass(frozen=True)
class Trial:
    """The verdict on one sample: a plan rolled out, or the error of the program that made none.

    `reached` counts the steps before the first violation. `margins` holds, per step that was carried
    out, the margin of every constraint that applies, in its unit; `room` is the tightest of them and of the
    goal, if it was looked at, of a plan that is accepted without errors. `screen` names the screen that
    rejected the plan. `rehearsals` counts those of the plan, `index` the samples of a problem from 0.
    `goal` is the margin of the judges, if they were asked and there is one. `left` is only known while a plan
    is improved: all margins in expected errors, by step and constraint, the goal after the last step; that of
    the violation only where a screen rejected the sample.
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
    room: Room | None = None
    goal: float | None = None
    left: Mapping[tuple[int, str], float] = field(default_factory=dict)

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
