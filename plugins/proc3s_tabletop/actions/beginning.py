"""What is wrong with a scene to begin from: objects beside the table, in it, or in one another."""

import itertools
from collections.abc import Iterator, Mapping
from contextlib import closing
from typing import Any

from proc3s_tabletop.bullet.contacts import DISTANCE
from proc3s_tabletop.bullet.grip_cache import ALOFT
from proc3s_tabletop.bullet.hand import FloatingHand
from proc3s_tabletop.bullet.simulation import Things
from proc3s_tabletop.constraints import called
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.robot.settings import ReferenceSettings, inside_table

SUNK = 0.001
"""What is deeper than this in something else is pushed out of it, m; shapes have margins."""


def flaws_of(
    objects: Mapping[str, Any], bodies: Mapping[str, Body], frames: Mapping[str, Frame]
) -> list[str]:
    """A sentence for every object, and for every pair, that cannot be where it is."""
    flaws = [
        f"{called(objects, name)} lies outside the bounds of the table, by {-1000 * inside:.0f} mm"
        for name, frame in frames.items()
        if (inside := inside_table(*frame.position[:2])) < 0
    ]
    with closing(Things(bodies, ReferenceSettings(), FloatingHand)) as things:
        things.robot.put(*ALOFT)  # type: ignore[attr-defined]
        things.bring_back(frames)
        for one, other, depth in _overlaps(things):
            what, where = called(objects, one), called(objects, other)
            flaws.append(f"{what} is {1000 * depth:.0f} mm deep in {where}")
    return flaws


def _overlaps(things: Things) -> Iterator[tuple[str, str, float]]:
    """Pairs of names, and how deep they are in one another, m."""
    for one, other in itertools.combinations(things.names, 2):
        points = things.client.getClosestPoints(one, other, 0.0)
        depth = max((-float(point[DISTANCE]) for point in points), default=0.0)
        if depth > SUNK:
            yield things.names[one], things.names[other], depth
