"""A table that picks and places happen on: a scene, and the snapshot that the next action starts from."""

import dataclasses
from abc import ABC, abstractmethod
from collections.abc import Mapping

import numpy as np

from proc3s import FloatArray
from proc3s.domain.transforms import matrices
from proc3s_tabletop.engine import choice
from proc3s_tabletop.engine.protocol import Simulation
from proc3s_tabletop.engine.snapshot import Snapshot
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot import frames as poses
from proc3s_tabletop.robot.frames import Frame, compose, inverse
from proc3s_tabletop.robot.grasp_frames import top_down
from proc3s_tabletop.robot.settings import LEVER, TOP_DOWN_YAW, ReferenceSettings
from proc3s_tabletop.telemetry import Telemetry


class Table(ABC):
    """Carries out picks and places among named bodies, each a function of the snapshot it starts from.

    How, a subclass says; `engine` is the name of the engine that simulates it. Close it after use.
    """

    def __init__(
        self,
        bodies: Mapping[str, Body],
        frames: Mapping[str, Frame],
        settings: ReferenceSettings | None = None,
        engine: str | None = None,
    ) -> None:
        made = choice.engine(engine)
        self.scene: Simulation = made.scene(bodies, settings or made.settings())
        self.attempts = 0
        """Picks and places that were attempted, up to now."""
        self.put(frames)

    def put(self, frames: Mapping[str, Frame], believed: Mapping[str, Frame] | None = None) -> None:
        """Start again, empty-handed, with every body at its frame.

        `believed` has the frames in which the arm believes them to be, where they are others.
        """
        errors = {name: compose(inverse(frames[name]), seen) for name, seen in (believed or {}).items()}
        stands = tuple((name, frames[name]) for name in self.scene.names)
        self.snapshot = Snapshot(stands, believed=tuple(sorted(errors.items())))

    def set_speed(self, speed: float) -> None:
        """Scale the speed of arm and fingers."""
        settings = dataclasses.replace(self.scene.settings, speed=speed)
        self.scene.settings = self.scene.robot.settings = settings

    @abstractmethod
    def pick_at(self, grasp: FloatArray) -> Telemetry:
        """Come down to a pose (4, 4) of the grasp point from above, grasp, and lift by the hover."""

    @abstractmethod
    def place_at(self, grasp: FloatArray) -> Telemetry:
        """Come down to a pose (4, 4) of the grasp point from above, set down what is held, and leave.

        The descent ends at the support, at the latest a little below z; over nothing the object drops from z.
        """

    def pick(self, x: float, y: float, z: float) -> Telemetry:
        """Grasp from above, fingers open along y, the grasp point at x, y, z (metres)."""
        return self.pick_at(top_down(x, y, z))

    def place(self, x: float, y: float, z: float, turn: float = 0.0) -> Telemetry:
        """Set down what is held with the grasp point over x, y (metres), where it meets its support.

        The hand is turned about z by `turn` (rad) from where it was in the pick.
        """
        return self.place_at(top_down(x, y, z, TOP_DOWN_YAW + turn))

    def pick_object(self, name: str, grasp: FloatArray) -> Telemetry:
        """Grasp an object by a pose (6,) of the grasp point in its frame, where it is believed to be now."""
        here = np.array([*poses.numbers(self.snapshot.seen(name)).values()])
        telemetry = self.pick_at(matrices(here) @ matrices(grasp))
        if telemetry.held is not None and not telemetry.ended:
            self.snapshot = dataclasses.replace(self.snapshot, grasp=tuple(grasp.tolist()))
        return dataclasses.replace(telemetry, wanted=name)

    def place_object(self, name: str, grasp: FloatArray, pose: FloatArray) -> Telemetry:
        """Bring an object that is held by a grasp (6,) to a pose (6,) of the world."""
        apart = self._apart(grasp)
        if refused := self._refusal(name, apart):
            self.attempts += 1
            return refused
        telemetry = self.place_at(matrices(pose) @ matrices(grasp))
        return dataclasses.replace(telemetry, wanted=name, grasp_apart=apart)

    def _apart(self, grasp: FloatArray) -> float | None:
        """How far a grasp is from that of the last pick, as `grasp_apart` has it."""
        if not self.snapshot.held or not self.snapshot.grasp:
            return None
        difference = np.linalg.inv(matrices(np.array(self.snapshot.grasp))) @ matrices(grasp)
        turned = np.arccos(np.clip((np.trace(difference[:3, :3]) - 1) / 2, -1.0, 1.0))
        return float(np.linalg.norm(difference[:3, 3]) + LEVER * turned)

    def _refusal(self, name: str, apart: float | None) -> Telemetry | None:
        """What is measured instead of a place that must not begin; here anything may be tried."""
        return None

    def close(self) -> None:
        """Release the simulator."""
        self.scene.close()
