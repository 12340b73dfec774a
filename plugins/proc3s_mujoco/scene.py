"""The scene: table, robot and bodies in one model, put into a snapshot so that nothing earlier matters."""

from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np

from proc3s_mujoco import closest, contacts, forces, rays, specs
from proc3s_mujoco.arm import Robot
from proc3s_mujoco.simulation import TableScene
from proc3s_tabletop.engine.forces import Guard, between_pads, hardest
from proc3s_tabletop.engine.settle import settle as settled
from proc3s_tabletop.engine.snapshot import Snapshot
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.frames import Held, rounded
from proc3s_tabletop.robot.settings import ReferenceSettings

SLEEP = int(mujoco.mjtEnableBit.mjENBL_SLEEP)
ASLEEP = 1e-4
"""What is slower than this for some steps falls asleep, m/s; what begins to topple is faster (measured)."""


class Scene(TableScene):
    """A table with its top at z = 0, the robot, and the named bodies."""

    robot: Robot

    robot_contact = contacts.robot_contact
    grip_force = contacts.grip_force
    touched = contacts.touched
    held_touches = contacts.held_touches
    cover = rays.cover
    near = closest.near
    hand_clearances = closest.hand_clearances
    beside = closest.beside
    company = closest.company
    on_hand = forces.on_hand
    presses = forces.presses
    between_pads = between_pads
    settle = settled

    def __init__(self, bodies: Mapping[str, Body], settings: ReferenceSettings) -> None:
        super().__init__(bodies, settings, _add_robot, Robot)

    def support(self, name: str) -> str | None:
        """What pushes an object up hardest."""
        # Contacts of what sleeps are not looked for.
        option = self.state.model.opt
        option.enableflags &= ~SLEEP
        mujoco.mj_forward(self.state.model, self.state.data)
        option.enableflags |= SLEEP
        return hardest(self.presses(name))

    def guard(self, held: str | None) -> Guard:
        """A guard of a descent with an object in hand, or without."""
        return Guard(self, held)

    def load(self, snapshot: Snapshot) -> None:
        """Restore a snapshot, bit for bit the same whatever was simulated before."""
        mujoco.mj_resetData(self.state.model, self.state.data)
        self.robot.put_arm(np.array(snapshot.q))
        self.robot.put_fingers(snapshot.angle)
        if snapshot.linkage:
            self.robot.put_linkage(snapshot.linkage)
        self.robot.hold_fingers(snapshot.angle)
        self.held = snapshot.held
        for name in self.shapes:
            self.let_collide(name, True)
        self.bring_back(dict(snapshot.frames))

    def save(self) -> Snapshot:
        """The scene as it stands, at rest."""
        frames = tuple((name, rounded(self.frame(name), 7)) for name in self.shapes)
        held = self.held and Held(self.held.name, rounded(self.held.frame, 9))
        q = tuple(round(float(angle), 10) for angle in self.robot.q)
        return Snapshot(frames, q, round(self.robot.angle, 9), held)


def _add_robot(spec: Any, settings: ReferenceSettings) -> None:
    """The robot, on a table where time passes without objects at rest until something touches them.

    The robot itself never sleeps, as nothing does that has motors.
    """
    specs.add_robot(spec, settings)
    spec.option.enableflags |= SLEEP
    spec.option.sleep_tolerance = ASLEEP
