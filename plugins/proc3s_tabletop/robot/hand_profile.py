"""The hand from below, as upright columns that lie inside it: what it meets on its way straight down."""

from dataclasses import dataclass

import numpy as np

from proc3s import FloatArray

GAPS = (0.0, 0.020, 0.040, 0.052, 0.064, 0.086)
"""Distances of the pads, m."""
WIDEST = 0.080
"""What is wider between the pads is not grasped: it leaves the open fingers no 3 mm each, m (measured)."""


@dataclass(frozen=True, eq=False)
class HandProfile:
    """The columns of a model of the hand, measured by rays from below (the tests repeat it)."""

    bottoms: tuple[float, ...]
    """Lower end of the pads above the grasp point at GAPS, m: they rise as the fingers open."""
    finger: FloatArray
    """Columns (k, 4) of a finger: from and to, away from the face of its pad; half the width across; lower
    end above that of the pad, m. They hold at every distance."""
    palm: FloatArray
    """The same for the palm: along the closing direction from the middle, half the width, lower end above
    the grasp point."""

    def columns(self, gap: float) -> FloatArray:
        """All columns of a hand whose pads are `gap` apart, shape (k, 4), metres: from and to along the
        closing direction, half the width across it, lower end above the grasp point."""
        bottom = float(np.interp(gap, GAPS, self.bottoms))
        right = self.finger + np.array([gap / 2, gap / 2, 0.0, bottom])
        left = right[:, [1, 0, 2, 3]] * np.array([-1, -1, 1, 1])
        return np.vstack([right, left, self.palm])


AIRO = HandProfile(
    bottoms=(-0.0175, -0.0175, -0.0158, -0.0139, -0.0111, -0.0036),
    finger=np.array(
        [
            (0.000, 0.0063, 0.0105, 0.0000),
            (0.006, 0.0130, 0.0070, 0.0060),
            (0.013, 0.0180, 0.0070, 0.0192),
            (0.018, 0.0240, 0.0070, 0.0322),
            (0.024, 0.0290, 0.0070, 0.0435),
            (0.023, 0.0290, 0.0130, 0.0470),
        ]
    ),
    palm=np.array([(-0.016, 0.016, 0.0105, 0.0555)]),
)
"""The model of airo-models."""
