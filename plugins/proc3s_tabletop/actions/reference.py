"""The reference: what accepts plans. It carries actions out and measures; constraints judge."""

import dataclasses
import functools
from collections.abc import Callable, Mapping

from proc3s import FloatArray
from proc3s_tabletop.actions.attempt import Attempt, Stopped
from proc3s_tabletop.actions.outcome import note_bounds
from proc3s_tabletop.actions.pick import note_width, pick
from proc3s_tabletop.actions.place import place
from proc3s_tabletop.actions.table import Table
from proc3s_tabletop.engine import choice
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.robot.settings import SAME_GRASP, ReferenceSettings
from proc3s_tabletop.telemetry import Attempted, Telemetry


class Reference(Table):
    """The arm is kinematic on its way and everything along it is tested for contact.

    Fingers and objects are dynamic. An action that ends early leaves the world as it was.
    """

    def __init__(
        self,
        bodies: Mapping[str, Body],
        frames: Mapping[str, Frame],
        settings: ReferenceSettings | None = None,
        engine: str | None = None,
    ) -> None:
        super().__init__(bodies, frames, settings, engine)
        self._grips = choice.engine(engine).grips(bodies, self.scene.settings)

    def pick_at(self, grasp: FloatArray) -> Telemetry:
        """Grasp and lift; ends early where that fails."""
        return self._carry_out("pick", functools.partial(pick, grips=self._grips), grasp)

    def place_at(self, grasp: FloatArray) -> Telemetry:
        """Set down and leave; ends early where that fails."""
        return self._carry_out("place", functools.partial(place, grips=self._grips), grasp)

    def _refusal(self, name: str, apart: float | None) -> Telemetry | None:
        """A place needs that object in hand, by that grasp."""
        held = self.snapshot.held.name if self.snapshot.held else None
        if held is None or (held == name and apart is not None and apart <= SAME_GRASP):
            return None
        return Telemetry("place", ended="hand", target=held, held=held, wanted=name, grasp_apart=apart)

    def _carry_out(
        self, attempted: Attempted, action: Callable[[Attempt, FloatArray], None], grasp: FloatArray
    ) -> Telemetry:
        """Run an action from the snapshot; keep where it led to if it came to its end."""
        x, y = grasp[:2, 3].tolist()
        self.scene.load(self.snapshot)
        attempt = Attempt(self.scene, attempted, grasp)
        self.attempts += 1
        try:
            action(attempt, grasp)
        except Stopped:
            note_width(attempt, grasp)
            note_bounds(attempt, self.snapshot, x, y)
            return attempt.telemetry
        self.snapshot = self.scene.save().after(self.snapshot)
        note_bounds(attempt, self.snapshot, x, y)
        held = self.snapshot.held
        return dataclasses.replace(attempt.telemetry, held=held.name if held else None)

    def close(self) -> None:
        """Release both simulators."""
        self._grips.close()
        super().close()
