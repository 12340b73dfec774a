"""What differs each time a real arm does the same: its speed, and where exactly it goes."""

from dataclasses import dataclass

import numpy as np

SPEED = 0.05
"""Arm and fingers are up to this share faster or slower."""
OFF = 0.0005
"""A commanded point is up to this far off along x and along y, m."""


@dataclass(frozen=True)
class Disturbance:
    """One time that a plan is carried out: a speed, and a generator for the errors of its points."""

    speed: float
    rng: np.random.Generator

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> "Disturbance":
        """With a speed that is drawn uniformly."""
        return cls(float(rng.uniform(1 - SPEED, 1 + SPEED)), rng)

    def off(self, x: float, y: float, z: float) -> tuple[float, float, float]:
        """A point near another, metres, a new one at each call."""
        dx, dy = self.rng.uniform(-OFF, OFF, 2).tolist()
        return x + dx, y + dy, z
