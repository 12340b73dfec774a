"""Picking: down, a look between the fingers, closing them, the lift test, and up."""

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.attempt import Attempt
from proc3s_tabletop.contacts import company, grip_force, hand_clearances, robot_contact
from proc3s_tabletop.motion import Line, contact, follow, line_down, put, travel
from proc3s_tabletop.scene import Held
from proc3s_tabletop.settling import compare, settle
from proc3s_tabletop.telemetry import displacement, least

INSIDE = 0.85
"""Rays run between the pads from this share of their distance, so that they start off the pads."""


def pick(attempt: Attempt, grasp: FloatArray) -> None:
    """Grasp what is at a pose (4, 4) of the grasp point and lift it."""
    if attempt.scene.held:
        attempt.stop("hand")
    line = line_down(attempt, grasp)
    travel(attempt, line.q[0], "approach")
    follow(attempt, line.q[1:], "approach")
    near = hand_clearances(attempt.scene)
    attempt.note_clearance(least([*near.values()]))
    name = between_fingers(attempt)
    # What neither the hand nor the object can reach, even through others, is at rest: it only costs time.
    scene = attempt.scene
    touchable = [other for other, c in near.items() if c.distance < attempt.recipe.stir]
    there = company(scene, [name, *touchable])
    aside = scene.set_aside([other for other in scene.bodies if other not in there])
    close(attempt, name)
    shake(attempt, name)
    scene.bring_back(aside)
    lift(attempt, line, name)


def between_fingers(attempt: Attempt) -> str:
    """The object that covers most of the grid of rays between the pads.

    Friction alone would hold what is gripped by an edge; a real grip would not, hence the least cover.
    """
    scene = attempt.scene
    starts, ends = _rays(attempt)
    hits = [hit[0] for hit in scene.client.rayTestBatch(starts, ends)]
    counts = {name: hits.count(body) for name, body in scene.bodies.items()}
    name = max(counts, key=lambda n: counts[n], default=None)
    cover = counts[name] / len(hits) if name else 0.0
    attempt.note(cover=cover, target=name if cover > 0 else None)
    if name is None or cover < attempt.recipe.min_cover:
        attempt.stop("grasp")
    return name


def _rays(attempt: Attempt) -> tuple[list[list[float]], list[list[float]]]:
    """Where the rays between the pads start and end, each way over the pads' width and along the fingers."""
    recipe, robot = attempt.recipe, attempt.scene.robot
    left, right = robot.pads()
    point, along = robot.grasp_point()
    middle = (left + right) / 2
    middle = middle + along * ((point - middle) @ along)
    across = np.cross(along, right - left)
    across /= np.linalg.norm(across)
    half = (left - right) / 2 * INSIDE
    grid = [middle + across * w + along * h for h in recipe.cover_along for w in recipe.cover_across]
    return [(x + half).tolist() for x in grid], [(x - half).tolist() for x in grid]


def close(attempt: Attempt, name: str) -> None:
    """Close the fingers until they stand still; both must press the object and nothing else be touched."""
    scene, recipe = attempt.scene, attempt.recipe
    scene.set_iterations(recipe.grip_iterations)
    scene.robot.drive(recipe.finger_closed)
    still = 0
    for tick in range(recipe.close_most):
        scene.tick()
        if tick % recipe.check_every == 0:
            _only_touching(attempt, name)
        slow = abs(scene.robot.read_fingers()[1]) < recipe.stall_speed
        still = still + 1 if slow and tick > recipe.close_least else 0
        if still >= recipe.stall:
            break
    _only_touching(attempt, name)
    force = grip_force(scene, name)
    attempt.note(finger_gap=scene.robot.gap(), grip_force=force)
    if force <= 0:
        attempt.stop("close")


def _only_touching(attempt: Attempt, name: str) -> None:
    found = robot_contact(attempt.scene, name)
    if found:
        attempt.stop("close", found)


def shake(attempt: Attempt, name: str) -> None:
    """The lift test: nothing but the fingers holds the object, it is pulled about; how far does it slip?"""
    scene, recipe = attempt.scene, attempt.recipe
    gripped = scene.in_tool(name)
    scene.let_collide(name, False)
    slip = angle = 0.0
    for pull, ticks in recipe.shake:
        for _ in range(ticks):
            scene.push(name, pull)
            scene.tick()
        moved = displacement(name, gripped, scene.in_tool(name))
        slip, angle = max(slip, float(np.hypot(moved.level, moved.upright))), max(angle, moved.turned)
        if slip > recipe.max_slip or angle > recipe.max_slip_angle:
            break
    attempt.note(slip=slip, slip_angle=angle)
    if slip > recipe.max_slip or angle > recipe.max_slip_angle:
        attempt.stop("lift")
    scene.held = Held(name, scene.in_tool(name))
    scene.set_iterations(recipe.iterations)
    scene.let_collide(name, True)


def lift(attempt: Attempt, line: Line, name: str) -> None:
    """Back up with the object fixed to the hand, then let the others come to rest."""
    scene, robot = attempt.scene, attempt.scene.robot
    robot.put_fingers(robot.read_fingers()[0])
    up, heights = line.q[-2::-1], line.heights[-2::-1]
    for q, height in zip(up, heights, strict=True):
        put(attempt, q)
        _clear(attempt, name, bool(height - line.heights[-1] > attempt.recipe.lift_off))
    scene.park(name)
    robot.drive(robot.angle)
    settle(attempt)
    robot.put_fingers(robot.angle)
    put(attempt, line.q[0])
    _clear(attempt, name, True)
    compare(attempt, attempt.before)


def _clear(attempt: Attempt, name: str, off: bool) -> None:
    """End the action if the hand or the object, once off, touches something else."""
    found = contact(attempt, name, with_held=off)
    if found:
        attempt.stop("carry", found)
