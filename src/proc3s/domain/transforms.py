"""Rigid transforms as six numbers x, y, z (m), roll, pitch, yaw (rad, about the fixed axes x, y, z)."""

import numpy as np

from proc3s.domain.values import FloatArray


# No scipy here: the core does without it, and its rotations differ in the last bit.
def matrices(poses: FloatArray) -> FloatArray:
    """The matrices (..., 4, 4) of poses (..., 6)."""
    (cr, cp, cy), (sr, sp, sy) = (f(np.moveaxis(poses[..., 3:], -1, 0)) for f in (np.cos, np.sin))
    made = np.zeros((*poses.shape[:-1], 4, 4))
    made[..., 0, :3] = np.stack([cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr], axis=-1)
    made[..., 1, :3] = np.stack([sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr], axis=-1)
    made[..., 2, :3] = np.stack([-sp, cp * sr, cp * cr], axis=-1)
    made[..., :3, 3] = poses[..., :3]
    made[..., 3, 3] = 1.0
    return made


def numbers(transforms: FloatArray) -> FloatArray:
    """The six numbers (..., 6) of matrices (..., 4, 4); at a pitch of a right angle roll is 0."""
    turn = transforms[..., :3, :3]
    level = np.hypot(turn[..., 2, 1], turn[..., 2, 2])
    steep = level < 1e-9
    roll = np.where(steep, 0.0, np.arctan2(turn[..., 2, 1], turn[..., 2, 2]))
    pitch = np.arctan2(-turn[..., 2, 0], level)
    yaw = np.where(
        steep,
        np.arctan2(-turn[..., 0, 1], turn[..., 1, 1]),
        np.arctan2(turn[..., 1, 0], turn[..., 0, 0]),
    )
    return np.concatenate([transforms[..., :3, 3], np.stack([roll, pitch, yaw], axis=-1)], axis=-1)


def compose(first: FloatArray, second: FloatArray) -> FloatArray:
    """The poses (..., 6) that `second` is in the world when it is given in the frame `first`."""
    return numbers(matrices(first) @ matrices(second))
