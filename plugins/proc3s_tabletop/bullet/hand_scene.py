"""Bodies on a table under a hand without an arm: for questions about grasps, and about what stands."""

from collections.abc import Mapping

from proc3s_tabletop.bullet import contacts, rays
from proc3s_tabletop.bullet.contacts import DISTANCE
from proc3s_tabletop.bullet.hand import FloatingHand
from proc3s_tabletop.bullet.simulation import TableScene
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.settings import ReferenceSettings
from proc3s_tabletop.telemetry import TABLE


class HandScene(TableScene):
    """A table with its top at z = 0, the named bodies, and a floating hand."""

    robot: FloatingHand

    robot_contact = contacts.robot_contact
    grip_force = contacts.grip_force
    cover = rays.cover

    def __init__(self, bodies: Mapping[str, Body], settings: ReferenceSettings) -> None:
        super().__init__(bodies, settings, FloatingHand)

    @property
    def hand(self) -> FloatingHand:
        """The hand."""
        return self.robot

    def hand_depth(self, name: str) -> float:
        """How far the hand reaches into an object, metres; 0 where they do not meet."""
        return self._depth(self.robot.id, self.bodies[name])

    def depth(self, one: str, other: str) -> float:
        """How deep two objects, or an object and TABLE, are in one another, metres; 0 if they are not."""
        ids = {**self.bodies, TABLE: self.table}
        return self._depth(ids[one], ids[other])

    def _depth(self, one: int, other: int) -> float:
        points = self.client.getClosestPoints(one, other, 0.0)
        return max((-float(point[DISTANCE]) for point in points), default=0.0)
