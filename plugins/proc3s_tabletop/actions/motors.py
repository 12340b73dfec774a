"""The arm moved by its motors while time passes, as on a real table."""

import math
from collections.abc import Callable

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.actions.motion import Line
from proc3s_tabletop.engine.protocol import Simulation

FLAT, ROUND = 100, 200
"""Iterations of the solver, for scenes of boxes and bowls, and for others: what is round touches the pads at
few points. With half as many, blocks stand half a millimetre off between the pads, and a strawberry slips
out of them (measured)."""

TORQUES = (150.0, 150.0, 150.0, 28.0, 28.0, 28.0)
"""Of the joints, Nm (UR5e, URDF of airo-models)."""

LINE_SPEED = 0.4
"""Of the hand half-way up or down a line, m/s."""
GUARDED_SPEED = 0.2
"""The same where the hand is to stop at the first contact, m/s."""

LOOK = 4
"""Ticks between looks at whether the arm stands."""

FINGERS_MOST = 96
"""Ticks that the fingers are given to come to rest."""
FINGERS_LEAST = 12
"""Ticks until the fingers have started."""
NEAR = 1e-4
"""A way-point less than this above the hand is where the hand is, m."""
STALL = 12
"""The fingers have arrived when they stand still for so many ticks."""


class Motors:
    """Moves the arm of a scene along joint angles with a smooth start and end, in real time."""

    def __init__(self, scene: Simulation) -> None:
        self._scene = scene
        self._robot = scene.robot
        self._settings = scene.settings

    def to(self, q: FloatArray) -> None:
        """Go straight in joint space to angles (6,) and wait until the arm stands."""
        path = np.array([self._robot.q, q])
        self._follow(path, np.array([0.0, 1.0]), np.abs(path[1] - path[0]).max() / self._settings.arm_speed)
        self._wait()

    def down(self, line: Line, guard: Callable[[], bool] | None = None) -> bool:
        """Go down a line; True where a guard, asked every tick, stopped the arm on the way."""
        way = line.heights[0] - line.heights
        stopped = self._follow(line.q, way, way[-1] / (GUARDED_SPEED if guard else LINE_SPEED), guard)
        self._wait()
        return stopped

    def up(self, line: Line) -> None:
        """Go up a line from where the arm is."""
        here = self.height()
        above = np.flatnonzero(line.heights > here + NEAR)[::-1]
        path = np.vstack([self._robot.q, line.q[above]])
        way = np.append(0.0, line.heights[above] - here)
        self._follow(path, way, way[-1] / LINE_SPEED)
        self._wait()

    def height(self) -> float:
        """Where the grasp point is, metres."""
        return float(self._robot.grasp_point()[0][2])

    def fingers(self, angle: float) -> None:
        """Drive the fingers towards an angle and wait until they stand."""
        self._robot.drive_fingers(angle)
        self._robot.angle = angle
        still = 0
        for tick in range(FINGERS_MOST):
            self._scene.tick()
            slow = abs(self._robot.read_fingers()[1]) < self._settings.stall_speed
            still = still + 1 if slow and tick > FINGERS_LEAST else 0
            if still >= STALL:
                break

    def _follow(
        self, path: FloatArray, way: FloatArray, seconds: float, guard: Callable[[], bool] | None = None
    ) -> bool:
        """Command angles (n, 6) met at `way` (n,), in 1.5 times the seconds at top speed; True if guarded."""
        ticks = max(1, math.ceil(1.5 * seconds / (self._settings.tick * self._settings.speed)))
        share = np.arange(1, ticks + 1) / ticks
        smooth = way[-1] * share**2 * (3 - 2 * share)
        for target in np.stack([np.interp(smooth, way, joint) for joint in path.T], axis=1):
            self._robot.drive_arm(target, TORQUES)
            self._scene.tick()
            if guard and guard():
                self._robot.drive_arm(self._robot.read_arm()[0], TORQUES)
                return True
        return False

    def _wait(self) -> None:
        """Let time pass until the arm stands, and note where."""
        for _ in range(0, self._settings.arm_still_most, LOOK):
            self._scene.tick(LOOK)
            if np.abs(self._robot.read_arm()[1]).max() < self._settings.arm_still:
                break
        self._robot.q = self._robot.read_arm()[0]
