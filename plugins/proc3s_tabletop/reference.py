"""The reference: what accepts plans. It carries actions out and measures; constraints judge."""

import dataclasses
from collections.abc import Callable

from proc3s import FloatArray
from proc3s_tabletop.attempt import Attempt, Stopped
from proc3s_tabletop.grasping import pick
from proc3s_tabletop.motion import top_down
from proc3s_tabletop.placing import place
from proc3s_tabletop.settling import note_bounds
from proc3s_tabletop.table import Table
from proc3s_tabletop.telemetry import Telemetry


class Reference(Table):
    """The arm is kinematic on its way and everything along it is tested for contact.

    Fingers and objects are dynamic. An action that ends early leaves the world as it was.
    """

    def pick(self, x: float, y: float, z: float) -> Telemetry:
        """Grasp and lift; ends early where that fails."""
        return self._carry_out(pick, x, y, z)

    def place(self, x: float, y: float, z: float) -> Telemetry:
        """Set down and leave; ends early where that fails."""
        return self._carry_out(place, x, y, z)

    def _carry_out(
        self, action: Callable[[Attempt, FloatArray], None], x: float, y: float, z: float
    ) -> Telemetry:
        """Run an action from the snapshot; keep where it led to if it came to its end."""
        self.scene.load(self.snapshot)
        attempt = Attempt(self.scene)
        try:
            action(attempt, top_down(x, y, z))
        except Stopped:
            note_bounds(attempt, self.snapshot, x, y)
            return attempt.telemetry
        self.snapshot = self.scene.save()
        note_bounds(attempt, self.snapshot, x, y)
        held = self.snapshot.held
        return dataclasses.replace(attempt.telemetry, held=held.name if held else None)
