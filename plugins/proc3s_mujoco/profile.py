"""The hand of the published model from below; between its pads and the links behind them there is air."""

import numpy as np

from proc3s_tabletop.robot.hand_profile import HandProfile

MENAGERIE = HandProfile(
    bottoms=(-0.0170, -0.0170, -0.0153, -0.0134, -0.0107, -0.0036),
    finger=np.array(
        [
            (0.000, 0.0063, 0.0105, 0.0005),
            (0.006, 0.0130, 0.0070, 0.0095),
            (0.013, 0.0180, 0.0070, 0.0420),
            (0.018, 0.0240, 0.0070, 0.0445),
            (0.024, 0.0290, 0.0070, 0.0465),
        ]
    ),
    palm=np.array([(-0.016, 0.016, 0.0105, 0.0600)]),
)
"""Measured by rays from below; the tests repeat it."""
