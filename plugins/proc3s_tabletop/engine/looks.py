"""How a table-top looks in every engine: the camera, the light, and the colours that names stand for."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from proc3s_tabletop.engine.snapshot import Snapshot

if TYPE_CHECKING:
    from PIL.Image import Image

Color: TypeAlias = tuple[float, float, float, float]

SIZE = (480, 360)
"""Of a picture, pixels."""

EYE, AIM = (0.36, -1.56, 0.90), (0.0, -0.44, 0.06)
"""The camera and what it looks at, metres: over the far edge of the table, towards the robot."""
VIEW_ANGLE = 36.0
"""Upwards, degrees."""
LIGHT, LIGHT_DISTANCE = (0.4, -0.9, 2.4), 5.0
"""Where the light comes from, and how far away it is, m: nearer, it leaves half of the table in the dark."""
SKY, GROUND = (236, 240, 245), (205, 212, 220)
"""The background at the top and at the bottom, RGB."""
AMBIENT, DIFFUSE = 0.6, 0.5
"""Shares of the light that comes from everywhere, and from the lamp."""

WOOD = (0.80, 0.71, 0.58, 1.0)
THICKNESS = 0.04
"""Of the top of the table, m."""
UNKNOWN = (0.6, 0.6, 0.6, 1.0)
"""For a colour that nobody knows."""


def color_of(name: str) -> Color:
    """RGBA of a colour by its name; pure colours are toned down where matplotlib has a softer one."""
    from matplotlib.colors import is_color_like, to_rgba

    candidates = ["gold"] if name == "yellow" else [f"tab:{name}", name]
    return next((to_rgba(candidate) for candidate in candidates if is_color_like(candidate)), UNKNOWN)


def background(height: int) -> Any:
    """A column of pixels, (height, 1, 3)."""
    return np.linspace(SKY, GROUND, height).astype(np.uint8)[:, None]


def save(film: Sequence[Snapshot], picture: Callable[[Snapshot], "Image"], path: Path) -> None:
    """Write the last snapshot to `path`, and every one beside it with `-step0`, `-step1`, ... to its name."""
    for step, snapshot in enumerate(film):
        drawn = picture(snapshot)
        drawn.save(path.with_name(f"{path.stem}-step{step}.png"))
        if step == len(film) - 1:
            drawn.save(path)
