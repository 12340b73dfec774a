"""The final table as judges see it: of every object its name for people, its middle and its extent."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from proc3s_tabletop.catalogue.body_specs import bodies_of
from proc3s_tabletop.objects.extents import Extent, extent
from proc3s_tabletop.sentences import called
from proc3s_tabletop.tasks.selection import select, selector

Choice = Mapping[str, Any]


@dataclass(frozen=True)
class Solid:
    """An object of the final state: its name for people, where its middle is (m), and its extent."""

    says: str
    x: float
    y: float
    extent: Extent


class FinalTable:
    """All objects of a final state."""

    def __init__(self, state: Any, bodies: Mapping[str, Any] | None) -> None:
        known = bodies_of(bodies)
        self._objects: Mapping[str, Any] = state.objects
        self._solids = {
            name: Solid(called(state.objects, name), o.pose.x, o.pose.y, extent(known[o.category], o.pose))
            for name, o in state.objects.items()
        }

    def chosen(self, what: Choice | None, where: str) -> list[Solid]:
        """The objects that are meant. Raises SpecError on a choice that cannot be read."""
        return [self._solids[name] for name in select(self._objects, selector(what, where))]

    def named(self, name: str) -> Solid:
        """The object of a name."""
        return self._solids[name]

    def others(self, solid: Solid) -> list[Solid]:
        """Everything else."""
        return [other for other in self._solids.values() if other is not solid]


def listed(solids: Sequence[Solid]) -> str:
    """Objects for people."""
    return ", ".join(solid.says for solid in solids) or "nothing"
