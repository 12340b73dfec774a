"""A body: its shape, mass, friction and color."""

from collections.abc import Mapping
from dataclasses import dataclass

from proc3s_tabletop.objects.shapes import Bowl, Box, Shape


@dataclass(frozen=True)
class Body:
    """A shape with a mass in kg and coefficients of friction."""

    shape: Shape
    mass: float
    friction: float = 0.6
    rolling_friction: float = 0.0
    spinning_friction: float = 0.0

    color: str = ""
    """Where the state names none."""

    @property
    def height(self) -> float:
        """Of its centre of mass above the table where it stands upright, m."""
        return -float(self.shape.corners()[:, 2].min())

    @property
    def top(self) -> float:
        """How high it reaches above its centre of mass where it stands upright, m."""
        return float(self.shape.corners()[:, 2].max())


BLOCK_SIZE = 0.04
"""Edge of a block, m (the paper)."""


CATEGORIES: Mapping[str, Body] = {
    # 60 g: a cube of light wood of this size. 300 g: a small bowl of china.
    "block": Body(Box((BLOCK_SIZE, BLOCK_SIZE, BLOCK_SIZE)), mass=0.06),
    "bowl": Body(Bowl(), mass=0.3),
}
"""The body of every category of object, where a domain does not bring its own."""
