"""Rays between the fingers, by which it is measured how much of the pads an object covers."""

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.engine.protocol import Hand
from proc3s_tabletop.robot.settings import INSIDE


def rays(hand: Hand, left: FloatArray, right: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Where rays between the middles (3,) of two pads start and end, each (n, 3), m.

    They run over the pads' width and along the fingers, from the grasp point.
    """
    settings = hand.settings
    point, along = hand.grasp_point()
    middle = (left + right) / 2
    middle = middle + along * ((point - middle) @ along)
    across = np.cross(along, right - left)
    across /= np.linalg.norm(across)
    half = (left - right) / 2 * INSIDE
    grid = np.array(
        [middle + across * w + along * h for h in settings.cover_along for w in settings.cover_across]
    )
    return grid + half, grid - half
