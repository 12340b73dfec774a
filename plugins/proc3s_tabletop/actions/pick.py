"""Picking: down, a look between the fingers, closing them, the lift test, and up."""

import dataclasses

import numpy as np

from proc3s import FloatArray
from proc3s.domain.transforms import matrices
from proc3s_tabletop.actions.attempt import Attempt
from proc3s_tabletop.actions.motion import Line, contact, follow, line_down, put, travel
from proc3s_tabletop.actions.outcome import compare, rest
from proc3s_tabletop.engine.protocol import GripSimulation
from proc3s_tabletop.robot import frames as poses
from proc3s_tabletop.robot.frames import Frame, Held
from proc3s_tabletop.robot.widths import too_wide
from proc3s_tabletop.telemetry import Clearance


def pick(attempt: Attempt, grasp: FloatArray, grips: GripSimulation) -> None:
    """Grasp what is at a pose (4, 4) of the grasp point and lift it."""
    if attempt.scene.held:
        attempt.stop("hand")
    line = line_down(attempt, grasp)
    travel(attempt, line.q[0], "approach")
    follow(attempt, line.q[1:], "approach")
    near = attempt.scene.hand_clearances()
    attempt.note_hand()
    name = between_fingers(attempt)
    # What neither the hand nor the object can reach, even through others, takes no part.
    touchable = [other for other, c in near.items() if c.distance < attempt.settings.stir]
    there = attempt.scene.company([name, *touchable])
    others = [other for other in attempt.scene.names if other in there - {name}]
    grip(attempt, grips, name, others)
    lift(attempt, grips, line, name, others)


def between_fingers(attempt: Attempt) -> str:
    """The object that covers most of the grid of rays between the pads.

    Friction alone would hold what is gripped by an edge; a real grip would not, hence the least cover.
    """
    shares = attempt.scene.cover()
    name = max(shares, key=lambda n: shares[n], default=None)
    most = shares[name] if name else 0.0
    attempt.note(cover=most, target=name if most > 0 else None)
    if name is None or most < attempt.settings.min_cover:
        attempt.stop("grasp")
    return name


def note_width(attempt: Attempt, grasp: FloatArray) -> None:
    """Where a grasp (4, 4) failed before the fingers closed, note what is too wide for them there."""
    measured, scene = attempt.telemetry, attempt.scene
    if measured.attempted != "pick" or measured.ended not in ("approach", "grasp"):
        return
    met = measured.clearance.other if measured.ended == "approach" and measured.clearance else None
    for name, body in scene.shapes.items():
        there = matrices(np.array([*poses.numbers(scene.frame(name)).values()]))
        here = np.linalg.inv(there) @ grasp
        if met in (None, name) and too_wide(body.shape, here[None])[0]:
            attempt.note(too_wide=name)


def grip(attempt: Attempt, grips: GripSimulation, name: str, others: list[str]) -> None:
    """Close the fingers on an object and shake it; what lies near enough to be touched takes part."""
    scene, names = attempt.scene, [name, *others]
    found = grips.grip(Frame(*scene.robot.tool()), scene.lies(names), scene.settings.speed)
    measured = found.telemetry
    attempt.note(finger_gap=measured.finger_gap, grip_force=measured.grip_force)
    attempt.note(slip=measured.slip, slip_angle=measured.slip_angle)
    if measured.ended:
        attempt.stop(measured.ended, _named(measured.clearance, names))
    scene.bring_back(dict(zip(others, found.lies, strict=True)))
    scene.robot.put_fingers(found.angle)
    scene.held = Held(name, found.held)


def _named(found: Clearance | None, names: list[str]) -> Clearance | None:
    """A contact in a grip, with the names of this scene."""
    if found is None or not found.other.isdigit():
        return found
    return dataclasses.replace(found, other=names[int(found.other)])


def lift(attempt: Attempt, grips: GripSimulation, line: Line, name: str, others: list[str]) -> None:
    """Back up with the object fixed to the hand, then let the others come to rest."""
    up, heights = line.q[-2::-1], line.heights[-2::-1]
    for q, height in zip(up, heights, strict=True):
        put(attempt, q)
        _clear(attempt, name, bool(height - line.heights[-1] > attempt.settings.lift_off))
    rest(attempt, grips, others)
    put(attempt, line.q[0])
    _clear(attempt, name, True)
    compare(attempt, attempt.before)


def _clear(attempt: Attempt, name: str, off: bool) -> None:
    """End the action if the hand or the object, once off, touches something else."""
    found = contact(attempt, name, with_held=off)
    if found:
        attempt.stop("carry", found)
