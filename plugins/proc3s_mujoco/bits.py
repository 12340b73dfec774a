"""What collides with what: a kind of its own for every part that is told apart, and whom it meets."""

from enum import IntFlag
from typing import Any


class Kind(IntFlag):
    """The kinds of geoms."""

    OBJECT = 1
    TABLE = 2
    ARM = 4
    """The arm up to the forearm."""
    WRIST = 8
    HAND = 16
    LEFT = 32
    RIGHT = 64
    """The pads: they meet each other, and nothing else of the hand."""


ROBOT = Kind.ARM | Kind.WRIST | Kind.HAND | Kind.LEFT | Kind.RIGHT
ALL = Kind.OBJECT | Kind.TABLE

MEETS = {
    Kind.OBJECT: ROBOT | ALL,
    Kind.TABLE: Kind(0),
    Kind.ARM: ROBOT | ALL,
    Kind.WRIST: Kind.ARM | Kind.WRIST | ALL,
    Kind.HAND: Kind.ARM | ALL,
    Kind.LEFT: Kind.ARM | Kind.RIGHT | ALL,
    Kind.RIGHT: Kind.ARM | Kind.LEFT | ALL,
}
"""MuJoCo lets geoms collide where the kind of either is among those that the other meets; links of the arm
that follow one another never collide, nor do links of the hand and the wrist that carries it."""


def mark(geom: Any, kind: Kind) -> None:
    """Give a geom of a specification its kind."""
    geom.contype, geom.conaffinity = int(kind), int(MEETS[kind])
