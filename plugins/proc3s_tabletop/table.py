"""A table that picks and places happen on: a scene, and the snapshot that the next action starts from."""

import dataclasses
from abc import ABC, abstractmethod
from collections.abc import Mapping

from proc3s_tabletop.bodies import Body
from proc3s_tabletop.recipe import Recipe
from proc3s_tabletop.scene import Scene, Snapshot
from proc3s_tabletop.telemetry import Telemetry
from proc3s_tabletop.things import Frame


class Table(ABC):
    """Carries out picks and places among named bodies, each a function of the snapshot it starts from.

    How, a subclass says. Close it after use.
    """

    def __init__(
        self, bodies: Mapping[str, Body], frames: Mapping[str, Frame], recipe: Recipe | None = None
    ) -> None:
        self.scene = Scene(bodies, recipe or Recipe())
        self.put(frames)

    def put(self, frames: Mapping[str, Frame]) -> None:
        """Start again, empty-handed, with every body at its frame."""
        self.snapshot = Snapshot(tuple((name, frames[name]) for name in self.scene.bodies))

    def set_speed(self, speed: float) -> None:
        """Scale the speed of arm and fingers."""
        recipe = dataclasses.replace(self.scene.recipe, speed=speed)
        self.scene.recipe = self.scene.robot.recipe = recipe

    @abstractmethod
    def pick(self, x: float, y: float, z: float) -> Telemetry:
        """Grasp from above, fingers open along y, the grasp point at x, y, z (metres); lift by the hover."""

    @abstractmethod
    def place(self, x: float, y: float, z: float) -> Telemetry:
        """Set down what is held with the grasp point over x, y (metres), where it meets its support.

        The descent ends at the support, at the latest a little below z; over nothing the object drops from z.
        """

    def close(self) -> None:
        """Give up the simulator."""
        self.scene.close()
