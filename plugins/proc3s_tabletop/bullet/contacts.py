"""What touches what: contacts after a collision detection, and clearances, with the names of both bodies."""

from collections.abc import Iterable
from typing import Any

from proc3s_tabletop.bullet.simulation import TableScene
from proc3s_tabletop.engine.values import ANY, Touch
from proc3s_tabletop.telemetry import Clearance, least

# Where PyBullet's contact points have what.
BODY_B, LINK_A, LINK_B, NORMAL, DISTANCE, FORCE = 2, 3, 4, 7, 8, 9

_TOUCHING = 0.001
"""Bodies nearer than this hold one another, m."""


def robot_contact(scene: TableScene, gripped: str | None = None) -> Clearance | None:
    """The deepest contact of the robot, with itself too; the hand may touch the object it grips."""
    depth, points = -scene.settings.penetration, scene.client.getContactPoints(scene.robot.id)
    return least([_robot_contact(scene, p, gripped) for p in points if p[DISTANCE] < depth])


def _robot_contact(scene: TableScene, point: Any, gripped: str | None) -> Clearance | None:
    robot, other = scene.robot, point[BODY_B]
    if other == robot.id:
        return Clearance(point[DISTANCE], robot.part(point[LINK_A]), robot.part(point[LINK_B]))
    if scene.named[other] == gripped and point[LINK_A] in robot.hand_links:
        return None
    return Clearance(point[DISTANCE], robot.part(point[LINK_A]), scene.named[other])


def held_touches(scene: TableScene, name: str) -> list[Touch]:
    """What an object in hand touches, the robot apart."""
    points = scene.client.getContactPoints(scene.bodies[name])
    return [
        Touch(Clearance(p[DISTANCE], name, scene.named[p[BODY_B]]), p[NORMAL])
        for p in points
        if p[BODY_B] != scene.robot.id and p[DISTANCE] < -scene.settings.touch
    ]


def grip_force(scene: TableScene, name: str) -> float:
    """Normal force of the side of the hand that presses an object less, newtons."""
    points = scene.client.getContactPoints(scene.robot.id, scene.bodies[name])
    return min(float(sum(p[FORCE] for p in points if p[LINK_A] in side)) for side in scene.robot.sides)


def hand_clearances(
    scene: TableScene, gripped: str | None = None, steepest: float = ANY
) -> dict[str, Clearance]:
    """The smallest distance of the robot to everything near but the gripped object, by name.

    Directions with an upward part of more than `steepest` do not count.
    """
    robot, found = scene.robot, {}
    for other, name in scene.named.items():
        if name != gripped:
            points = scene.client.getClosestPoints(robot.id, other, scene.settings.near)
            clearance = least(
                [
                    Clearance(p[DISTANCE], robot.part(p[LINK_A]), name)
                    for p in points
                    if p[LINK_A] > robot.base and abs(p[NORMAL][2]) <= steepest
                ]
            )
            if clearance:
                found[name] = clearance
    return found


def beside(scene: TableScene, name: str, other: str, most: float) -> float | None:
    """The smallest distance of two objects of which one is beside the other, if it is less than `most`, m."""
    points = scene.client.getClosestPoints(scene.bodies[name], scene.bodies[other], most)
    steepest = scene.settings.supporting
    return min((p[DISTANCE] for p in points if abs(p[NORMAL][2]) < steepest), default=None)


def company(scene: TableScene, names: Iterable[str]) -> set[str]:
    """The objects among `names`, and all that touch them, directly or through others.

    Boxes that only just meet have no contact points in PyBullet, so whatever is within 1 mm counts.
    """
    found: set[str] = set()
    todo = [name for name in names if name in scene.bodies]
    while todo:
        name = todo.pop()
        if name not in found:
            found.add(name)
            body = scene.bodies[name]
            todo += [
                other
                for other, id_ in scene.bodies.items()
                if id_ != body and scene.client.getClosestPoints(body, id_, _TOUCHING)
            ]
    return found
