"""The things of a scene in one model: the table, the named bodies, and a hand to move them with."""

from collections.abc import Callable, Mapping
from typing import Any

import mujoco
import numpy as np

from proc3s_mujoco import specs
from proc3s_mujoco.bits import MEETS, ROBOT, Kind
from proc3s_mujoco.hand import Hand, State
from proc3s_mujoco.parts import Parts
from proc3s_tabletop.engine.named_bodies import NamedBodies
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.robot.settings import ReferenceSettings
from proc3s_tabletop.telemetry import Vector


class TableScene(NamedBodies):
    """A table with its top at z = 0, the named bodies, parked until they are put somewhere, and a hand.

    `add_hand` puts the hand into the specification, `made` makes it.
    """

    robot: Hand

    def __init__(
        self,
        bodies: Mapping[str, Body],
        settings: ReferenceSettings,
        add_hand: Callable[[Any, ReferenceSettings], None],
        make: Callable[[State, ReferenceSettings], Hand],
    ) -> None:
        self.settings, self.shapes, self.held = settings, dict(bodies), None
        spec = specs.empty(settings)
        add_hand(spec, settings)
        specs.add_things(spec, bodies, settings)
        self.state = State(spec.compile())
        self.parts = Parts(self.state.model, self.shapes)
        self.robot = make(self.state, settings)
        self._pulled = False
        for name in self.shapes:
            self.park(name)

    def close(self) -> None:
        """Release the simulator; nothing is held that would have to be."""

    def clear(self) -> None:
        """Park every body, and forget everything that was simulated."""
        mujoco.mj_resetData(self.state.model, self.state.data)
        self.robot.restore()
        for name in self.shapes:
            self.park(name)
            self.let_collide(name, True)

    def frame(self, name: str) -> Frame:
        """Where an object is."""
        thing = self.parts.things[name]
        x, y, z, qw, qx, qy, qz = self.state.data.qpos[thing.position].tolist()
        return Frame((x, y, z), (qx, qy, qz, qw))

    def put(self, name: str, frame: Frame) -> None:
        """Move an object, keeping its velocity."""
        thing, (x, y, z, w) = self.parts.things[name], frame.rotation
        self.state.data.qpos[thing.position] = *frame.position, w, x, y, z
        self.state.model.body_gravcomp[thing.body] = 0.0
        self.state.moved()

    def park(self, name: str) -> None:
        """Move an object out of everything's way, where it floats."""
        thing = self.parts.things[name]
        self.put(name, Frame(_parked(thing.number), (0.0, 0.0, 0.0, 1.0)))
        self.stop(name)
        self.state.model.body_gravcomp[thing.body] = 1.0

    def stop(self, name: str) -> None:
        """Bring an object to rest."""
        self.state.data.qvel[self.parts.things[name].velocity] = 0.0

    def speeds(self, name: str) -> tuple[float, float]:
        """The largest component of an object's velocity (m/s) and of its turn (rad/s)."""
        velocity = np.abs(self.state.data.qvel[self.parts.things[name].velocity])
        return float(velocity[:3].max()), float(velocity[3:].max())

    def let_collide(self, name: str, on: bool) -> None:
        """Whether an object meets the table and the other objects; it always meets the robot."""
        model, thing = self.state.model, self.parts.things[name]
        kind, meets = (Kind.OBJECT, MEETS[Kind.OBJECT]) if on else (Kind(0), ROBOT)
        model.geom_contype[thing.geoms], model.geom_conaffinity[thing.geoms] = int(kind), int(meets)
        model.body_contype[thing.body], model.body_conaffinity[thing.body] = int(kind), int(meets)

    def set_iterations(self, count: int) -> None:
        """Nothing: MuJoCo's solver goes on until it has converged."""

    def tick(self, count: int = 1) -> None:
        """Let time pass."""
        left = count
        while left:
            self.robot.command()
            ticks = left if self.robot.steady and not self._pulled else 1
            mujoco.mj_step(self.state.model, self.state.data, nstep=ticks * specs.STEPS)
            left -= ticks
            if self._pulled:
                self.state.data.xfrc_applied[:] = 0.0
                self._pulled = False
        self.state.moved()

    def push(self, name: str, acceleration: Vector) -> None:
        """Pull at an object's centre of mass for the next tick, m/s2 beside gravity."""
        force = self.shapes[name].mass * np.array(acceleration)
        self.state.data.xfrc_applied[self.parts.things[name].body, :3] = force
        self._pulled = True

    def detect(self) -> None:
        """Find all contacts where everything is now, without letting time pass."""
        mujoco.mj_collision(self.state.model, self.state.placed())


def _parked(k: int) -> Vector:
    """A place a metre from the next, far from the table."""
    return 9.0 + k, 0.0, 9.0
