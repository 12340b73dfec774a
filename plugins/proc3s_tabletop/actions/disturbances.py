"""What differs each time a real arm does the same: its speed, where things stand, and where it puts them."""

from collections.abc import Mapping

import numpy as np

from proc3s.specs.domain import ErrorsSpec
from proc3s_tabletop.actions.misplacement import Offset, off
from proc3s_tabletop.robot.frames import Frame


class Disturbance:
    """One time that a plan is carried out: errors up to those that are to be expected, drawn uniformly.

    In a `corner` all errors are as large as they get; those of an even corner are opposite to the next one's.
    """

    def __init__(
        self, rng: np.random.Generator, corner: int | None = None, errors: ErrorsSpec | None = None
    ) -> None:
        self._rng, self._corner = rng, corner
        self._errors = errors or ErrorsSpec()
        self.speed = 1 + self._errors.speed * self._error()
        """Of arm and fingers, 1 is as always."""

    def placed(self) -> Offset:
        """How far off something comes down, a new offset at each call."""
        return self._offset(self._errors.placed)

    def stands(self, frames: Mapping[str, Frame]) -> dict[str, Frame]:
        """Where objects stand that are believed to stand in these frames, each off by its own draw."""
        return {name: off(frames[name], self._offset(self._errors.picked)) for name in sorted(frames)}

    def _offset(self, most: float) -> Offset:
        return Offset(most * self._error(), most * self._error(), self._errors.turn * self._error())

    def _error(self) -> float:
        """Between -1 and 1."""
        error = float(self._rng.uniform(-1, 1))
        if self._corner is None:
            return error
        return float(np.sign(error)) * (1.0 if self._corner % 2 == 0 else -1.0)
