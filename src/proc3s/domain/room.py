"""Room: how many errors of the expected size a plan stands before a constraint or a judge would refuse it."""

import math
from dataclasses import dataclass

from proc3s.domain.domain import Domain
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
    left = errors_left(domain, constraint, skill, margin)
    return None if left is None else Room(max(left, 0.0), constraint, step, margin, says)


def room_at_goal(domain: Domain, margin: float | None, reason: str) -> Room | None:
    """What the judges leave."""
    left = goal_left(domain, margin)
    return None if left is None or margin is None else Room(max(left, 0.0), GOAL, None, margin, reason)


def tightest(*rooms: Room | None) -> Room | None:
    """The smallest, the first of equal ones; None where nothing limits."""
    found = [room for room in rooms if room is not None]
    return min(found, key=lambda room: room.value, default=None)


def errors_left(domain: Domain, constraint: str, skill: str, margin: float) -> float | None:
    """A margin at a step in errors that use it up, negative where it is violated; None: there are none."""
    error = expected_error(domain, constraint, skill)
    if error is None or not math.isfinite(margin):
        return None
    return (margin + domain.spec.constraints[constraint].tolerance) / error


def goal_left(domain: Domain, margin: float | None) -> float | None:
    """The same of the judges' margin, which the errors of what is placed use up."""
    return margin / domain.spec.errors.of_placed if margin is not None and math.isfinite(margin) else None


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
