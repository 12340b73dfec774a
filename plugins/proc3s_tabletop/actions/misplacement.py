"""Errors of a camera and an arm that are not calibrated well: things are not quite where they should be."""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from proc3s_tabletop.robot.frames import Frame, compose

TURN = math.radians(0.5) / 1e-3
"""What is off by a metre is turned by up to this, rad: half a degree a millimetre."""


class Offset(NamedTuple):
    """How far off something is: along x and y, m, and turned about z, rad."""

    x: float
    y: float
    turn: float


class Misplacement:
    """One time that a plan is carried out: draws how far off things are, by up to `error` metres.

    An offset is uniform in the disc of that radius, its turn uniform up to `TURN` times the radius either
    way. The same generator gives the same draws whatever the radius, which scales them.
    """

    def __init__(self, rng: np.random.Generator, error: float) -> None:
        self._rng, self._error = rng, error

    def draw(self) -> Offset:
        """A new offset."""
        area, direction, turn = self._rng.random(3).tolist()
        radius, angle = self._error * math.sqrt(area), 2 * math.pi * direction
        turned = self._error * TURN * (2 * turn - 1)
        return Offset(radius * math.cos(angle), radius * math.sin(angle), turned)

    def stands(self, frames: Mapping[str, Frame]) -> dict[str, Frame]:
        """Where objects stand that are believed to stand in these frames, each off by its own draw."""
        return {name: off(frames[name], self.draw()) for name in sorted(frames)}


def off(frame: Frame, offset: Offset) -> Frame:
    """A frame moved by an offset, and turned about the vertical through its own origin."""
    x, y, z = frame.position
    turn = Frame((0.0, 0.0, 0.0), (0.0, 0.0, math.sin(offset.turn / 2), math.cos(offset.turn / 2)))
    return Frame((x + offset.x, y + offset.y, z), compose(turn, frame).rotation)
