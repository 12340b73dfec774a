"""The scene: table, robot and bodies in one client, put into a snapshot so that nothing earlier matters."""

from collections.abc import Mapping

import numpy as np

from proc3s_tabletop.bullet import contacts, forces, rays
from proc3s_tabletop.bullet.arm import Robot
from proc3s_tabletop.bullet.simulation import TableScene
from proc3s_tabletop.engine.forces import Guard, between_pads, hardest
from proc3s_tabletop.engine.settle import settle as settled
from proc3s_tabletop.engine.snapshot import Snapshot
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.frames import Held, rounded
from proc3s_tabletop.robot.settings import HOME, ReferenceSettings

LOOK = 12
"""Ticks between looks at what could sleep."""
ASLEEP = 3e-4
"""What is slower then falls asleep, m/s and rad/s: twice what the solver leaves; what topples is faster."""
AWAKE = 1e-6
"""What is touched by something that is awake is simulated; when the squares of its speeds sum up to more than
this, it stays awake without a touch, too."""


class Scene(TableScene):
    """A table with its top at z = 0, the robot, and the named bodies.

    Time passes without objects at rest until something touches them.
    """

    robot: Robot

    robot_contact = contacts.robot_contact
    held_touches = contacts.held_touches
    hand_clearances = contacts.hand_clearances
    beside = contacts.beside
    company = contacts.company
    grip_force = contacts.grip_force
    on_hand = forces.on_hand
    presses = forces.presses
    between_pads = between_pads
    cover = rays.cover
    settle = settled

    def __init__(self, bodies: Mapping[str, Body], settings: ReferenceSettings) -> None:
        super().__init__(bodies, settings, Robot)
        for link in (-1, *self.robot.links):
            # The base stands on the table.
            on = int(link > self.robot.base)
            self.client.setCollisionFilterPair(self.robot.id, self.table, link, -1, on)
        self.robot.anchor_pads()
        # Only what touches, directly or through others, is solved together.
        self.client.setPhysicsEngineParameter(minimumSolverIslandSize=1)
        self._ticks = 0

    def clear(self) -> None:
        """Park every body, awake, and forget all contacts."""
        super().clear()
        if self._ticks:
            for name in self.bodies:
                self._let_sleep(name, False)
            super().tick()  # What sleeps wakes at the end of a step.
            super().clear()
            self._ticks = 0

    def tick(self, count: int = 1) -> None:
        """Let time pass."""
        for _ in range(count):
            super().tick()
            self._ticks += 1
            if self._ticks % LOOK == 0:
                for name in self.bodies:
                    self._let_sleep(name, self._at_rest(name))

    def _at_rest(self, name: str) -> bool:
        """Whether an object stands, and nothing of the robot touches it."""
        return max(self.speeds(name)) < ASLEEP and not self.client.getContactPoints(
            self.robot.id, self.bodies[name]
        )

    def _let_sleep(self, name: str, on: bool) -> None:
        """Let an object sleep until something touches it, or keep it awake."""
        client = self.client
        state = (
            client.ACTIVATION_STATE_SLEEP | client.ACTIVATION_STATE_ENABLE_SLEEPING
            if on
            else client.ACTIVATION_STATE_WAKE_UP | client.ACTIVATION_STATE_DISABLE_SLEEPING
        )
        client.changeDynamics(self.bodies[name], -1, activationState=state, sleepThreshold=AWAKE)

    def support(self, name: str) -> str | None:
        """What pushes an object up hardest."""
        return hardest(self.presses(name))

    def guard(self, held: str | None) -> Guard:
        """A guard of a descent with an object in hand, or without."""
        return Guard(self, held)

    def load(self, snapshot: Snapshot) -> None:
        """Restore a snapshot, bit for bit the same whatever was simulated before."""
        self.set_iterations(self.settings.iterations)
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
