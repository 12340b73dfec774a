"""Scenes of the Drawing domain."""

import math
from typing import Any

import numpy as np

CANVAS_SIZE = 100.0
COLORS = ("red", "blue", "green", "orange", "purple", "brown", "pink", "gray", "olive", "cyan")
_DRAWS_PER_CIRCLE = 500
_SCENES = 20


def circles(
    rng: np.random.Generator, count: int = 5, smallest: float = 4.0, largest: float = 15.0
) -> dict[str, Any]:
    """A canvas with `count` discs, radius uniform, that touch neither each other nor the border.

    Raises ValueError when no such scene is found: a full scene is begun anew a bounded number of times.
    """
    if count < 0 or not 0 < smallest <= largest < CANVAS_SIZE / 2:
        raise ValueError(f"there are no {count} circles with radius {smallest} to {largest}")
    for _ in range(_SCENES):
        placed = _place(rng, count, smallest, largest)
        if placed is not None:
            return {"obstacles": placed}
    raise ValueError(f"found no room for {count} circles with radius {smallest} to {largest}")


def _place(
    rng: np.random.Generator, count: int, smallest: float, largest: float
) -> list[dict[str, Any]] | None:
    placed: list[dict[str, Any]] = []
    misses = 0
    while len(placed) < count and misses < _DRAWS_PER_CIRCLE:
        radius = rng.uniform(smallest, largest)
        x, y = rng.uniform(0, CANVAS_SIZE, size=2).tolist()
        if _free(placed, x, y, radius):
            index = len(placed)
            color = COLORS[index % len(COLORS)]
            placed.append(
                {"name": f"object_{index}", "x_pos": x, "y_pos": y, "radius": radius, "color": color}
            )
            misses = 0
        else:
            misses += 1
    return placed if len(placed) == count else None


def _free(placed: list[dict[str, Any]], x: float, y: float, radius: float) -> bool:
    if not (radius < x < CANVAS_SIZE - radius and radius < y < CANVAS_SIZE - radius):
        return False
    return all(math.dist((x, y), (c["x_pos"], c["y_pos"])) > radius + c["radius"] for c in placed)
