"""Protocols: the simulated table that actions work on, and the engine that makes one.

Poses are frames of the world in metres, with quaternions x, y, z, w; angles in radians, forces in newtons.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Protocol

from proc3s import FloatArray
from proc3s_tabletop.engine.snapshot import Snapshot
from proc3s_tabletop.engine.values import ANY, Grip, Lies, Rest, Touch
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.frames import Frame, Held
from proc3s_tabletop.robot.hand_profile import HandProfile
from proc3s_tabletop.robot.settings import ReferenceSettings
from proc3s_tabletop.telemetry import Clearance, Quaternion, Vector

if TYPE_CHECKING:
    from PIL.Image import Image


class Hand(Protocol):
    """A hand of two fingers; `angle` is the one that its fingers are driven to, 0 wide open."""

    angle: float
    settings: ReferenceSettings

    def tool(self) -> tuple[Vector, Quaternion]:
        """The pose of tool0."""

    def put_fingers(self, angle: float) -> None:
        """Set the fingers, at rest."""

    def drive_fingers(self, angle: float) -> None:
        """Let the motor of the fingers turn them towards an angle."""

    def read_fingers(self) -> tuple[float, float]:
        """Angle (rad) and speed (rad/s) of the finger joint."""

    def held_angle(self) -> float:
        """The angle that the fingers are to be put to so that they are where they are now, under load."""

    def linkage(self) -> tuple[float, ...]:
        """The angle of every finger joint."""

    def grasp_point(self) -> tuple[FloatArray, FloatArray]:
        """The point between the fingertips (3,), and the direction the fingers point (3,)."""

    def gap(self) -> float:
        """Distance of the pads, metres."""

    def angle_for(self, gap: float) -> float:
        """The finger angle at which the pads are this far apart."""


class FloatingHand(Hand, Protocol):
    """A hand without an arm, fixed in the air where it is put."""

    def put(self, position: Vector, rotation: Quaternion) -> None:
        """Put tool0 at a pose."""


class Robot(Hand, Protocol):
    """An arm with a hand; `q` holds the joint angles (6,) of the arm."""

    q: FloatArray

    def put_arm(self, q: FloatArray) -> None:
        """Set the joint angles (6,) of the arm, at rest."""

    def drive_arm(self, q: FloatArray, torques: Sequence[float]) -> None:
        """Let the motors turn the arm towards joint angles (6,) with at most these torques, Nm."""

    def read_arm(self) -> tuple[FloatArray, FloatArray]:
        """Angles (6,) in rad and speeds (6,) in rad/s of the arm's joints."""


class Guard(Protocol):
    """Says when a descent has met something; `support` is what the load has met, if it was the load."""

    support: str | None

    def __call__(self) -> bool:
        """Whether anything presses the hand or what it holds, each other apart."""


class TableSimulation(Protocol):
    """A simulated table with named bodies: what all simulations have in common."""

    settings: ReferenceSettings
    shapes: Mapping[str, Body]

    @property
    def names(self) -> tuple[str, ...]:
        """The bodies, in the order of the scene."""

    def clear(self) -> None:
        """Park every body, and forget all contacts."""

    def frame(self, name: str) -> Frame:
        """Where an object is."""

    def put(self, name: str, frame: Frame) -> None:
        """Move an object, keeping its velocity."""

    def bring_back(self, frames: Mapping[str, Frame]) -> None:
        """Put objects back, at rest."""

    def set_iterations(self, count: int) -> None:
        """Iterations of the contact solver from now on."""

    def tick(self, count: int = 1) -> None:
        """Let time pass."""

    def speeds(self, name: str) -> tuple[float, float]:
        """The largest component of an object's velocity (m/s) and of its turn (rad/s)."""

    def touched(self, name: str) -> set[str]:
        """What an object touches after a tick, by name; the table is TABLE."""

    def cover(self) -> dict[str, float]:
        """The share of the grid of rays between the pads that meets each object, by name."""

    def close(self) -> None:
        """Release the simulator."""


class HandSimulation(TableSimulation, Protocol):
    """Bodies on a table under a hand without an arm."""

    @property
    def hand(self) -> FloatingHand:
        """The hand."""

    def hand_depth(self, name: str) -> float:
        """How far the hand reaches into an object, metres; 0 where they do not meet."""

    def depth(self, one: str, other: str) -> float:
        """How deep two objects, or an object and TABLE, are in one another, metres; 0 if they are not."""


class GripScene(HandSimulation, Protocol):
    """Bodies on a table under a hand without an arm, which grips them and shakes them."""

    def let_collide(self, name: str, on: bool) -> None:
        """Whether an object meets the table and the other objects; it always meets the hand."""

    def push(self, name: str, acceleration: Vector) -> None:
        """Pull at an object's centre of mass for the next tick, m/s2 beside gravity."""

    def in_tool(self, name: str) -> Frame:
        """Where an object is in the frame of tool0."""

    def robot_contact(self, gripped: str | None = None) -> Clearance | None:
        """The deepest contact of the hand, that with the object it grips apart."""

    def grip_force(self, name: str) -> float:
        """Normal force of the side of the hand that presses an object less, newtons."""


class Simulation(TableSimulation, Protocol):
    """Bodies on a table under a robot, put into a snapshot so that nothing earlier matters."""

    held: Held | None

    @property
    def robot(self) -> Robot:
        """The arm and its hand."""

    def load(self, snapshot: Snapshot) -> None:
        """Restore a snapshot, bit for bit the same whatever was simulated before."""

    def save(self) -> Snapshot:
        """The scene as it stands, at rest."""

    def frames(self) -> dict[str, Frame]:
        """Where all objects are that are not in hand."""

    def loose(self) -> Iterator[str]:
        """The objects that are not in hand."""

    def lies(self, names: Iterable[str]) -> Lies:
        """Bodies and where they are."""

    def near(self, name: str, distance: float) -> list[str]:
        """The other objects that are this close to one, metres."""

    def company(self, names: Iterable[str]) -> set[str]:
        """The objects among `names`, and all that touch them, directly or through others."""

    def in_tool(self, name: str) -> Frame:
        """Where an object is in the frame of tool0."""

    def carry(self) -> None:
        """Move the held object to where the hand has it."""

    def detect(self) -> None:
        """Find all contacts where everything is now, without letting time pass."""

    def settle(self, names: Sequence[str]) -> bool:
        """Let time pass until these objects are still; False if they are not in time."""

    def robot_contact(self, gripped: str | None = None) -> Clearance | None:
        """The deepest contact of the robot, with itself too; the hand may touch the object it grips."""

    def held_touches(self, name: str) -> list[Touch]:
        """What an object in hand touches, the robot apart."""

    def hand_clearances(self, gripped: str | None = None, steepest: float = ANY) -> dict[str, Clearance]:
        """The smallest distance of the robot to everything near but the gripped object, by name.

        Directions with an upward part of more than `steepest` do not count.
        """

    def beside(self, name: str, other: str, most: float) -> float | None:
        """The smallest distance of two objects of which one is beside the other, not above it, m; None where
        it is `most` or more.
        """

    def grip_force(self, name: str) -> float:
        """Normal force of the side of the hand that presses an object less, newtons."""

    def between_pads(self) -> str | None:
        """The object that both sides of the hand press, the hardest first."""

    def support(self, name: str) -> str | None:
        """What pushes an object up hardest."""

    def guard(self, held: str | None) -> Guard:
        """A guard of a descent with an object in hand, or without."""


class GripSimulation(Protocol):
    """Grips and falls of a few things apart from the scene; equal questions have equal answers."""

    def grip(self, tool: Frame, lies: Lies, speed: float) -> Grip:
        """Close the hand, its tool0 at a frame, on the first of the bodies that lie there."""

    def rest(self, lies: Lies) -> Rest:
        """Where bodies come to rest that nothing holds any more."""

    def close(self) -> None:
        """Release the simulator."""


class Studio(Protocol):
    """Draws snapshots, without a display; no simulation ever notices."""

    def picture(self, snapshot: Snapshot) -> "Image":
        """How a snapshot looks."""

    def close(self) -> None:
        """Release what draws."""


class Engine(Protocol):
    """Makes simulations; whoever asks for one closes it after use."""

    def require(self) -> None:
        """Raise UsageError where a package is missing that the engine needs."""

    def settings(self) -> ReferenceSettings:
        """The constants of a reference world in this engine."""

    def profile(self) -> HandProfile:
        """What of the hand meets things on its way straight down."""

    def scene(self, bodies: Mapping[str, Body], settings: ReferenceSettings) -> Simulation:
        """A table with the robot and these bodies."""

    def hand_scene(self, bodies: Mapping[str, Body], settings: ReferenceSettings) -> HandSimulation:
        """A table with a floating hand and these bodies."""

    def grips(self, bodies: Mapping[str, Body], settings: ReferenceSettings) -> GripSimulation:
        """Grips and falls among these bodies."""

    def landed(self, pieces: Sequence[FloatArray], turn: FloatArray) -> FloatArray:
        """Which direction (3,) of a body, its origin the centre of mass, is down when it has come to rest
        that was let go with a turn (3, 3)."""

    def studio(self, bodies: Mapping[str, Body], colors: Mapping[str, str]) -> Studio:
        """A table with the robot and these bodies to be drawn; colours are names."""
