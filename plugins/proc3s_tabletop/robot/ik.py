"""Kinematics of the UR5e in closed form, for many poses at once, with all eight branches."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from proc3s import FloatArray

# Denavit-Hartenberg lengths of the UR5e in metres, as in the URDF of airo-models.
D1, A2, A3, D4, D5, D6 = 0.1625, -0.425, -0.3922, 0.1333, 0.0997, 0.0996
TWISTS = (math.pi / 2, 0.0, 0.0, math.pi / 2, -math.pi / 2, 0.0)
LENGTHS = (0.0, A2, A3, 0.0, 0.0, 0.0)
OFFSETS = (D1, 0.0, 0.0, D4, D5, D6)

LIMITS = np.array([2.0, 2.0, 1.0, 2.0, 2.0, 2.0]) * math.pi
"""Joints turn between minus and plus these angles, rad (URDF of airo-models)."""

BASE = np.diag([-1.0, -1.0, 1.0, 1.0])
"""The controller's base frame in the frame `base_link`: half a turn about z."""

BRANCHES = np.array([(s, w, e) for s in (1, -1) for w in (1, -1) for e in (1, -1)])
"""The signs that tell the branches apart: shoulder left or right, wrist up or down, elbow up or down."""


def forward(q: FloatArray) -> FloatArray:
    """Poses of tool0 in base_link, shape (..., 4, 4) in metres, of joint angles (..., 6) in radians."""
    pose = np.broadcast_to(BASE, (*q.shape[:-1], 4, 4))
    for joint, parameters in enumerate(zip(TWISTS, LENGTHS, OFFSETS, strict=True)):
        pose = pose @ _link(q[..., joint], *parameters)
    return pose


def _link(angle: FloatArray, twist: float, length: float, offset: float) -> FloatArray:
    """One Denavit-Hartenberg transform for every angle."""
    c, s, ct, st = np.cos(angle), np.sin(angle), round(math.cos(twist), 12), round(math.sin(twist), 12)
    link = np.zeros((*np.shape(angle), 4, 4))
    link[..., 0, 0], link[..., 0, 1], link[..., 0, 2], link[..., 0, 3] = c, -s * ct, s * st, length * c
    link[..., 1, 0], link[..., 1, 1], link[..., 1, 2], link[..., 1, 3] = s, c * ct, -c * st, length * s
    link[..., 2, 1], link[..., 2, 2], link[..., 2, 3], link[..., 3, 3] = st, ct, offset, 1.0
    return link


def inverse(poses: FloatArray) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Joint angles that bring tool0 to poses (n, 4, 4) in base_link, (n, 8, 6), and which of them exist.

    Angles lie in [-pi, pi). A branch keeps its place along a path (`BRANCHES`) that crosses no
    singularity. Where wrist 2 is straight, wrist 3 is set to 0: one solution out of a family.
    """
    tool = (BASE @ np.asarray(poses, float))[:, None]
    with np.errstate(invalid="ignore", divide="ignore"):
        solutions = _branches(tool, *BRANCHES.T)
    return wrap(solutions), np.asarray(np.isfinite(solutions).all(axis=-1))


def _branches(tool: FloatArray, shoulder: FloatArray, wrist: FloatArray, elbow: FloatArray) -> FloatArray:
    """Joint angles (n, 8, 6) for poses (n, 1, 4, 4) in the controller's base frame; NaN if there are none.

    Angles 1, 5, 6 follow from the wrist centre; what is left is a planar arm of two links.
    """
    x6, y6, z6, p6 = (tool[..., :3, column] for column in range(4))
    p5 = p6 - D6 * z6
    reach = np.hypot(p5[..., 0], p5[..., 1])
    q1 = np.arctan2(p5[..., 1], p5[..., 0]) + shoulder * _arccos(D4 / reach) + math.pi / 2
    c1, s1 = np.cos(q1), np.sin(q1)
    q5 = wrist * _arccos((p6[..., 0] * s1 - p6[..., 1] * c1 - D4) / D6)
    c5, s5 = np.cos(q5), np.sin(q5)
    across = np.arctan2((y6[..., 1] * c1 - y6[..., 0] * s1) / s5, (x6[..., 0] * s1 - x6[..., 1] * c1) / s5)
    q6 = np.where(np.abs(s5) < 1e-8, 0.0, across)
    c6, s6 = np.cos(q6)[..., None], np.sin(q6)[..., None]
    x4 = c5[..., None] * (c6 * x6 - s6 * y6) - s5[..., None] * z6
    p4 = p5 + D5 * (s6 * x6 + c6 * y6)
    x, y = p4[..., 0] * c1 + p4[..., 1] * s1, p4[..., 2] - D1
    q3 = elbow * _arccos((x * x + y * y - A2 * A2 - A3 * A3) / (2 * A2 * A3))
    q2 = np.arctan2(y, x) - np.arctan2(A3 * np.sin(q3), A2 + A3 * np.cos(q3))
    q4 = np.arctan2(x4[..., 2], x4[..., 0] * c1 + x4[..., 1] * s1) - q2 - q3
    return np.stack([q1, q2, q3, q4, q5, q6], axis=-1)


def _arccos(cosine: FloatArray) -> FloatArray:
    """The arc cosine, NaN beyond what rounding explains."""
    return np.arccos(np.where(np.abs(cosine) < 1 + 1e-9, np.clip(cosine, -1, 1), np.nan))


def wrap(angles: Any) -> FloatArray:
    """Angles as they are between -pi and pi, radians."""
    wrapped: FloatArray = (np.asarray(angles) + math.pi) % (2 * math.pi) - math.pi
    return wrapped


def nearest_first(solutions: FloatArray, exists: NDArray[np.bool_], q: FloatArray) -> list[int]:
    """The branches of one pose, those that exist, by the sum of the joint angles to travel from `q`."""
    travel = np.where(exists, np.abs(wrap(solutions - q)).sum(axis=-1), np.inf)
    return [int(k) for k in np.argsort(travel, kind="stable") if exists[k]]


def unwound(path: FloatArray, q: FloatArray) -> FloatArray:
    """A path (n, 6) as continuous angles from near `q` on, a turn back where they would leave the limits."""
    turns = np.cumsum(wrap(np.diff(path, axis=0, prepend=q[None])), axis=0) + q
    over = (turns > LIMITS).any(axis=0) * 1.0 - (turns < -LIMITS).any(axis=0) * 1.0
    return turns - 2 * math.pi * over
