"""The scene: table, robot and bodies in one client, put into a snapshot so that nothing earlier matters."""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from proc3s_tabletop.bullet.arm import Robot
from proc3s_tabletop.bullet.simulation import Things
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.frames import Frame, Held, rounded
from proc3s_tabletop.robot.settings import HOME, ReferenceSettings


@dataclass(frozen=True)
class Snapshot:
    """Everything that a step depends on: at rest, rounded, comparable, and plain data.

    Poses of objects by name in the order of the scene, joint angles of the arm, the angle that the fingers
    are driven to, and `linkage`, the angles of all finger joints, where they hold something by friction.
    """

    frames: tuple[tuple[str, Frame], ...]
    q: tuple[float, ...] = HOME
    angle: float = 0.0
    held: Held | None = None
    linkage: tuple[float, ...] = ()
    grasp: tuple[float, ...] = ()
    """The six numbers of the grasp, in the frame of the object, that a pick named with the object."""

    def after(self, before: "Snapshot") -> "Snapshot":
        """The same, but what has hardly moved since `before` is where it was: nothing creeps."""
        frames = zip(before.frames, self.frames, strict=True)
        held = {snapshot.held.name for snapshot in (before, self) if snapshot.held}
        kept = ((n, old if n not in held and _same(old, new) else new) for (n, old), (_, new) in frames)
        return dataclasses.replace(self, frames=tuple(kept))

    def loose(self) -> dict[str, Frame]:
        """Where all objects are that are not in hand."""
        held = self.held.name if self.held else None
        return {name: frame for name, frame in self.frames if name != held}


class Scene(Things):
    """A table with its top at z = 0, the robot, and the named bodies."""

    robot: Robot

    def __init__(self, bodies: Mapping[str, Body], recipe: ReferenceSettings) -> None:
        super().__init__(bodies, recipe, Robot)
        for link in (-1, *self.robot.links):
            # The base stands on the table.
            on = int(link > self.robot.base)
            self.client.setCollisionFilterPair(self.robot.id, self.table, link, -1, on)

    def load(self, snapshot: Snapshot) -> None:
        """Put everything where a snapshot has it, bit for bit the same whatever the client did before."""
        self.set_iterations(self.recipe.iterations)
        self.robot.put_arm(np.array(HOME))
        self.robot.put_fingers(0.0)
        self.clear()
        self.robot.put_arm(np.array(snapshot.q))
        self.robot.put_fingers(snapshot.angle)
        if snapshot.linkage:
            self.robot.put_linkage(snapshot.linkage)
        self.robot.drive(snapshot.angle)
        self.held = snapshot.held
        self.bring_back(dict(snapshot.frames))

    def save(self) -> Snapshot:
        """The scene as it stands, at rest."""
        frames = tuple((name, rounded(self.frame(name), 7)) for name in self.bodies)
        held = self.held and Held(self.held.name, rounded(self.held.frame, 9))
        q = tuple(round(float(angle), 10) for angle in self.robot.q)
        return Snapshot(frames, q, round(self.robot.angle, 9), held)


def _same(a: Frame, b: Frame) -> bool:
    """Whether two frames differ by less than 0.1 mm along every axis and by about 0.001 rad."""
    apart = max(abs(p - q) for p, q in zip(a.position, b.position, strict=True))
    turned = max(abs(p - q) for p, q in zip(a.rotation, b.rotation, strict=True))
    return apart < 1e-4 and turned < 5e-4
