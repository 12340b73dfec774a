"""Converts poses of states (roll, pitch, yaw) to frames of the simulator (quaternions), and back."""

import math
from typing import Any, NamedTuple

from proc3s_tabletop.telemetry import Quaternion, Vector


class Frame(NamedTuple):
    """A pose as engines have it: metres, and a quaternion x, y, z, w."""

    position: Vector
    rotation: Quaternion


def frame(pose: Any) -> Frame:
    """The frame of a pose x, y, z (metres), roll, pitch, yaw (radians about the fixed axes x, y, z)."""
    (cr, sr), (cp, sp), (cy, sy) = (
        (math.cos(angle / 2), math.sin(angle / 2)) for angle in (pose.roll, pose.pitch, pose.yaw)
    )
    rotation = (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )
    return Frame((float(pose.x), float(pose.y), float(pose.z)), rotation)


def numbers(frame: Frame) -> dict[str, float]:
    """The six numbers of a pose by name; at pitch of a right angle, roll and yaw share one turn."""
    x, y, z, w = frame.rotation
    sine = 2 * (w * y - z * x)
    return {
        **dict(zip("xyz", frame.position, strict=True)),
        "roll": math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
        "pitch": math.asin(max(-1.0, min(1.0, sine))),
        "yaw": math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
    }


class Held(NamedTuple):
    """What the hand holds, and where in the frame of tool0."""

    name: str
    frame: Frame


def rounded(frame: Frame, digits: int, of_turn: int = 9) -> Frame:
    """Numbers that survive being set and read again: so many digits of a position, and of a rotation."""
    x, y, z = (round(float(v), digits) for v in frame.position)
    qx, qy, qz, qw = (round(float(v), of_turn) for v in frame.rotation)
    return Frame((x, y, z), (qx, qy, qz, qw))


def compose(outer: Frame, inner: Frame) -> Frame:
    """A frame that is given in another one, in the frame that the other is given in."""
    x, y, z = _turned(outer.rotation, inner.position)
    px, py, pz = outer.position
    ax, ay, az, aw = outer.rotation
    bx, by, bz, bw = inner.rotation
    rotation = (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )
    return Frame((px + x, py + y, pz + z), rotation)


def inverse(frame: Frame) -> Frame:
    """The frame that undoes another one."""
    x, y, z, w = frame.rotation
    back = (-x, -y, -z, w)
    px, py, pz = _turned(back, frame.position)
    return Frame((-px, -py, -pz), back)


def _turned(rotation: Quaternion, vector: Vector) -> Vector:
    """A vector after a rotation."""
    (x, y, z, w), (vx, vy, vz) = rotation, vector
    tx, ty, tz = 2 * (y * vz - z * vy), 2 * (z * vx - x * vz), 2 * (x * vy - y * vx)
    return (
        vx + w * tx + y * tz - z * ty,
        vy + w * ty + z * tx - x * tz,
        vz + w * tz + x * ty - y * tx,
    )
