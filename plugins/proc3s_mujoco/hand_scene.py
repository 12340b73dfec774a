"""Bodies on a table under a hand without an arm: for questions about grasps, and about what stands."""

from collections.abc import Mapping

import numpy as np

from proc3s_mujoco import contacts, rays, specs
from proc3s_mujoco.closest import distance
from proc3s_mujoco.hand import FloatingHand
from proc3s_mujoco.parts import Indices
from proc3s_mujoco.simulation import TableScene
from proc3s_tabletop.engine.values import ALOFT
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.settings import ReferenceSettings
from proc3s_tabletop.telemetry import TABLE


class HandScene(TableScene):
    """A table with its top at z = 0, the named bodies, and a floating hand."""

    robot: FloatingHand

    robot_contact = contacts.robot_contact
    grip_force = contacts.grip_force
    touched = contacts.touched
    cover = rays.cover

    def __init__(self, bodies: Mapping[str, Body], settings: ReferenceSettings) -> None:
        super().__init__(bodies, settings, specs.add_floating_hand, FloatingHand)
        self.robot.put(*ALOFT)

    @property
    def hand(self) -> FloatingHand:
        """The hand."""
        return self.robot

    def hand_depth(self, name: str) -> float:
        """How far the hand reaches into an object, metres; 0 where they do not meet."""
        return self._depth(self.parts.robot, self._geoms(name))

    def depth(self, one: str, other: str) -> float:
        """How deep two objects, or an object and TABLE, are in one another, metres; 0 if they are not."""
        return self._depth(self._geoms(one), self._geoms(other))

    def _geoms(self, name: str) -> Indices:
        return np.array([self.parts.table]) if name == TABLE else self.parts.things[name].geoms

    def _depth(self, one: Indices, other: Indices) -> float:
        found = distance(self, one, other, 0.0)
        return -found[0] if found else 0.0
