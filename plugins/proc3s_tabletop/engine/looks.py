"""How a table-top looks in every engine: the camera, the light, and the colours that names stand for."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.engine.protocol import Studio
from proc3s_tabletop.engine.snapshot import Snapshot
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.objects.extents import rotation
from proc3s_tabletop.robot.frames import Frame, numbers

if TYPE_CHECKING:
    from PIL.Image import Image

Color: TypeAlias = tuple[float, float, float, float]

SIZE = (480, 360)
"""Of a picture, pixels."""

EYE, AIM = (0.36, -1.58, 0.92), (0.0, -0.45, 0.04)
"""The camera and what it looks at, metres: over the far edge of the table, towards the robot."""
VIEW_ANGLE = 36.0
"""Upwards, degrees."""
LIGHT, LIGHT_DISTANCE = (0.4, -0.9, 2.4), 5.0
"""Where the light comes from, and how far away it is, m: nearer, it leaves half of the table in the dark."""
RED, RIM = (220, 0, 0), 8
"""Of a mark, and how far it is around what it marks, pixels."""
SKY, GROUND = (236, 240, 245), (205, 212, 220)
"""The background at the top and at the bottom, RGB."""
AMBIENT, DIFFUSE = 0.6, 0.5
"""Shares of the light that comes from everywhere, and from the lamp."""

WOOD = (0.80, 0.71, 0.58, 1.0)
THICKNESS = 0.04
"""Of the top of the table, m."""
_SOFT = {
    "blue": "#1f77b4",
    "brown": "#8c564b",
    "cyan": "#17becf",
    "gray": "#7f7f7f",
    "green": "#2ca02c",
    "grey": "#7f7f7f",
    "olive": "#bcbd22",
    "orange": "#ff7f0e",
    "pink": "#e377c2",
    "purple": "#9467bd",
    "red": "#d62728",
    "yellow": "gold",
}
"""Matplotlib's, but for yellow."""
UNKNOWN = (0.6, 0.6, 0.6, 1.0)
"""For a colour that nobody knows."""


def color_of(name: str) -> Color:
    """RGBA of a colour by its name; pure colours are toned down where matplotlib has a softer one."""
    from PIL import ImageColor

    try:
        red, green, blue, *opacity = ImageColor.getrgb(_SOFT.get(name, name))
    except ValueError:
        return _rare(name) if name else UNKNOWN
    return red / 255, green / 255, blue / 255, (opacity or [255])[0] / 255


def _rare(name: str) -> Color:
    """A colour that only matplotlib knows by this name; not asked first, as it takes long to import."""
    from matplotlib.colors import is_color_like, to_rgba

    return to_rgba(name) if is_color_like(name) else UNKNOWN


def background(height: int) -> Any:
    """A column of pixels, (height, 1, 3)."""
    return np.linspace(SKY, GROUND, height).astype(np.uint8)[:, None]


def draw_marked(
    studio: Studio, bodies: Mapping[str, Body], snapshot: Snapshot, path: Path, marked: Sequence[str]
) -> None:
    """Write a snapshot to `path`, with a ring and its name around each body that is marked."""
    picture = studio.picture(snapshot)
    for name, frame in snapshot.frames:
        if name in marked:
            _ring(picture, name, bodies[name].shape.corners(), frame)
    picture.save(path)


def _ring(picture: "Image", name: str, corners: FloatArray, frame: Frame) -> None:
    """An ellipse around corners (n, 3) of a body in its frame, and a name above it."""
    from PIL import ImageDraw

    pose = numbers(frame)
    turn = rotation(pose["roll"], pose["pitch"], pose["yaw"])
    x, y = _seen(corners @ turn.T + frame.position).T
    box = (x.min() - RIM, y.min() - RIM, x.max() + RIM, y.max() + RIM)
    pen = ImageDraw.Draw(picture)
    pen.ellipse(box, outline=RED, width=3)
    pen.text(((box[0] + box[2]) / 2, box[1] - 2), name, RED, anchor="mb", stroke_width=1, stroke_fill="white")


def _seen(points: FloatArray) -> FloatArray:
    """Where points (n, 3) in the world, m, are in a picture, pixels (n, 2)."""
    eye, ahead = np.array(EYE), np.subtract(AIM, EYE)
    ahead = ahead / np.linalg.norm(ahead)
    right = np.cross(ahead, [0, 0, 1])
    right = right / np.linalg.norm(right)
    away = points - eye
    scale = SIZE[1] / 2 / np.tan(np.radians(VIEW_ANGLE) / 2) / (away @ ahead)
    seen: FloatArray = np.stack(
        [SIZE[0] / 2 + scale * (away @ right), SIZE[1] / 2 - scale * (away @ np.cross(right, ahead))], axis=1
    )
    return seen
