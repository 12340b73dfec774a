"""Constraints: a margin for every transition, and the violations that negative margins are."""

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from numbers import Real
from typing import Any, NamedTuple

import numpy as np

from proc3s.domain.domain import Domain
from proc3s.domain.room import Room, room_at, tightest
from proc3s.domain.world import Transition
from proc3s.errors import Issue, SpecError, blame, not_wanted
from proc3s.specs.domain import ConstraintSpec
from proc3s.wording import plain


@dataclass(frozen=True)
class Margin:
    """How far a constraint is from being violated, in its own unit; negative when violated.

    `details` fill the placeholders of the constraint's sentence. `says` tells in words what is left where it
    is fulfilled, with the number: `the gripper passes object_4 at 2.3 mm`.
    """

    value: float
    details: Mapping[str, str] = field(default_factory=dict)
    says: str = field(default="", repr=False)


@dataclass(frozen=True)
class Violation:
    """A constraint that a step of a plan violates; `step` counts from 0, `text` is for LLM and people."""

    constraint: str
    step: int
    skill: str
    margin: float
    """In the constraint's unit; negative."""
    text: str

    def to_json(self) -> dict[str, Any]:
        """The violation as it stands in logs; JSON has no infinite margin, so that is None."""
        margin = self.margin if math.isfinite(self.margin) else None
        return {**dataclasses.asdict(self), "margin": margin}


class Checked(NamedTuple):
    """What the constraints say of a step: margins by constraint, violations in their order, and the room."""

    margins: dict[str, float]
    violations: list[Violation]
    room: Room | None


def check(domain: Domain, transition: Transition[object], step: int) -> Checked:
    """What the constraints of a domain say of a transition.

    A margin function returns a number, a `Margin`, a bool (True is fulfilled), or None where the
    constraint does not apply. Raises SpecError if it returns anything else, or NaN.
    """
    margins: dict[str, float] = {}
    room: Room | None = None
    violations: list[Violation] = []
    for name, function in domain.margins.items():
        spec = domain.spec.constraints[name]
        with blame(f"constraint {name}"):
            value = function(transition, **spec.args)
        margin = _margin(name, value)
        if margin is None:
            continue
        margins[name] = margin.value
        if not isinstance(value, bool | np.bool_):
            skill = transition.action.skill
            room = tightest(room, room_at(domain, name, skill, step, margin.value, margin.says))
        if margin.value < -spec.tolerance:
            text = sentence(spec, margin.details)
            violations.append(Violation(name, step, transition.action.skill, margin.value, text))
    return Checked(margins, violations, room)


def _margin(name: str, value: object) -> Margin | None:
    if value is None:
        return None
    if isinstance(value, bool | np.bool_):
        value = 1.0 if value else -1.0
    if isinstance(value, Real):
        value = Margin(float(value))
    if isinstance(value, Margin) and isinstance(value.value, Real) and isinstance(value.details, Mapping):
        number = float(value.value)
        if not math.isnan(number):
            return Margin(number, value.details, str(value.says))
    raise not_wanted(f"constraint {name}", value, "a margin (a number, a Margin, a bool or None)")


def sentence(spec: ConstraintSpec, details: Mapping[str, str]) -> str:
    """The text of a violation of a constraint. Raises SpecError if a placeholder is left without a detail."""
    try:
        return spec.says.format_map({k: _shown(v) for k, v in details.items()})
    except (KeyError, ValueError, IndexError, AttributeError, TypeError) as error:
        message = f"the margin carries no detail {error} ({', '.join(details) or 'it carries none'})"
        raise SpecError([Issue(f"constraint {spec.name}", "says", message)]) from error


def _shown(detail: object) -> object:
    """A detail is a text; where it is a number all the same, the sentence shows it as people write it."""
    return plain(float(detail), 3) if isinstance(detail, float | np.floating) else detail
