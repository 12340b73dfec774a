"""The robot in a simulation: an arm put where it is told or driven by its motors, and its hand."""

from collections.abc import Sequence

import numpy as np

from proc3s import FloatArray
from proc3s_mujoco.hand import Hand, State
from proc3s_mujoco.specs import ARM
from proc3s_tabletop.robot.settings import HOME, ReferenceSettings

JOINTS = ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")

LAG = 0.2
"""The motors damp as if the joints were to be where they are to be this much later, s: gains of the model."""


class Robot(Hand):
    """A UR5e with a Robotiq 2F-85, its base at the origin.

    Its motors are told where to be and, on the way, how fast to be there, as those of a real arm.
    """

    def __init__(self, state: State, settings: ReferenceSettings) -> None:
        super().__init__(state, settings)
        model = state.model
        joints = [model.joint(f"{ARM}{name}_joint") for name in JOINTS]
        self._arm = _run([int(joint.qposadr[0]) for joint in joints])
        self._arm_speeds = _run([int(joint.dofadr[0]) for joint in joints])
        self._arm_motors = _run([int(model.actuator(ARM + name).id) for name in JOINTS])
        self._torques: Sequence[float] = ()
        self.put_arm(np.array(HOME))

    def put_arm(self, q: FloatArray) -> None:
        """Set the joint angles (6,) of the arm, at rest, and let its motors hold it there."""
        data = self.state.data
        data.qpos[self._arm], data.qvel[self._arm_speeds] = q, 0.0
        self.state.moved()
        self.q = self._goal = self._before = np.asarray(q, float)

    def drive_arm(self, q: FloatArray, torques: Sequence[float]) -> None:
        """Let the motors turn the arm towards joint angles (6,) with at most these torques, Nm."""
        if torques != self._torques:
            self.state.model.actuator_forcerange[self._arm_motors] = np.outer(torques, [-1.0, 1.0])
            self._torques = torques
        self._goal = np.asarray(q, float)

    def read_arm(self) -> tuple[FloatArray, FloatArray]:
        """Angles (6,) in rad and speeds (6,) in rad/s of the arm's joints."""
        data = self.state.data
        return data.qpos[self._arm].copy(), data.qvel[self._arm_speeds].copy()

    def command(self) -> None:
        """Tell the motors what to do in the next tick."""
        super().command()
        speed = (self._goal - self._before) / self.settings.tick
        self.state.data.ctrl[self._arm_motors] = self._goal + LAG * speed
        self._before = self._goal

    @property
    def steady(self) -> bool:
        """Whether the motors are told the same in every tick from now on."""
        return super().steady and self._goal is self._before

    def restore(self) -> None:
        """Set what was set, after the data was reset."""
        self.put_arm(self.q)
        self.put_fingers(self.angle)
        self.hold_fingers(self._target)


def _run(indices: list[int]) -> slice:
    """Indices that follow one another, as a slice, which is fast. Raises ValueError for others."""
    first = indices[0]
    if indices != [*range(first, first + len(indices))]:
        raise ValueError(f"the joints of the arm are not in a row: {indices}")
    return slice(first, first + len(indices))
