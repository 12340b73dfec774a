"""Grips: closing the fingers and the lift test, with things that lie between them."""

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from proc3s_tabletop.bullet.contacts import grip_force, robot_contact
from proc3s_tabletop.bullet.simulation import Things
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


def try_grip(things: Things, names: list[str]) -> Grip:
    """Close the fingers on the first of the things named and shake it; the others lie around it."""
    telemetry = close(things, names[0])
    if not telemetry.ended:
        telemetry = shake(things, names[0], telemetry)
    others = tuple(things.frame(name) for name in names[1:])
    angle = things.robot.read_fingers()[0]
    return Grip(_by_place(telemetry, names), angle, things.in_tool(names[0]), others)


def close(things: Things, name: str) -> Telemetry:
    """Close the fingers until they stand still; both must press the object and nothing else be touched."""
    recipe, robot = things.recipe, things.robot
    things.set_iterations(recipe.grip_iterations)
    robot.drive_fingers(recipe.finger_closed)
    still = 0
    for tick in range(recipe.close_most):
        things.tick()
        if tick % recipe.check_every == 0 and (touched := robot_contact(things, name)):
            return Telemetry(ended="close", clearance=touched)
        slow = abs(robot.read_fingers()[1]) < recipe.stall_speed
        still = still + 1 if slow and tick > recipe.close_least else 0
        if still >= recipe.stall:
            break
    if touched := robot_contact(things, name):
        return Telemetry(ended="close", clearance=touched)
    force = grip_force(things, name)
    ended: Stage | None = "close" if force <= 0 else None
    return Telemetry(ended=ended, finger_gap=robot.gap(), grip_force=force)


def shake(things: Things, name: str, closed: Telemetry) -> Telemetry:
    """The lift test: nothing but the fingers holds the object, it is pulled about; how far does it slip?"""
    recipe = things.recipe
    gripped = things.in_tool(name)
    things.let_collide(name, False)
    slip = angle = 0.0
    for pull, ticks in recipe.shake:
        for _ in range(ticks):
            things.push(name, pull)
            things.tick()
        moved = displacement(name, gripped, things.in_tool(name))
        slip, angle = max(slip, float(np.hypot(moved.level, moved.upright))), max(angle, moved.turned)
        if slip > recipe.max_slip or angle > recipe.max_slip_angle:
            return dataclasses.replace(closed, ended="lift", slip=slip, slip_angle=angle)
    return dataclasses.replace(closed, slip=slip, slip_angle=angle)


def _by_place(telemetry: Telemetry, names: list[str]) -> Telemetry:
    """Bodies named by their place in the set-up; the table keeps its name."""
    found = telemetry.clearance
    if found is None or found.other == TABLE:
        return telemetry
    named = dataclasses.replace(found, other=str(names.index(found.other)))
    return dataclasses.replace(telemetry, clearance=named)
