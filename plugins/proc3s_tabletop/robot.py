"""The robot in a client: an arm put where it is told, fingers that close by themselves."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.client import Client
from proc3s_tabletop.recipe import HOME, TCP, Recipe
from proc3s_tabletop.telemetry import Quaternion, Vector
from proc3s_tabletop.urdf import GRIPPER_PREFIX, write_urdf

ARM_JOINTS = (
    "shoulder_pan_joint",
    "shoulder_lift_joint",
    "elbow_joint",
    "wrist_1_joint",
    "wrist_2_joint",
    "wrist_3_joint",
)

DRIVER = "finger_joint"
MIMICS = {
    "left_inner_knuckle_joint": 1,
    "left_inner_finger_joint": -1,
    "right_outer_knuckle_joint": 1,
    "right_inner_knuckle_joint": 1,
    "right_inner_finger_joint": -1,
}
"""How the other finger joints follow the driven one (URDF of airo-models; PyBullet ignores mimic tags)."""

ARM_LINKS = {
    "base_link_inertia": "base",
    "shoulder_link": "shoulder",
    "upper_arm_link": "upper arm",
    "forearm_link": "forearm",
    "wrist_1_link": "wrist",
    "wrist_2_link": "wrist",
    "wrist_3_link": "wrist",
}
"""The links of the arm that have a shape, from base to hand, and their names for people."""


class Robot:
    """A UR5e with a Robotiq 2F-85, its base at the origin.

    Where the arm is kinematic, `put_arm` sets it and its motors hold it there while the simulation runs;
    `drive_arm` lets them move it. The fingers are dynamic: one motor drives a linkage of five gears.
    """

    def __init__(self, client: Client, recipe: Recipe, folder: Path, visuals: bool = False) -> None:
        self.client, self._recipe = client, recipe
        write_urdf(folder / "robot.urdf", visuals)
        flags = client.URDF_USE_INERTIA_FROM_FILE | client.URDF_USE_SELF_COLLISION
        self.id: int = client.loadURDF(str(folder / "robot.urdf"), useFixedBase=1, flags=flags)
        self._name_parts()
        self._filter_itself()
        self._gear_up()
        self.put_arm(np.array(HOME))
        self._angles = np.linspace(recipe.finger_closed, 0.0, 17)
        self._gaps = [self._gap_at(angle) for angle in self._angles]

    def _name_parts(self) -> None:
        """Look up joints and links by name."""
        infos = [self.client.getJointInfo(self.id, k) for k in range(self.client.getNumJoints(self.id))]
        joints = {info[1].decode(): int(info[0]) for info in infos}
        links = {info[12].decode(): int(info[0]) for info in infos}
        self.links = frozenset(links.values())
        self.hand = frozenset(k for name, k in links.items() if name.startswith(GRIPPER_PREFIX))
        self.base = links["base_link_inertia"]
        self.sides = [
            [k for name, k in links.items() if name.startswith(GRIPPER_PREFIX + side)]
            for side in ("left", "right")
        ]
        self._parts = {k: ARM_LINKS.get(name, "gripper") for name, k in links.items()}
        self._pads = [links[f"{GRIPPER_PREFIX}{side}_inner_finger_pad"] for side in ("left", "right")]
        self._tool = links["tool0"]
        self._arm = [joints[name] for name in ARM_JOINTS]
        self._driver = joints[DRIVER]
        self._mimics = {joints[name]: factor for name, factor in MIMICS.items()}
        self._chain = [links[name] for name in ARM_LINKS]
        self._forearm = links["forearm_link"]

    def _filter_itself(self) -> None:
        """Let only those links collide that can: two or more apart; the hand cannot reach the wrist."""
        place = {link: k for k, link in enumerate(self._chain)}
        place |= dict.fromkeys(self.hand, place[self._forearm] + 2)
        links = sorted({-1, *self.links})
        for i in links:
            for j in (j for j in links if j > i):
                apart = i in place and j in place and place[j] - place[i] >= 2
                self.client.setCollisionFilterPair(self.id, self.id, i, j, int(apart))

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
                lateralFriction=self._recipe.pad_friction,
                spinningFriction=0.002,
            )

    def part(self, link: int) -> str:
        """What people call a link."""
        return self._parts.get(link, "base")

    def put_arm(self, q: FloatArray) -> None:
        """Set the joint angles (6,) of the arm, at rest."""
        self.client.resetJointStatesMultiDof(self.id, self._arm, [[a] for a in q], [[0.0]] * 6)
        self.q = np.asarray(q, float)

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

    def drive(self, angle: float) -> None:
        """Let the motors hold the arm where it is and turn the fingers towards an angle."""
        # Strong and stiff beyond any real arm: it is to stand still.
        self.drive_arm(self.q, (500.0,) * 6)
        self.drive_fingers(angle)

    def drive_arm(self, q: FloatArray, torques: Sequence[float]) -> None:
        """Let the motors turn the arm towards joint angles (6,) with at most these torques, Nm."""
        self.client.setJointMotorControlArray(
            self.id,
            self._arm,
            self.client.POSITION_CONTROL,
            targetPositions=list(q),
            forces=torques,
            positionGains=[0.3] * 6,
        )

    def read_arm(self) -> tuple[FloatArray, FloatArray]:
        """Angles (6,) in rad and speeds (6,) in rad/s of the arm's joints."""
        states = self.client.getJointStates(self.id, self._arm)
        return np.array([state[0] for state in states]), np.array([state[1] for state in states])

    def drive_fingers(self, angle: float) -> None:
        """Let the motor of the fingers turn them towards an angle."""
        client, recipe = self.client, self._recipe
        client.setJointMotorControl2(
            self.id,
            self._driver,
            client.POSITION_CONTROL,
            targetPosition=angle,
            force=recipe.finger_torque,
            positionGain=0.15,
            maxVelocity=recipe.finger_speed * recipe.speed,
        )

    def read_fingers(self) -> tuple[float, float]:
        """Angle (rad) and speed (rad/s) of the finger joint."""
        angle, speed, *_ = self.client.getJointState(self.id, self._driver)
        return float(angle), float(speed)

    def tool(self) -> tuple[Vector, Quaternion]:
        """The pose of tool0."""
        position, rotation = self.client.getLinkState(self.id, self._tool, computeForwardKinematics=1)[4:6]
        return position, rotation

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
