"""What differs each time a real arm does the same: its speed, and where exactly it goes."""

import numpy as np

SPEED = 0.05
"""Arm and fingers are up to this share faster or slower."""
OFF = 0.0005
"""What is placed comes down up to this far off along x and along y, m, unless a domain says otherwise."""


class Disturbance:
    """One time that a plan is carried out: a speed, and errors of what is placed, drawn uniformly.

    In a `corner` all errors are as large as they get; those of an even corner are opposite to the next one's.
    """

    def __init__(self, rng: np.random.Generator, corner: int | None = None, off: float = OFF) -> None:
        self._rng, self._corner, self._off = rng, corner, off
        self.speed = 1 + SPEED * self._error()

    def off(self, x: float, y: float, z: float) -> tuple[float, float, float]:
        """A point near another, metres, a new one at each call."""
        return x + self._off * self._error(), y + self._off * self._error(), z

    def _error(self) -> float:
        """Between -1 and 1."""
        error = float(self._rng.uniform(-1, 1))
        if self._corner is None:
            return error
        return float(np.sign(error)) * (1.0 if self._corner % 2 == 0 else -1.0)
