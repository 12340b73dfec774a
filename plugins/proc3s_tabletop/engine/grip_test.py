"""Grips: closing the fingers and the lift test, with things that lie between them."""

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from proc3s_tabletop.engine.protocol import GripScene
from proc3s_tabletop.engine.values import Grip
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.telemetry import TABLE, Stage, Telemetry, displacement


@dataclass(frozen=True)
class GripSetup:
    """What a grip depends on: speed, the pose of tool0 and what lies there, the target first.

    Everything is moved and turned about the vertical so that tool0 is at x = y = 0 and closes along x, and
    rounded, so that grips that are the same but for the place are the same.
    """

    speed: float
    tool: Frame
    lies: tuple[tuple[Body, Frame], ...]


def upright(tool: Frame) -> Frame:
    """What brings tool0 to x = y = 0 and its closing direction level with x, kept upright: a transform."""
    (px, py, _), (x, y, z, w) = tool
    turn = -math.atan2(2 * (x * y + w * z), 1 - 2 * (y * y + z * z))
    c, s = math.cos(turn), math.sin(turn)
    return Frame((s * py - c * px, -s * px - c * py, 0.0), (0.0, 0.0, math.sin(turn / 2), math.cos(turn / 2)))


def try_grip(scene: GripScene, names: list[str]) -> Grip:
    """Close the fingers on the first of the things named and shake it; the others lie around it."""
    telemetry = close(scene, names[0])
    if not telemetry.ended:
        telemetry = shake(scene, names[0], telemetry)
    others = tuple(scene.frame(name) for name in names[1:])
    angle = scene.hand.held_angle()
    return Grip(_by_place(telemetry, names), angle, scene.in_tool(names[0]), others)


def close(scene: GripScene, name: str) -> Telemetry:
    """Close the fingers until they stand still; both must press the object and nothing else be touched."""
    settings, robot = scene.settings, scene.hand
    scene.set_iterations(settings.grip_iterations)
    robot.drive_fingers(settings.finger_closed)
    still = 0
    for tick in range(settings.close_most):
        scene.tick()
        if tick % settings.check_every == 0 and (touched := scene.robot_contact(name)):
            return Telemetry(ended="close", clearance=touched)
        slow = abs(robot.read_fingers()[1]) < settings.stall_speed
        still = still + 1 if slow and tick > settings.close_least else 0
        if still >= settings.stall:
            break
    if touched := scene.robot_contact(name):
        return Telemetry(ended="close", clearance=touched)
    force = scene.grip_force(name)
    ended: Stage | None = "close" if force <= 0 else None
    return Telemetry(ended=ended, finger_gap=robot.gap(), grip_force=force)


def shake(scene: GripScene, name: str, closed: Telemetry) -> Telemetry:
    """The lift test: nothing but the fingers holds the object, it is pulled about; how far does it slip?"""
    settings = scene.settings
    gripped = scene.in_tool(name)
    scene.let_collide(name, False)
    slip = angle = 0.0
    for pull, ticks in settings.shake:
        for _ in range(ticks):
            scene.push(name, pull)
            scene.tick()
        moved = displacement(name, gripped, scene.in_tool(name))
        slip, angle = max(slip, float(np.hypot(moved.level, moved.upright))), max(angle, moved.turned)
        if slip > settings.max_slip or angle > settings.max_slip_angle:
            return dataclasses.replace(closed, ended="lift", slip=slip, slip_angle=angle)
    return dataclasses.replace(closed, slip=slip, slip_angle=angle)


def _by_place(telemetry: Telemetry, names: list[str]) -> Telemetry:
    """Bodies named by their place in the set-up; the table keeps its name."""
    found = telemetry.clearance
    if found is None or found.other == TABLE:
        return telemetry
    named = dataclasses.replace(found, other=str(names.index(found.other)))
    return dataclasses.replace(telemetry, clearance=named)
