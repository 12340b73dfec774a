"""The arm on its way: joint angles along a line, and every way-point tested for contact."""

import math
from dataclasses import dataclass

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.actions.attempt import Attempt
from proc3s_tabletop.engine.values import deepest
from proc3s_tabletop.robot import ik
from proc3s_tabletop.robot.grasp_frames import tool_poses, tool_to_grasp
from proc3s_tabletop.robot.settings import TABLE_BOUNDS
from proc3s_tabletop.telemetry import Clearance, Stage, least

LOOKS = 200
"""Points on the way to a goal out of reach at which the arm's reach is looked up."""


@dataclass(frozen=True)
class Line:
    """Way-points straight down from the hover: joint angles (n, 6), heights (n,) of the grasp point in m."""

    q: FloatArray
    heights: FloatArray


def line_down(attempt: Attempt, grasp: FloatArray, beyond: float = 0.0) -> Line:
    """Joint angles from the hover down to a grasp (4, 4), and one way-point further below it.

    The branch nearest to where the arm is comes first; one that breaks off on the way is passed over.
    Ends the action at `reach` where none is left.
    """
    settings, z = attempt.settings, grasp[2, 3]
    steps = max(2, math.ceil(settings.hover / (settings.line_spacing * settings.speed)))
    heights = np.linspace(z + settings.hover, z, steps + 1)
    if beyond > 0:
        heights = np.append(heights, z - beyond)
    grasps = np.repeat(grasp[None], len(heights), axis=0)
    grasps[:, 2, 3] = heights
    q = _joints(attempt, grasps)
    if q is None:
        attempt.note(ik_residual=max(_miss(grasps[0]), _miss(grasps[steps]), settings.line_spacing))
        attempt.stop("reach")
    residual = float(np.linalg.norm((ik.forward(q) @ tool_to_grasp() - grasps)[:, :3, 3], axis=1).max())
    attempt.note(ik_residual=residual)
    if residual > settings.ik_tolerance:
        attempt.stop("reach")
    return Line(q, heights)


def _joints(attempt: Attempt, grasps: FloatArray) -> FloatArray | None:
    """One continuous branch along all poses, or None."""
    solutions, exists = ik.inverse(tool_poses(grasps))
    here = attempt.scene.robot.q
    for branch in ik.nearest_first(solutions[0], exists[0], here):
        if exists[:, branch].all():
            q = ik.unwound(solutions[:, branch], here)
            if np.abs(np.diff(q, axis=0)).max() <= attempt.settings.branch_jump and _within_limits(q):
                return q
    return None


def _within_limits(q: FloatArray) -> bool:
    return bool((np.abs(q) <= ik.LIMITS).all())


def _miss(grasp: FloatArray) -> float:
    """How far a grasp lies beyond reach, metres, on the line to it from above the middle of the table."""
    start = grasp.copy()
    start[:3, 3] = [*(sum(side) / 2 for side in TABLE_BOUNDS), 0.1]
    way = np.linspace(0.0, 1.0, LOOKS + 1)
    grasps = np.repeat(start[None], len(way), axis=0)
    grasps[:, :3, 3] += way[:, None] * (grasp - start)[:3, 3]
    _, exists = ik.inverse(tool_poses(grasps))
    reached = way[exists.any(axis=1)].max(initial=0.0)
    return float((1 - reached) * np.linalg.norm((grasp - start)[:3, 3]))


def put(attempt: Attempt, q: FloatArray) -> None:
    """Set the arm and what it holds, and detect collisions."""
    scene = attempt.scene
    scene.robot.put_arm(q)
    scene.carry()
    scene.detect()


def contact(attempt: Attempt, gripped: str | None = None, with_held: bool = True) -> Clearance | None:
    """The deepest contact of the robot or of the held object where they were put.

    The hand may touch `gripped`. `with_held` False leaves out what the held object touches.
    """
    scene = attempt.scene
    touches = scene.held_touches(scene.held.name) if scene.held and with_held else []
    return least([scene.robot_contact(gripped), deepest(touches)])


def follow(attempt: Attempt, q: FloatArray, stage: Stage, gripped: str | None = None) -> None:
    """Go through way-points (n, 6); a contact ends the action at `stage`."""
    for point in q:
        put(attempt, point)
        found = contact(attempt, gripped)
        if found:
            attempt.stop(stage, found)


def travel(attempt: Attempt, q: FloatArray, stage: Stage, gripped: str | None = None) -> None:
    """Go straight in joint space to angles (6,)."""
    settings, here = attempt.settings, attempt.scene.robot.q
    distance = np.abs(q - here).max() * settings.reach
    steps = max(1, math.ceil(distance / (settings.move_spacing * settings.speed)))
    follow(attempt, here + (q - here) * (np.arange(1, steps + 1) / steps)[:, None], stage, gripped)
