"""What is wrong with a scene to begin from: objects beside the table, in it, or in one another."""

import itertools
from collections.abc import Iterator, Mapping
from contextlib import closing
from typing import Any

from proc3s_tabletop.engine import choice
from proc3s_tabletop.engine.protocol import HandSimulation
from proc3s_tabletop.engine.values import ALOFT
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.robot.settings import inside_table
from proc3s_tabletop.sentences import called, deep_in, out_of_bounds
from proc3s_tabletop.telemetry import TABLE

SUNK = 0.001
"""What is deeper than this in something else is pushed out of it, m; shapes have margins."""


def flaws_of(
    objects: Mapping[str, Any],
    bodies: Mapping[str, Body],
    frames: Mapping[str, Frame],
    engine: str | None = None,
) -> list[str]:
    """A sentence for every object, and for every pair, that cannot be where it is."""
    flaws = [
        f"{out_of_bounds(called(objects, name))}, by {-1000 * inside:.0f} mm"
        for name, frame in frames.items()
        if (inside := inside_table(*frame.position[:2])) < 0
    ]
    made = choice.engine(engine)
    with closing(made.hand_scene(bodies, made.settings())) as scene:
        scene.hand.put(*ALOFT)
        scene.bring_back(frames)
        for one, other, depth in _overlaps(scene):
            flaws.append(deep_in(called(objects, one), called(objects, other), depth))
    return flaws


def _overlaps(scene: HandSimulation) -> Iterator[tuple[str, str, float]]:
    """Pairs of names, and how deep they are in one another, m."""
    for one, other in itertools.combinations((*scene.names, TABLE), 2):
        if (depth := scene.depth(one, other)) > SUNK:
            yield one, other, depth
