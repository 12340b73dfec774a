"""Questions to simulations and their answers, as plain data."""

import math
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.telemetry import Clearance, Telemetry, Vector, least

Lies: TypeAlias = tuple[tuple[Body, Frame], ...]
"""Bodies and where they are."""

ALOFT = Frame((0.0, 0.0, 1.0), (1.0, 0.0, 0.0, 0.0))
"""Where the hand touches nothing."""


ANY = math.inf
"""A bound of upward parts of directions that leaves none out; rounded ones may be a little over one."""


class Touch(NamedTuple):
    """A contact of the held object, and the direction in which the other body pushes it."""

    clearance: Clearance
    normal: Vector


@dataclass(frozen=True)
class Grip:
    """The result of a grip; it failed where the telemetry has `ended`, and is left as it was then.

    `held` is the target in the frame of tool0, `lies` where the others are, in the order in which they were
    given. The telemetry names a body by its place in that order.
    """

    telemetry: Telemetry
    angle: float
    held: Frame
    lies: tuple[Frame, ...]


class Rest(NamedTuple):
    """Where things come to rest, in the order in which they were given, and whether they did in time."""

    frames: tuple[Frame, ...]
    at_rest: bool


def deepest(touches: list[Touch]) -> Clearance | None:
    """The deepest contact."""
    return least([touch.clearance for touch in touches])
