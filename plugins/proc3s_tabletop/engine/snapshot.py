"""Snapshots: everything that an action starts from, as plain data of no engine."""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from proc3s_tabletop.robot.frames import Frame, Held, compose
from proc3s_tabletop.robot.settings import HOME


@dataclass(frozen=True)
class Snapshot:
    """Everything that a step depends on: at rest, rounded, comparable, and plain data.

    Poses of objects by name in the order of the scene, joint angles of the arm, the angle that the fingers
    are driven to, and `linkage`, the angles of all finger joints, where they hold something by friction.
    """

    frames: tuple[tuple[str, Frame], ...]
    q: tuple[float, ...] = HOME
    angle: float = 0.0
    held: Held | None = None
    linkage: tuple[float, ...] = ()
    grasp: tuple[float, ...] = ()
    """The six numbers of the grasp, in the frame of the object, that a pick named with the object."""
    believed: tuple[tuple[str, Frame], ...] = ()
    """Of objects that are not where the arm believes: where it does, in the true frame of each."""

    def after(self, before: "Snapshot") -> "Snapshot":
        """The same, with objects that hardly moved since `before` put back: nothing creeps."""
        frames = zip(before.frames, self.frames, strict=True)
        held = {snapshot.held.name for snapshot in (before, self) if snapshot.held}
        kept = ((n, old if n not in held and _same(old, new) else new) for (n, old), (_, new) in frames)
        return dataclasses.replace(self, frames=tuple(kept), believed=before.believed)

    def seen(self, name: str) -> Frame:
        """Where the arm believes an object to be; an error of the camera stays with what it was made of."""
        true, believed = dict(self.frames)[name], dict(self.believed)
        return compose(true, believed[name]) if name in believed else true

    def filmed(self) -> dict[str, Any]:
        """What a picture shows of it, as plain data: a frame of a film."""
        return {"frames": dict(self.frames), "q": self.q, "angle": self.angle, "linkage": self.linkage}

    @classmethod
    def of_film(cls, film: Mapping[str, Any]) -> "Snapshot":
        """A snapshot that looks as it was filmed."""
        frames = tuple((name, Frame(*map(tuple, frame))) for name, frame in film["frames"].items())
        return cls(frames, tuple(film["q"]), film["angle"], linkage=tuple(film["linkage"]))

    def loose(self) -> dict[str, Frame]:
        """Where all objects are that are not in hand."""
        held = self.held.name if self.held else None
        return {name: frame for name, frame in self.frames if name != held}


def _same(a: Frame, b: Frame) -> bool:
    """Whether two frames differ by less than 0.1 mm along every axis and by about 0.001 rad."""
    apart = max(abs(p - q) for p, q in zip(a.position, b.position, strict=True))
    turned = max(abs(p - q) for p, q in zip(a.rotation, b.rotation, strict=True))
    return apart < 1e-4 and turned < 5e-4
