"""What touches what, after a collision detection or a tick, with the names of both bodies."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from proc3s import FloatArray
from proc3s_mujoco.parts import ROBOT
from proc3s_mujoco.simulation import TableScene
from proc3s_tabletop.engine.values import Touch
from proc3s_tabletop.telemetry import Clearance, Vector


@dataclass(frozen=True)
class Contact:
    """A contact of an object with another body, and the direction in which that pushes the object."""

    index: int
    distance: float
    other: str
    normal: Vector


def robot_contact(scene: TableScene, gripped: str | None = None) -> Clearance | None:
    """The deepest contact of the robot, with itself too; the hand may touch the object it grips."""
    found, parts = scene.state.data.contact, scene.parts
    one, other = found.geom.T
    mine, yours = parts.owner[one] == ROBOT, parts.owner[other] == ROBOT
    bad = (found.dist < -scene.settings.penetration) & (mine | yours)
    bad &= ~(parts.hand[one] & parts.hand[other])
    if gripped is not None:
        number = parts.things[gripped].number
        bad &= ~((parts.owner[other] == number) & parts.hand[one])
        bad &= ~((parts.owner[one] == number) & parts.hand[other])
    if not bad.any():
        return None
    k = int(np.where(bad, found.dist, np.inf).argmin())
    a, b = (one[k], other[k]) if mine[k] else (other[k], one[k])
    return Clearance(float(found.dist[k]), parts.part[a], parts.called(b))


def of_thing(scene: TableScene, name: str) -> Iterator[Contact]:
    """The contacts of an object, those with the robot apart."""
    found, parts = scene.state.data.contact, scene.parts
    owner, number = parts.owner[found.geom], parts.things[name].number
    for k in np.flatnonzero((owner == number).any(axis=1) & (owner != ROBOT).all(axis=1)).tolist():
        second = int(owner[k, 0] == number)
        # Normals point from the first body to the second.
        x, y, z = (found.frame[k, :3] * (-1.0 if second else 1.0)).tolist()
        yield Contact(k, float(found.dist[k]), parts.called(int(found.geom[k, second])), (x, y, z))


def touched(scene: TableScene, name: str) -> set[str]:
    """What an object touches after a tick, by name; the table is TABLE."""
    return {contact.other for contact in of_thing(scene, name) if contact.distance < 0}


def held_touches(scene: TableScene, name: str) -> list[Touch]:
    """What an object in hand touches, the robot apart."""
    depth = -scene.settings.touch
    return [
        Touch(Clearance(c.distance, name, c.other), c.normal)
        for c in of_thing(scene, name)
        if c.distance < depth
    ]


def grip_force(scene: TableScene, name: str) -> float:
    """Normal force of the side of the hand that presses an object less, newtons."""
    pairs, parts = scene.state.data.contact.geom, scene.parts
    mine = (parts.owner[pairs] == parts.things[name].number).any(axis=1)
    return min(
        sum(force(scene.state, k) for k in np.flatnonzero(mine & side[pairs].any(axis=1)).tolist())
        for side in parts.sides
    )


def force(state: Any, index: int) -> float:
    """The normal force of a contact after a tick, newtons."""
    result: FloatArray = np.zeros(6)
    mujoco.mj_contactForce(state.model, state.data, index, result)
    return float(result[0])
