"""The two-fingered hand in a simulation: on an arm, or floating where it is put."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np

from proc3s import FloatArray
from proc3s_mujoco.linkage import DRIVERS, FULL, JOINTS, MOTOR, PADS, THICK, linkage
from proc3s_mujoco.specs import TOOL
from proc3s_tabletop.robot.settings import TCP, ReferenceSettings
from proc3s_tabletop.telemetry import Quaternion, Vector


class State:
    """A model with its data, and whether positions of bodies are those of the joint angles."""

    def __init__(self, model: Any) -> None:
        self.model, self.data = model, mujoco.MjData(model)
        self._moved = True

    def moved(self) -> None:
        """Note that joint angles have changed."""
        self._moved = True

    def placed(self) -> Any:
        """The data, every body where its joint angles put it."""
        if self._moved:
            mujoco.mj_kinematics(self.model, self.data)
            self._moved = False
        return self.data


class Hand(ABC):
    """A Robotiq 2F-85 whose fingers are dynamic: one motor pulls at a linkage that is held by constraints."""

    def __init__(self, state: State, settings: ReferenceSettings) -> None:
        self.state, self.settings = state, settings
        model = state.model
        self._joints = [int(model.joint(name).qposadr[0]) for name in JOINTS]
        self._speeds = [int(model.joint(name).dofadr[0]) for name in JOINTS]
        self._drivers = [JOINTS.index(name) for name in DRIVERS]
        self._motor = int(model.actuator(MOTOR).id)
        self._pads = [int(model.geom(name).id) for name in PADS]
        self._tool = int(model.body(TOOL).id)
        self.angle = 0.0
        self._target = self._command = 0.0

    def tool(self) -> tuple[Vector, Quaternion]:
        """The pose of tool0."""
        data = self.state.placed()
        x, y, z = data.xpos[self._tool].tolist()
        qw, qx, qy, qz = data.xquat[self._tool].tolist()
        return (x, y, z), (qx, qy, qz, qw)

    def put_fingers(self, angle: float) -> None:
        """Set the fingers, at rest; 0 is wide open."""
        self._set_joints(linkage().at(angle))
        self.angle = angle

    def put_linkage(self, angles: tuple[float, ...]) -> None:
        """Set every finger joint by itself, at rest; under load the linkage gives a little."""
        self._set_joints(np.array(angles))

    def _set_joints(self, angles: FloatArray) -> None:
        data = self.state.data
        data.qpos[self._joints], data.qvel[self._speeds] = angles, 0.0
        self.state.moved()

    def linkage(self) -> tuple[float, ...]:
        """The angle of every finger joint."""
        return tuple(self.state.data.qpos[self._joints].tolist())

    def drive_fingers(self, angle: float) -> None:
        """Let the motor of the fingers turn them towards an angle, from where they are."""
        self._target, self._command = angle, self.read_fingers()[0]

    def hold_fingers(self, angle: float) -> None:
        """Let the motor of the fingers turn them towards an angle at once."""
        self._target = self._command = angle

    def command(self) -> None:
        """Tell the motors what to do in the next tick."""
        settings = self.settings
        step = settings.finger_speed * settings.speed * settings.tick
        self._command += max(-step, min(step, self._target - self._command))
        self.state.data.ctrl[self._motor] = FULL * self._command

    @property
    def steady(self) -> bool:
        """Whether the motors are told the same in every tick from now on."""
        return self._command == self._target

    def read_fingers(self) -> tuple[float, float]:
        """Angle (rad) and speed (rad/s) of the finger joint."""
        data = self.state.data
        angles = [float(data.qpos[self._joints[k]]) for k in self._drivers]
        speeds = [float(data.qvel[self._speeds[k]]) for k in self._drivers]
        return sum(angles) / len(angles), sum(speeds) / len(speeds)

    def held_angle(self) -> float:
        """The angle that the fingers are to be put to so that they are where they are now, under load."""
        return self.angle_for(self.gap())

    def pads(self) -> tuple[FloatArray, FloatArray]:
        """The middles of the faces of the left and of the right pad."""
        left, right = self.state.placed().geom_xpos[self._pads]
        inwards = (right - left) / np.linalg.norm(right - left) * THICK
        return left + inwards, right - inwards

    def grasp_point(self) -> tuple[FloatArray, FloatArray]:
        """The point between the fingertips where objects are grasped, and the direction the fingers point."""
        data = self.state.placed()
        along = data.xmat[self._tool].reshape(3, 3)[:, 2].copy()
        return data.xpos[self._tool] + TCP * along, along

    def gap(self) -> float:
        """Distance of the pads, metres."""
        left, right = self.state.placed().geom_xpos[self._pads]
        return max(0.0, float(np.linalg.norm(left - right)) - 2 * THICK)

    def angle_for(self, gap: float) -> float:
        """The finger angle at which the pads are this far apart."""
        return linkage().angle_for(gap)

    @abstractmethod
    def restore(self) -> None:
        """Set what was set, after the data was reset."""


MakeHand = Callable[[State, ReferenceSettings], Hand]


class FloatingHand(Hand):
    """The hand alone, without an arm, fixed in the air where it is put."""

    def put(self, position: Vector, rotation: Quaternion) -> None:
        """Put tool0 at a pose."""
        x, y, z, w = rotation
        self._pose = position, rotation
        self.state.data.mocap_pos[0] = position
        self.state.data.mocap_quat[0] = w, x, y, z
        self.state.moved()

    def restore(self) -> None:
        """Set what was set, after the data was reset."""
        self.put(*self._pose)
        self.put_fingers(self.angle)
        self.hold_fingers(self._target)
