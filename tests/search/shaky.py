"""A loose plugin file: a walker whose hops may be off, and a screen that is right but says something else."""

import dataclasses

from walk import Walk, no_pit, places

from proc3s import Violation

OFF = 0.5


class Shaky(Walk):
    """Disturbed, every hop ends up to half a metre off."""

    rng = None

    def disturb(self, rng, corner=None):
        self.rng, self.corner = rng, corner

    def step(self, action):
        if self.rng is not None:
            sign = -1 if self.corner % 2 else 1
            off = sign * OFF * (1 if self.rng.uniform() < 0.5 else -1)
            action = dataclasses.replace(action, args=(action.args[0] + off,))
        return super().step(action)


def hindsight(state, batch):
    """Right about which plans fall into a pit, but it blames the last hop, and the end of the line."""
    too_far = [Violation("on_line", len(path) - 1, "hop", -1.0, "went too far") for path in places(batch)]
    falls = [any(no_pit(_Landing(place)).value < 0 for place in path) for path in places(batch)]
    return [violation if pit else None for violation, pit in zip(too_far, falls, strict=True)]


@dataclasses.dataclass
class _Landing:
    telemetry: float
