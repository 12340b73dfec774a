"""Placing: down until the held object meets its support, letting go, leaving, and coming to rest."""

from typing import NamedTuple

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.actions.attempt import Attempt
from proc3s_tabletop.actions.motion import Line, contact, follow, line_down, put, travel
from proc3s_tabletop.actions.neighbours import lower, note_neighbours
from proc3s_tabletop.actions.outcome import compare, rest
from proc3s_tabletop.engine.protocol import GripSimulation
from proc3s_tabletop.engine.values import Touch, deepest
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.telemetry import Clearance


class Obstruction(NamedTuple):
    """What is in the way at a way-point: of the robot, and of the object in hand."""

    robot: Clearance | None
    held: list[Touch]


class Stand(NamedTuple):
    """The last free way-point of a descent: joint angles, height of the grasp point, and what stopped it."""

    q: FloatArray
    height: float
    obstruction: Obstruction | None


def place(attempt: Attempt, grasp: FloatArray, grips: GripSimulation) -> None:
    """Set the held object down at a pose (4, 4) of the grasp point and leave it."""
    scene = attempt.scene
    if not scene.held:
        attempt.stop("hand")
    name = scene.held.name
    attempt.note(target=name)
    line = line_down(attempt, grasp, attempt.settings.press)
    travel(attempt, line.q[0], "carry", name)
    stand = descend(attempt, line, name)
    start, drop = scene.frame(name), 0.0
    if stand.obstruction:
        note_support(attempt, stand.obstruction.held, stand.height - float(grasp[2, 3]))
    else:
        drop = measure_drop(attempt, name)
    note_neighbours(attempt, name, lower(start, drop))
    # Bit for bit where it was: a frame that was read is not quite the one that was put.
    scene.carry() if stand.obstruction else scene.put(name, start)
    release(attempt, grips, line, stand, name, drop)


def descend(attempt: Attempt, line: Line, name: str) -> Stand:
    """Down the line until the held object meets something; onto nothing, to the commanded height.

    Ends the action where the robot touches something first, or the object runs into a side.
    """
    stand = _guarded(attempt, line, name)
    commanded = Stand(line.q[-2], float(line.heights[-2]), None)
    found = stand.obstruction
    if found and not found.held and stand.height > commanded.height + 1e-9:
        attempt.stop("descent", found.robot)
    if found and found.held and not any(abs(t.normal[2]) >= attempt.settings.supporting for t in found.held):
        attempt.stop("descent", deepest(found.held))
    if not found or not found.held:
        stand = commanded
    follow(attempt, stand.q[None], "descent", name)
    return stand


def _guarded(attempt: Attempt, line: Line, name: str) -> Stand:
    """The lowest free way-point, between two of the line where something is met."""
    free = Stand(line.q[0], float(line.heights[0]), None)
    for q, height in zip(line.q[1:], line.heights[1:], strict=True):
        found = _obstruction(attempt, q, name)
        if found:
            return _bisect(attempt, free, Stand(q, float(height), found), name)
        free = Stand(q, float(height), None)
    return free


def _bisect(attempt: Attempt, free: Stand, blocked: Stand, name: str) -> Stand:
    """Close in on the contact between a free and a blocked way-point."""
    for _ in range(attempt.settings.bisections):
        q, height = (free.q + blocked.q) / 2, (free.height + blocked.height) / 2
        found = _obstruction(attempt, q, name)
        if found:
            blocked = Stand(q, height, found)
        else:
            free = Stand(q, height, None)
    return Stand(free.q, free.height, blocked.obstruction)


def _obstruction(attempt: Attempt, q: FloatArray, name: str) -> Obstruction | None:
    put(attempt, q)
    found = Obstruction(attempt.scene.robot_contact(name), attempt.scene.held_touches(name))
    return found if found.robot or found.held else None


def note_support(attempt: Attempt, touches: list[Touch], height: float) -> None:
    """Note what pushes the object up most, and where that is above the commanded height."""
    support = max(touches, key=lambda touch: abs(touch.normal[2]))
    attempt.note(support=support.clearance.other, support_height=height)


def measure_drop(attempt: Attempt, name: str) -> float:
    """How far the object will fall, metres, found by sweeping it down; onto nothing ends the action."""
    settings = attempt.settings
    start = attempt.scene.frame(name)
    drops = np.arange(settings.drop_step, settings.drop_most + 1e-9, settings.drop_step)
    low = next((float(drop) for drop in drops if _lowered(attempt, name, start, drop)), None)
    if low is None:
        attempt.note(support_height=-settings.drop_most)
        attempt.stop("support")
    high = low - settings.drop_step
    for _ in range(settings.bisections):
        middle = (low + high) / 2
        low, high = (middle, high) if _lowered(attempt, name, start, middle) else (low, middle)
    note_support(attempt, _lowered(attempt, name, start, low), -high)
    attempt.scene.put(name, start)
    return high


def _lowered(attempt: Attempt, name: str, start: Frame, drop: float) -> list[Touch]:
    """What the object would touch lower down."""
    attempt.scene.put(name, lower(start, drop))
    attempt.scene.detect()
    return attempt.scene.held_touches(name)


def release(
    attempt: Attempt, grips: GripSimulation, line: Line, stand: Stand, name: str, drop: float
) -> None:
    """Open no further than needed, go up, and let everything come to rest; the baseline is taken before."""
    scene, robot = attempt.scene, attempt.scene.robot
    scene.held = None
    baseline = scene.frames()
    attempt.note_hand(name)
    open_fingers(attempt, stand, name)
    above = line.q[line.heights > stand.height + 1e-9][::-1]
    follow(attempt, np.vstack([stand.q, above]), "release")
    near = scene.company([name, *scene.near(name, attempt.settings.fall + drop)])
    rest(attempt, grips, [name, *(other for other in scene.names if other in near - {name})])
    compare(attempt, baseline, name, drop)
    robot.put_arm(line.q[0])
    robot.put_fingers(0.0)


def open_fingers(attempt: Attempt, stand: Stand, name: str) -> None:
    """Open to the width of the object and a margin, looking half-way and at the end."""
    robot = attempt.scene.robot
    gap = robot.gap()
    closed, opened = robot.angle, robot.angle_for(gap + 2 * attempt.settings.open_margin)
    attempt.note(finger_gap=gap)
    for angle, gripped in (((closed + opened) / 2, name), (opened, name)):
        robot.put_fingers(angle)
        put(attempt, stand.q)
        found = contact(attempt, gripped)
        if found:
            attempt.stop("release", found)
    attempt.note_hand(name)
