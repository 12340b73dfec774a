"""What the table-top world measures while it carries out an action."""

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias

Vector: TypeAlias = tuple[float, float, float]


Quaternion: TypeAlias = tuple[float, float, float, float]


Attempted: TypeAlias = Literal["pick", "place"]
"""What an action tried, whatever its skill is called."""


Stage: TypeAlias = Literal[
    "hand", "reach", "approach", "grasp", "close", "lift", "carry", "descent", "support", "release"
]
"""Where an action can end early.

hand: it was full before a pick, or empty before a place; reach: no joint angles along the way; approach: the
open hand touched something on its way to a grasp; grasp: too little between the fingers; close: a finger
touched something else, or not both held the object; lift: the object slipped in the shaken hand; carry: arm,
hand or held object touched something on the way; descent: something other than the support was in the way of
a place; support: nothing to stand on within reach below; release: the opening or leaving hand touched
something.
"""


@dataclass(frozen=True)
class Clearance:
    """The distance of two bodies in m, negative where they penetrate; `body` is of the robot or its load.

    `shared`: both were, or are, set down off their place, so each may use up half of it.
    """

    distance: float
    body: str
    other: str
    shared: bool = False

    @property
    def each(self) -> float:
        """How far each of those that may be off their place may be so, m."""
        return self.distance / 2 if self.shared else self.distance


@dataclass(frozen=True)
class Displacement:
    """How far an object moved: metres level and upright, and radians turned in all and leaning over."""

    name: str
    level: float
    upright: float
    turned: float
    leaned: float

    @property
    def shift(self) -> float:
        """The larger of the two distances, metres."""
        return max(self.level, self.upright)


@dataclass(frozen=True)
class Bound:
    """How far a centre lies inside the bounds of the table, metres; negative outside.

    `name` is an object, or "target" for the commanded point.
    """

    distance: float
    name: str


@dataclass(frozen=True)
class Telemetry:
    """What one pick or place measured: metres, radians, names of objects; None where it never came to that.

    The world judges nothing: constraints do. `ended` is the stage at which the action ended early; the world
    then stands as it did before the action.
    """

    attempted: Attempted | None = None
    """What was tried; a skill that neither picks nor places leaves it out."""
    commanded: Vector | None = None
    """Where the grasp point was to come, m in the world."""
    ended: Stage | None = None
    target: str | None = None
    """The object the action is about: found between the fingers, or in hand at the start of a place."""
    wanted: str | None = None
    """The object that the action names, where skills name objects."""
    grasp_apart: float | None = None
    """How far the grasp that a place names is from that of the pick, m; a rad counts 40 mm."""
    held: str | None = None
    """What the hand holds when the action is over."""
    ik_residual: float | None = None
    """Largest distance of the grasp point from its line on the way; if out of reach, the miss."""
    clearance: Clearance | None = None
    """The smallest clearance to a side: of the robot at grasp, set-down and opening, and of what is set down;
    where the action ended in contact, that."""
    cover: float | None = None
    """Share of a grid of rays between the pads that meet the target, 0 to 1."""
    too_wide: str | None = None
    """An object that is wider than the hand can take where it was to be grasped."""
    finger_gap: float | None = None
    """Distance of the closed pads."""
    grip_force: float | None = None
    """Normal force of the pad that presses less, newtons."""
    slip: float | None = None
    slip_angle: float | None = None
    """How far the target moved and turned in the hand while it was shaken."""
    support: str | None = None
    """What the held object was set down on."""
    support_height: float | None = None
    """Where the support was met above the commanded z; negative is the drop below it."""
    displacements: tuple[Displacement, ...] | None = None
    """Every object that is not in hand, against its pose before the fingers moved, once all is at rest.

    What was released counts from the end of its free drop.
    """
    knocked_over: tuple[str, ...] | None = None
    """The other objects that lean over."""
    at_rest: bool | None = None
    """Whether everything came to rest within the time given to it."""
    bounds: Bound | None = None
    """The least distance inside the table of the target and of every object that is not in hand."""


def least(clearances: "list[Clearance | None]") -> Clearance | None:
    """The smallest of the clearances that exist; ties go to the first."""
    return min((c for c in clearances if c), key=lambda c: c.each, default=None)


def displacement(
    name: str, before: tuple[Vector, Quaternion], after: tuple[Vector, Quaternion], drop: float = 0.0
) -> Displacement:
    """Compare two poses (position in metres, quaternion x, y, z, w); `drop` is the fall that was expected."""
    (p0, q0), (p1, q1) = before, after
    level = math.hypot(p1[0] - p0[0], p1[1] - p0[1])
    cosine = abs(sum(a * b for a, b in zip(q0, q1, strict=True)))
    up0, up1 = _up(q0), _up(q1)
    lean = math.acos(max(-1.0, min(1.0, sum(a * b for a, b in zip(up0, up1, strict=True)))))
    return Displacement(name, level, abs(p1[2] - p0[2] + drop), 2 * math.acos(min(1.0, cosine)), lean)


def _up(q: Quaternion) -> Vector:
    """The third axis of a rotation."""
    x, y, z, w = q
    return 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)


TABLE = "table"
