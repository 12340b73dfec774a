"""The fingers as a closed linkage: which joint angles belong together, measured once on a hand in the air."""

import functools
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from proc3s import FloatArray
from proc3s_mujoco import specs
from proc3s_tabletop.robot.settings import ReferenceSettings

DRIVERS = (f"{specs.HAND}right_driver_joint", f"{specs.HAND}left_driver_joint")
JOINTS = tuple(
    f"{specs.HAND}{side}_{part}_joint"
    for side in ("right", "left")
    for part in ("driver", "coupler", "spring_link", "follower")
)
"""The joints of the fingers; those that are driven come first on each side."""
PADS = (f"{specs.HAND}left_pad1", f"{specs.HAND}right_pad1")
"""The boxes at the fingertips."""
THICK = 0.004
"""Half the thickness of a pad, m."""
MOTOR = f"{specs.HAND}fingers_actuator"
FULL = 255.0 / 0.8
"""What the motor is told for a rad of the drivers."""

POSES, STEPS = 41, 240
"""How many angles are measured, and the steps in which the fingers come to rest at each."""


@dataclass(frozen=True)
class Linkage:
    """Angles (n,) of the drivers, rad, those (n, 8) of all joints, and distances (n,) of the pads, m."""

    angles: FloatArray
    joints: FloatArray
    gaps: FloatArray

    def at(self, angle: float) -> FloatArray:
        """The angles (8,) of all joints where the drivers have this angle."""
        return np.array([np.interp(angle, self.angles, joint) for joint in self.joints.T])

    def angle_for(self, gap: float) -> float:
        """The angle of the drivers at which the pads are this far apart."""
        return float(np.interp(gap, self.gaps[::-1], self.angles[::-1]))


@functools.cache
def linkage() -> Linkage:
    """How the fingers move where nothing is between them."""
    settings = ReferenceSettings()
    spec = specs.empty(settings)
    specs.add_floating_hand(spec, settings)
    model = spec.compile()
    data = mujoco.MjData(model)
    found = [_at_rest(model, data, angle) for angle in np.linspace(0.0, 0.8, POSES)]
    joints, gaps = np.array([joints for joints, _ in found]), np.array([gap for _, gap in found])
    return Linkage(joints[:, 0], joints, gaps)


def _at_rest(model: Any, data: Any, angle: float) -> tuple[FloatArray, float]:
    """All joint angles and the distance of the pads once the fingers have come to rest."""
    data.ctrl[0] = FULL * angle
    mujoco.mj_step(model, data, nstep=STEPS)
    mujoco.mj_kinematics(model, data)
    left, right = (data.geom(name).xpos for name in PADS)
    joints = np.array([data.joint(name).qpos[0] for name in JOINTS])
    return joints, float(np.linalg.norm(left - right)) - 2 * THICK
