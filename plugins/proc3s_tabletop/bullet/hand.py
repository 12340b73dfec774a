"""The two-fingered hand in a client: on an arm, or floating where it is put."""

from abc import ABC, abstractmethod
from pathlib import Path

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.bullet.client import Client
from proc3s_tabletop.robot.settings import TCP, ReferenceSettings
from proc3s_tabletop.robot.urdf import GRIPPER_PREFIX, write_hand
from proc3s_tabletop.telemetry import Quaternion, Vector

DRIVER = "finger_joint"
MIMICS = {
    "left_inner_knuckle_joint": 1,
    "left_inner_finger_joint": -1,
    "right_outer_knuckle_joint": 1,
    "right_inner_knuckle_joint": 1,
    "right_inner_finger_joint": -1,
}
"""How the other finger joints follow the driven one (URDF of airo-models; PyBullet ignores mimic tags)."""


class Hand(ABC):
    """A Robotiq 2F-85 whose fingers are dynamic: one motor drives a linkage of five gears.

    `id` is a body that has the hand's links; a subclass says where `tool` is.
    """

    base = -2
    """Links after this one are compared with what is near."""

    def __init__(self, client: Client, settings: ReferenceSettings, body: int) -> None:
        self.client, self.settings, self.id = client, settings, body
        self._name_parts()
        self._gear_up()
        self._angles = np.linspace(settings.finger_closed, 0.0, 17)
        self._gaps = [self._gap_at(angle) for angle in self._angles]

    def _name_parts(self) -> None:
        """Look up joints and links by name."""
        infos = [self.client.getJointInfo(self.id, k) for k in range(self.client.getNumJoints(self.id))]
        self._joints = {info[1].decode(): int(info[0]) for info in infos}
        self._links = {info[12].decode(): int(info[0]) for info in infos}
        self.links = frozenset(self._links.values())
        self.hand_links = frozenset(k for name, k in self._links.items() if name.startswith(GRIPPER_PREFIX))
        self.sides = [
            [k for name, k in self._links.items() if name.startswith(GRIPPER_PREFIX + side)]
            for side in ("left", "right")
        ]
        self._pads = [self._links[f"{GRIPPER_PREFIX}{side}_inner_finger_pad"] for side in ("left", "right")]
        self._driver = self._joints[DRIVER]
        self._mimics = {self._joints[name]: factor for name, factor in MIMICS.items()}

    def _gear_up(self) -> None:
        """Couple the finger joints and give the pads their friction."""
        client = self.client
        for joint, factor in self._mimics.items():
            client.setJointMotorControl2(self.id, joint, client.VELOCITY_CONTROL, targetVelocity=0, force=0)
            gear = client.createConstraint(
                self.id, self._driver, self.id, joint, client.JOINT_GEAR, [1, 0, 0], [0, 0, 0], [0, 0, 0]
            )
            # Stiff enough for the linkage to behave as one (measured).
            client.changeConstraint(gear, gearRatio=-factor, maxForce=1e4, erp=0.5)
        for pad in self._pads:
            # The torsional friction stands for the pads' area: a point contact has none. Rolling friction
            # would cost a quarter of the time of a grasp and changes nothing.
            client.changeDynamics(
                self.id,
                pad,
                lateralFriction=self.settings.pad_friction,
                spinningFriction=0.002,
            )

    def anchor_pads(self) -> None:
        """Let friction pull what the pads hold back to where they took it, so that nothing creeps."""
        for pad in self._pads:
            self.client.changeDynamics(self.id, pad, frictionAnchor=1)

    def part(self, link: int) -> str:
        """What people call a link."""
        return "gripper"

    @abstractmethod
    def tool(self) -> tuple[Vector, Quaternion]:
        """The pose of tool0."""

    def put_fingers(self, angle: float) -> None:
        """Set the finger joint, and what follows it, at rest; 0 is wide open."""
        self.client.resetJointState(self.id, self._driver, angle, 0)
        for joint, factor in self._mimics.items():
            self.client.resetJointState(self.id, joint, angle * factor, 0)
        self.angle = angle

    def put_linkage(self, angles: tuple[float, ...]) -> None:
        """Set every finger joint by itself, at rest; under load the linkage gives a little."""
        for joint, angle in zip((self._driver, *self._mimics), angles, strict=True):
            self.client.resetJointState(self.id, joint, angle, 0)

    def linkage(self) -> tuple[float, ...]:
        """The angle of every finger joint."""
        joints = (self._driver, *self._mimics)
        return tuple(float(state[0]) for state in self.client.getJointStates(self.id, joints))

    def drive_fingers(self, angle: float) -> None:
        """Let the motor of the fingers turn them towards an angle."""
        client, settings = self.client, self.settings
        client.setJointMotorControl2(
            self.id,
            self._driver,
            client.POSITION_CONTROL,
            targetPosition=angle,
            force=settings.finger_torque,
            positionGain=0.15,
            maxVelocity=settings.finger_speed * settings.speed,
        )

    def read_fingers(self) -> tuple[float, float]:
        """Angle (rad) and speed (rad/s) of the finger joint."""
        angle, speed, *_ = self.client.getJointState(self.id, self._driver)
        return float(angle), float(speed)

    def held_angle(self) -> float:
        """The angle that the fingers are to be put to so that they are where they are now, under load."""
        return self.read_fingers()[0]

    def pads(self) -> tuple[FloatArray, FloatArray]:
        """The middles of the left and the right pad."""
        left, right = (np.array(self.client.getLinkState(self.id, pad)[4]) for pad in self._pads)
        return left, right

    def grasp_point(self) -> tuple[FloatArray, FloatArray]:
        """The point between the fingertips where objects are grasped, and the direction the fingers point."""
        position, rotation = self.tool()
        along = np.array(self.client.getMatrixFromQuaternion(rotation)).reshape(3, 3)[:, 2]
        return np.array(position) + TCP * along, along

    def gap(self) -> float:
        """Distance of the pads, metres."""
        points = self.client.getClosestPoints(self.id, self.id, 0.2, *self._pads)
        return min((float(point[8]) for point in points), default=0.0)

    def angle_for(self, gap: float) -> float:
        """The finger angle at which the pads are this far apart."""
        return float(np.interp(gap, self._gaps, self._angles))

    def _gap_at(self, angle: float) -> float:
        self.put_fingers(angle)
        return self.gap()


class FloatingHand(Hand):
    """The hand alone, without an arm, fixed in the air where it is put."""

    def __init__(self, client: Client, settings: ReferenceSettings, folder: Path) -> None:
        write_hand(folder / "hand.urdf")
        flags = client.URDF_USE_INERTIA_FROM_FILE
        body = client.loadURDF(str(folder / "hand.urdf"), useFixedBase=1, flags=flags)
        super().__init__(client, settings, body)
        self.hand_links |= {-1}
        self._inertial = self.client.getDynamicsInfo(self.id, -1)[3:5]

    def put(self, position: Vector, rotation: Quaternion) -> None:
        """Put tool0 at a pose."""
        self._tool = position, rotation
        frame = self.client.multiplyTransforms(position, rotation, *self._inertial)
        self.client.resetBasePositionAndOrientation(self.id, *frame)

    def tool(self) -> tuple[Vector, Quaternion]:
        """The pose of tool0."""
        return self._tool
