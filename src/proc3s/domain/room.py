"""Room: how many errors of the expected size a plan stands before a constraint or a judge would refuse it."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from proc3s.domain.domain import Domain
from proc3s.domain.values import Plan
from proc3s.wording import plain

GOAL = "goal"
"""Stands for the judges of the task, where a constraint is named."""


@dataclass(frozen=True)
class Room:
    """The tightest margin of a plan, and how many expected errors it is worth: `value`.

    `constraint` at `step` (from 0) leaves the `margin`, in the unit of the constraint; the goal has no step.
    `says` are the words of the constraint or judge, if it has some.
    """

    value: float
    constraint: str
    step: int | None
    margin: float
    says: str = ""

    def __str__(self) -> str:
        by = plain(self.margin, 3)
        if self.step is None:
            return f"{self.value:.1f}, by {by} at the goal{f': {self.says}' if self.says else ''}"
        return f"{self.value:.1f}, at step {self.step}: {self.says or f'{self.constraint} by {by}'}"


def room_at(
    domain: Domain, constraint: str, skill: str, step: int, margin: float, says: str = ""
) -> Room | None:
    """What a constraint leaves at a step; None where it knows yes and no only."""
    error = expected_error(domain, constraint, skill)
    if error is None or not math.isfinite(margin):
        return None
    spare = margin + domain.spec.constraints[constraint].tolerance
    return Room(max(spare, 0.0) / error, constraint, step, margin, says)


def room_at_goal(domain: Domain, margin: float | None, reason: str) -> Room | None:
    """What the judges leave, whose margin the errors of what is placed use up."""
    if margin is None or not math.isfinite(margin):
        return None
    return Room(max(margin, 0.0) / domain.spec.errors.of_placed, GOAL, None, margin, reason)


def tightest(*rooms: Room | None) -> Room | None:
    """The smallest, the first of equal ones; None where nothing limits."""
    found = [room for room in rooms if room is not None]
    return min(found, key=lambda room: room.value, default=None)


def left(
    domain: Domain, plan: Plan, margins: Sequence[Mapping[str, float]], goal: float | None
) -> dict[tuple[int, str], float]:
    """The margins of a plan, and of the goal after its last step, in the errors that use them up.

    Negative where a constraint is violated; without those that know yes and no only.
    """
    constraints = domain.spec.constraints
    found = {
        (step, name): (margin + constraints[name].tolerance) / error
        for step, here in enumerate(margins)
        for name, margin in here.items()
        if (error := expected_error(domain, name, plan[step].skill)) and math.isfinite(margin)
    }
    if goal is not None and math.isfinite(goal):
        found[len(plan), GOAL] = goal / domain.spec.errors.of_placed
    return found


def expected_error(domain: Domain, constraint: str, skill: str) -> float | None:
    """The error that uses up the margin of a constraint at a step with a skill; None: none does."""
    kind = domain.spec.constraints[constraint].error or domain.spec.skills[skill].error
    if kind == "none":
        return None
    errors = domain.spec.errors
    known = {
        "picked": errors.picked,
        "placed": errors.of_placed,
        "turn": errors.turn,
        "speed": errors.speed,
    }
    return known[kind] or None
