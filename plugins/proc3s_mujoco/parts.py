"""Which geoms of a model belong to what: to the table, to a named body, or to a part of the robot."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from proc3s_mujoco.shapes import THING
from proc3s_mujoco.specs import ARM, HAND, TABLE

Indices = NDArray[np.intp]

ROBOT, BOARD = -1, -2
"""Owners of geoms beside the bodies, which count from 0."""

NAMES = {
    "shoulder_link": "shoulder",
    "upper_arm_link": "upper arm",
    "forearm_link": "forearm",
    "wrist_1_link": "wrist",
    "wrist_2_link": "wrist",
    "wrist_3_link": "wrist",
}
"""The links of the arm and their names for people."""


@dataclass(frozen=True)
class Thing:
    """Where a named body is in a model: its number among them, its body and geoms, position and velocity."""

    number: int
    body: int
    geoms: Indices
    position: slice
    velocity: slice
    radius: float
    """Of a sphere around its centre of mass, m."""


class Parts:
    """What the geoms that collide belong to."""

    def __init__(self, model: Any, names: Iterable[str]) -> None:
        self.things = {name: _thing(model, k, name) for k, name in enumerate(names)}
        self.names = [*self.things]
        self.table = int(model.geom(TABLE).id)
        self.owner = np.full(model.ngeom, ROBOT)
        """Of every geom: ROBOT, BOARD, or the number of a body."""
        self.owner[self.table] = BOARD
        for thing in self.things.values():
            self.owner[thing.geoms] = thing.number
        bodies = [model.body(int(k)).name for k in model.geom_bodyid]
        self.part = [NAMES.get(name.removeprefix(ARM), "gripper") for name in bodies]
        """What people call the part of the robot that a geom belongs to."""
        self.hand = np.array([name.startswith(HAND) for name in bodies])
        self.sides = [np.array([n.startswith(HAND + side) for n in bodies]) for side in ("left", "right")]
        solid = (model.geom_contype != 0) & (np.array(self.part) != "shoulder")
        self.robot: Indices = np.flatnonzero((self.owner == ROBOT) & solid)
        """The robot, from the upper arm on: the shoulder is always where it is."""

    def called(self, geom: int) -> str:
        """The name of the body or of the table that a geom belongs to; a part of the robot by its own."""
        owner = int(self.owner[geom])
        return TABLE if owner == BOARD else self.part[geom] if owner == ROBOT else self.names[owner]


def _thing(model: Any, number: int, name: str) -> Thing:
    body = model.body(THING + name)
    joint = model.joint(int(body.jntadr[0]))
    at, moves = int(joint.qposadr[0]), int(joint.dofadr[0])
    position, velocity = slice(at, at + 7), slice(moves, moves + 6)
    geoms = np.flatnonzero(model.geom_bodyid == body.id)
    radius = (np.linalg.norm(model.geom_pos[geoms], axis=1) + model.geom_rbound[geoms]).max()
    return Thing(number, int(body.id), geoms, position, velocity, float(radius))
