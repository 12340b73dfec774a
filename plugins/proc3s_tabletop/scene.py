"""The scene: table, robot and bodies in one client, put into a snapshot so that nothing earlier matters."""

import tempfile
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from proc3s_tabletop.bodies import Body
from proc3s_tabletop.client import Client
from proc3s_tabletop.recipe import HOME, Recipe
from proc3s_tabletop.robot import Robot
from proc3s_tabletop.telemetry import Quaternion, Vector

GRAVITY = (0.0, 0.0, -9.8)
"""m/s2"""

TABLE = "table"


class Frame(NamedTuple):
    """A pose as PyBullet has it: metres, and a quaternion x, y, z, w."""

    position: Vector
    rotation: Quaternion


class Held(NamedTuple):
    """What the hand holds, and where in the frame of tool0."""

    name: str
    frame: Frame


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

    def loose(self) -> dict[str, Frame]:
        """Where all objects are that are not in hand."""
        held = self.held.name if self.held else None
        return {name: frame for name, frame in self.frames if name != held}


class Scene:
    """A table with its top at z = 0, the robot, and the named bodies."""

    def __init__(self, bodies: Mapping[str, Body], recipe: Recipe) -> None:
        self.recipe = recipe
        self.client = client = Client()
        client.setTimeStep(recipe.tick)
        client.setGravity(*GRAVITY)
        # Contacts are then solved in an order that does not depend on what happened before.
        client.setPhysicsEngineParameter(deterministicOverlappingPairs=1)
        with tempfile.TemporaryDirectory() as folder:
            self.table = self._table()
            self.robot = Robot(client, recipe, Path(folder))
            self.bodies = {
                name: body.create(client, Path(folder), _parked(k))
                for k, (name, body) in enumerate(bodies.items())
            }
        self._masses = {name: body.mass for name, body in bodies.items()}
        for link in (-1, *self.robot.links):
            # The base stands on the table.
            client.setCollisionFilterPair(self.robot.id, self.table, link, -1, int(link > self.robot.base))
        self.names = {body: name for name, body in self.bodies.items()} | {self.table: TABLE}
        self.held: Held | None = None

    def _table(self) -> int:
        """A slab wider than the table's bounds: what leaves them is judged, not dropped."""
        client = self.client
        slab = client.createCollisionShape(client.GEOM_BOX, halfExtents=[1.0, 1.0, 0.05])
        table = int(client.createMultiBody(0, slab, -1, [0, -0.5, -0.05]))
        client.changeDynamics(table, -1, lateralFriction=self.recipe.table_friction)
        return table

    def load(self, snapshot: Snapshot) -> None:
        """Put everything where a snapshot has it, bit for bit the same whatever the client did before.

        PyBullet keeps contacts of touching bodies from one step to the next; all bodies are parked apart
        first, and collisions detected, so that none are left.
        """
        self.set_iterations(self.recipe.iterations)
        for k, name in enumerate(self.bodies):
            self.put(name, Frame(_parked(k), (0.0, 0.0, 0.0, 1.0)))
            self.let_collide(name, True)
        self.robot.put_arm(np.array(HOME))
        self.robot.put_fingers(0.0)
        self.client.performCollisionDetection()
        self.client.performCollisionDetection()
        self.robot.put_arm(np.array(snapshot.q))
        self.robot.put_fingers(snapshot.angle)
        if snapshot.linkage:
            self.robot.put_linkage(snapshot.linkage)
        self.robot.drive(snapshot.angle)
        self.held = snapshot.held
        self.bring_back(dict(snapshot.frames))

    def save(self) -> Snapshot:
        """The scene as it stands, at rest."""
        frames = tuple((name, _rounded(self.frame(name), 7)) for name in self.bodies)
        held = self.held and Held(self.held.name, _rounded(self.held.frame, 9))
        q = tuple(round(float(angle), 10) for angle in self.robot.q)
        return Snapshot(frames, q, round(self.robot.angle, 9), held)

    def close(self) -> None:
        """Give up the client."""
        self.client.close()

    def frame(self, name: str) -> Frame:
        """Where an object is."""
        return Frame(*self.client.getBasePositionAndOrientation(self.bodies[name]))

    def frames(self) -> dict[str, Frame]:
        """Where all objects are that are not in hand."""
        return {name: self.frame(name) for name in self.loose()}

    def loose(self) -> Iterator[str]:
        """The objects that are not in hand."""
        return (name for name in self.bodies if not self.held or name != self.held.name)

    def put(self, name: str, frame: Frame) -> None:
        """Move an object, keeping its velocity."""
        self.client.resetBasePositionAndOrientation(self.bodies[name], *frame)

    def park(self, name: str) -> None:
        """Move an object out of everything's way."""
        self.put(name, Frame(_parked(list(self.bodies).index(name)), (0.0, 0.0, 0.0, 1.0)))

    def set_aside(self, names: Iterable[str]) -> dict[str, Frame]:
        """Park objects that cannot matter for a while; returns where they were."""
        frames = {name: self.frame(name) for name in names}
        for name in frames:
            self.park(name)
        return frames

    def bring_back(self, frames: Mapping[str, Frame]) -> None:
        """Put objects back, at rest."""
        for name, frame in frames.items():
            self.put(name, frame)
            self.stop(name)

    def stop(self, name: str) -> None:
        """Bring an object to rest."""
        self.client.resetBaseVelocity(self.bodies[name], [0, 0, 0], [0, 0, 0])

    def speeds(self, name: str) -> tuple[float, float]:
        """The largest component of an object's velocity (m/s) and of its turn (rad/s)."""
        linear, angular = self.client.getBaseVelocity(self.bodies[name])
        return max(map(abs, linear)), max(map(abs, angular))

    def let_collide(self, name: str, on: bool) -> None:
        """Whether an object meets the table and the other objects; it always meets the robot."""
        for other in (self.table, *self.bodies.values()):
            if other != self.bodies[name]:
                self.client.setCollisionFilterPair(self.bodies[name], other, -1, -1, int(on))

    def set_iterations(self, count: int) -> None:
        """Iterations of the contact solver from now on."""
        self.client.setPhysicsEngineParameter(numSolverIterations=count)

    def tick(self, count: int = 1) -> None:
        """Let time pass."""
        for _ in range(count):
            self.client.stepSimulation()

    def push(self, name: str, acceleration: Vector) -> None:
        """Pull at an object's centre of mass for the next tick, m/s2 beside gravity."""
        body = self.bodies[name]
        force = [self._masses[name] * a for a in acceleration]
        self.client.applyExternalForce(body, -1, force, self.frame(name).position, self.client.WORLD_FRAME)

    def in_tool(self, name: str) -> Frame:
        """Where an object is in the frame of tool0."""
        inverse = self.client.invertTransform(*self.robot.tool())
        return Frame(*self.client.multiplyTransforms(*inverse, *self.frame(name)))

    def carry(self) -> None:
        """Move the held object to where the hand has it."""
        if self.held:
            frame = self.client.multiplyTransforms(*self.robot.tool(), *self.held.frame)
            self.put(self.held.name, Frame(*frame))


def _parked(k: int) -> Vector:
    """A place a metre from the next, far from the table."""
    return 9.0 + k, 0.0, 9.0


def _rounded(frame: Frame, digits: int) -> Frame:
    """Numbers that survive being set and read again."""
    x, y, z = (round(float(v), digits) for v in frame.position)
    qx, qy, qz, qw = (round(float(v), 9) for v in frame.rotation)
    return Frame((x, y, z), (qx, qy, qz, qw))
