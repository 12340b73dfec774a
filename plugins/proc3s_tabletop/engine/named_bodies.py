"""What the scenes of every engine do alike with the bodies that they know by name."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping

from proc3s_tabletop.engine.protocol import Hand
from proc3s_tabletop.engine.values import Lies
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.frames import Frame, Held, compose, inverse


class NamedBodies(ABC):
    """Bodies by name under a hand, which may hold one of them; an engine says where they are."""

    shapes: Mapping[str, Body]
    robot: Hand
    held: Held | None

    @abstractmethod
    def frame(self, name: str) -> Frame:
        """Where an object is."""

    @abstractmethod
    def put(self, name: str, frame: Frame) -> None:
        """Move an object, keeping its velocity."""

    @abstractmethod
    def stop(self, name: str) -> None:
        """Bring an object to rest."""

    @property
    def names(self) -> tuple[str, ...]:
        """The bodies, in the order of the scene."""
        return tuple(self.shapes)

    def frames(self) -> dict[str, Frame]:
        """Where all objects are that are not in hand."""
        return {name: self.frame(name) for name in self.loose()}

    def loose(self) -> Iterator[str]:
        """The objects that are not in hand."""
        return (name for name in self.shapes if not self.held or name != self.held.name)

    def lies(self, names: Iterable[str]) -> Lies:
        """Bodies and where they are."""
        return tuple((self.shapes[name], self.frame(name)) for name in names)

    def bring_back(self, frames: Mapping[str, Frame]) -> None:
        """Put objects back, at rest."""
        for name, frame in frames.items():
            self.put(name, frame)
            self.stop(name)

    def in_tool(self, name: str) -> Frame:
        """Where an object is in the frame of tool0."""
        return compose(inverse(Frame(*self.robot.tool())), self.frame(name))

    def carry(self) -> None:
        """Move the held object to where the hand has it."""
        if self.held:
            self.put(self.held.name, compose(Frame(*self.robot.tool()), self.held.frame))
