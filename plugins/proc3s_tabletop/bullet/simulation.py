"""The things of a scene in one client: the table, the named bodies, and a hand to move them with."""

import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TypeAlias

from proc3s_tabletop.bullet.client import Client
from proc3s_tabletop.bullet.collision_shapes import create
from proc3s_tabletop.bullet.hand import Hand
from proc3s_tabletop.engine.named_bodies import NamedBodies
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.robot.settings import ReferenceSettings
from proc3s_tabletop.telemetry import TABLE, Vector

GRAVITY = (0.0, 0.0, -9.8)
"""m/s2"""


MakeHand: TypeAlias = Callable[[Client, ReferenceSettings, Path], Hand]


class TableScene(NamedBodies):
    """A table with its top at z = 0, the named bodies, parked until they are put somewhere, and a hand."""

    robot: Hand

    def __init__(self, bodies: Mapping[str, Body], settings: ReferenceSettings, hand: MakeHand) -> None:
        self.settings = settings
        self.client = client = Client()
        client.setTimeStep(settings.tick)
        client.setGravity(*GRAVITY)
        # Contacts are then solved in an order that does not depend on what happened before.
        client.setPhysicsEngineParameter(deterministicOverlappingPairs=1)
        with tempfile.TemporaryDirectory() as folder:
            self.table = self._table()
            self.robot = hand(client, settings, Path(folder))
            self.bodies = {
                name: create(body, client, Path(folder), _parked(k))
                for k, (name, body) in enumerate(bodies.items())
            }
        self.shapes = dict(bodies)
        self.named = {body: name for name, body in self.bodies.items()} | {self.table: TABLE}
        self.held = None

    def _table(self) -> int:
        """A slab wider than the table's bounds: what leaves them is judged, not dropped."""
        client = self.client
        slab = client.createCollisionShape(client.GEOM_BOX, halfExtents=[1.0, 1.0, 0.05])
        table = int(client.createMultiBody(0, slab, -1, [0, -0.5, -0.05]))
        client.changeDynamics(table, -1, lateralFriction=self.settings.table_friction)
        return table

    def close(self) -> None:
        """Release the client."""
        self.client.close()

    def clear(self) -> None:
        """Park every body, and forget all contacts.

        PyBullet keeps contacts of touching bodies from one step to the next; what is put somewhere after
        this behaves the same to the last bit, independent of what was simulated before.
        """
        for name in self.bodies:
            self.park(name)
            self.let_collide(name, True)
        self.detect()
        self.detect()

    def frame(self, name: str) -> Frame:
        """Where an object is."""
        return Frame(*self.client.getBasePositionAndOrientation(self.bodies[name]))

    def near(self, name: str, distance: float) -> list[str]:
        """The other objects that are this close to one, metres."""
        client, body = self.client, self.bodies[name]
        others = ((n, other) for n, other in self.bodies.items() if n != name)
        return [n for n, other in others if client.getClosestPoints(body, other, distance)]

    def touched(self, name: str) -> set[str]:
        """What an object touches after a tick, by name; the table is TABLE."""
        client, body = self.client, self.bodies[name]
        return {
            n for other, n in self.named.items() if other != body and client.getContactPoints(body, other)
        }

    def detect(self) -> None:
        """Find all contacts where everything is now, without letting time pass."""
        self.client.performCollisionDetection()

    def put(self, name: str, frame: Frame) -> None:
        """Move an object, keeping its velocity."""
        self.client.resetBasePositionAndOrientation(self.bodies[name], *frame)

    def park(self, name: str) -> None:
        """Move an object out of everything's way."""
        self.put(name, Frame(_parked(list(self.bodies).index(name)), (0.0, 0.0, 0.0, 1.0)))

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
        force = [self.shapes[name].mass * a for a in acceleration]
        self.client.applyExternalForce(body, -1, force, self.frame(name).position, self.client.WORLD_FRAME)


def _parked(k: int) -> Vector:
    """A place a metre from the next, far from the table."""
    return 9.0 + k, 0.0, 9.0
