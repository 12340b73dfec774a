"""Simulates grips and falls of a few objects apart from the scene, and caches the outcome by their poses."""

import dataclasses
import functools
from collections.abc import Callable, Iterable, Iterator, Mapping

from proc3s_tabletop.engine.grip_test import GripSetup, try_grip, upright
from proc3s_tabletop.engine.protocol import GripScene
from proc3s_tabletop.engine.settle import settle
from proc3s_tabletop.engine.values import ALOFT, Grip, Lies, Rest
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.frames import Frame, compose, inverse, rounded
from proc3s_tabletop.robot.settings import ReferenceSettings

MOST = 1024
"""Cached outcomes of each kind; the least recently used one goes first."""

DIGITS = 6
"""Decimals of the poses that an outcome is cached by, in m and in parts of a quaternion."""


class GripSimulator:
    """Simulates a few things on a table under a hand without an arm, always in the same place.

    The outcome depends on the question alone, so it is cached. Equal bodies of a scene share their outcomes:
    the first of each sort is simulated in place of the others. `make` makes the table. Close it after use.
    """

    def __init__(
        self,
        bodies: Mapping[str, Body],
        settings: ReferenceSettings,
        make: Callable[[Mapping[str, Body], ReferenceSettings], GripScene],
    ) -> None:
        self._bodies, self._settings, self._make = bodies, settings, make
        self._made: GripScene | None = None
        self._known_grip = functools.lru_cache(MOST)(self._grip)
        self._known_rest = functools.lru_cache(MOST)(self._rest)

    def grip(self, tool: Frame, lies: Lies, speed: float) -> Grip:
        """What comes of closing the hand, its tool0 at a frame, on the first of the things that lie there."""
        there = upright(tool)
        found = self._known_grip(GripSetup(speed, self._moved(there, tool), self._all_moved(there, lies)))
        return dataclasses.replace(found, lies=self._back(there, found.lies))

    def rest(self, lies: Lies) -> Rest:
        """Where things come to rest that nothing holds any more."""
        x, y, _ = lies[0][1].position
        there = Frame((-x, -y, 0.0), (0.0, 0.0, 0.0, 1.0))
        found = self._known_rest(self._all_moved(there, lies))
        return found._replace(frames=self._back(there, found.frames))

    def _grip(self, setup: GripSetup) -> Grip:
        names = list(self._stand_ins(setup.lies))
        scene, robot = self._scene, self._scene.hand
        robot.settings = dataclasses.replace(self._settings, speed=setup.speed)
        self._lay(names, setup.lies, setup.tool)
        return try_grip(scene, names)

    def _rest(self, lies: Lies) -> Rest:
        names = list(self._stand_ins(lies))
        self._lay(names, lies, ALOFT)
        self._scene.set_iterations(self._settings.iterations)
        at_rest = settle(self._scene, names)
        return Rest(tuple(self._scene.frame(name) for name in names), at_rest)

    @property
    def _scene(self) -> GripScene:
        """The simulated table, made when it is first needed."""
        if self._made is None:
            self._made = self._make(self._bodies, self._settings)
        return self._made

    def _lay(self, names: Iterable[str], lies: Lies, tool: Frame) -> None:
        """Put hand and things where they are to be, so that nothing earlier matters."""
        self._scene.hand.put(*ALOFT)
        self._scene.hand.put_fingers(0.0)
        self._scene.hand.drive_fingers(0.0)
        self._scene.clear()
        self._scene.hand.put(*tool)
        self._scene.bring_back({name: frame for name, (_, frame) in zip(names, lies, strict=True)})

    def _stand_ins(self, lies: Lies) -> Iterator[str]:
        """For everything that lies there the first body of the same sort that is not taken yet."""
        free = dict(self._bodies)
        for wanted, _ in lies:
            name = next(name for name, body in free.items() if body == wanted)
            del free[name]
            yield name

    def _all_moved(self, there: Frame, lies: Lies) -> Lies:
        return tuple((body, self._moved(there, frame)) for body, frame in lies)

    def _moved(self, there: Frame, frame: Frame) -> Frame:
        """A frame after a transform, rounded; of the two quaternions of a turn that with a positive start."""
        moved = compose(there, frame)
        position, rotation = rounded(moved, DIGITS, DIGITS)
        first = next(v for v in rotation if v)
        x, y, z, w = (v if first > 0 else -v for v in rotation)
        return Frame(position, (x, y, z, w))

    def _back(self, there: Frame, frames: Iterable[Frame]) -> tuple[Frame, ...]:
        back = inverse(there)
        return tuple(compose(back, frame) for frame in frames)

    def close(self) -> None:
        """Release the simulator."""
        if self._made:
            self._made.close()
            self._made = None
