"""The robot in a client: an arm put where it is told, fingers that close by themselves."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.bullet.client import Client
from proc3s_tabletop.bullet.hand import Hand
from proc3s_tabletop.robot.settings import HOME, ReferenceSettings
from proc3s_tabletop.robot.urdf import write_robot
from proc3s_tabletop.telemetry import Quaternion, Vector

ARM_JOINTS = (
    "shoulder_pan_joint",
    "shoulder_lift_joint",
    "elbow_joint",
    "wrist_1_joint",
    "wrist_2_joint",
    "wrist_3_joint",
)

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


class Robot(Hand):
    """A UR5e with a Robotiq 2F-85, its base at the origin.

    Where the arm is kinematic, `put_arm` sets it and its motors hold it there while the simulation runs;
    `drive_arm` lets them move it.
    """

    def __init__(
        self, client: Client, settings: ReferenceSettings, folder: Path, visuals: bool = False
    ) -> None:
        write_robot(folder / "robot.urdf", visuals)
        flags = client.URDF_USE_INERTIA_FROM_FILE | client.URDF_USE_SELF_COLLISION
        super().__init__(
            client, settings, client.loadURDF(str(folder / "robot.urdf"), useFixedBase=1, flags=flags)
        )
        self.base = self._links["base_link_inertia"]
        self._parts = {k: ARM_LINKS.get(name, "gripper") for name, k in self._links.items()}
        self._arm = [self._joints[name] for name in ARM_JOINTS]
        self._filter_itself()
        self.put_arm(np.array(HOME))

    def _filter_itself(self) -> None:
        """Let only those links collide that can: two or more apart; the hand cannot reach the wrist."""
        place = {self._links[name]: k for k, name in enumerate(ARM_LINKS)}
        place |= dict.fromkeys(self.hand_links, place[self._links["forearm_link"]] + 2)
        links = sorted({-1, *self.links})
        for i in links:
            for j in (j for j in links if j > i):
                apart = i in place and j in place and place[j] - place[i] >= 2
                self.client.setCollisionFilterPair(self.id, self.id, i, j, int(apart))

    def part(self, link: int) -> str:
        """What people call a link."""
        return self._parts.get(link, "base")

    def put_arm(self, q: FloatArray) -> None:
        """Set the joint angles (6,) of the arm, at rest."""
        self.client.resetJointStatesMultiDof(self.id, self._arm, [[a] for a in q], [[0.0]] * 6)
        self.q = np.asarray(q, float)

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

    def tool(self) -> tuple[Vector, Quaternion]:
        """The pose of tool0."""
        position, rotation = self.client.getLinkState(
            self.id, self._links["tool0"], computeForwardKinematics=1
        )[4:6]
        return position, rotation
