"""What rests on, leans over, touches and is in what, as margins in metres: negative where it is not so.

A margin is how far one object may be shifted on the level. Heights are right or wrong: they count only where
they are wrong, as no shift on the level makes them so.
"""

import math
from collections.abc import Iterable

import numpy as np

from proc3s_tabletop.objects.extents import common, gap, hull, inside
from proc3s_tabletop.tasks.final_table import Solid

OVERLAP = 0.001
"""Two outlines must overlap by this much for one object to rest on the other, m."""


def rests(solid: Solid, below: Solid, tolerance: float) -> float:
    """How much more than it must an object overlaps another whose top its lowest point meets."""
    height = tolerance - abs(solid.extent.bottom - below.extent.top)
    return _at_height(height, _overlap(solid, below))


def bears(other: Solid, solid: Solid, tolerance: float) -> float:
    """The same for an object that holds another up, whose lowest point is somewhere on or in it."""
    bottom, held_by = solid.extent.bottom, other.extent
    height = min(bottom - (held_by.bottom - tolerance), held_by.top + tolerance - bottom)
    return _at_height(height, _overlap(solid, other))


def contains(container: Solid, solid: Solid, depth: float) -> float:
    """How far the middle of an object is inside the opening of an upright one, or, where that is less, how
    much deeper than `depth` below its rim it reaches; minus infinity in one that lies."""
    if not container.extent.upright:
        return -math.inf
    deeper = (container.extent.top - depth) - solid.extent.bottom
    return min(inside(container.extent.outline, solid.x, solid.y), deeper)


def touches(a: Solid, b: Solid, tolerance: float) -> float:
    """How much wider the gap of two objects may get that touch."""
    high = max(a.extent.bottom, b.extent.bottom) - min(a.extent.top, b.extent.top)
    return _at_height(tolerance - high, tolerance - gap(a.extent.outline, b.extent.outline))


def stands(solid: Solid, others: Iterable[Solid], tolerance: float) -> float:
    """How far an object may be shifted until its middle is beside all that it rests on, and it tips over.

    Zero where it is there already: something else keeps the object. Infinite where it rests on none of them.
    """
    shared = [
        common(solid.extent.outline, other.extent.outline)
        for other in others
        if rests(solid, other, tolerance) >= 0
    ]
    if not shared:
        return math.inf
    return max(0.0, inside(hull(np.vstack(shared)), solid.x, solid.y))


def _overlap(a: Solid, b: Solid) -> float:
    return -OVERLAP - gap(a.extent.outline, b.extent.outline)


def _at_height(height: float, level: float) -> float:
    return level if height >= 0 else min(height, level)
