"""Pictures of the canvas: obstacles, lines, and axes in canvas units.

Pillow draws them, as matplotlib would: to import that takes longer than all else that a run does.
"""

from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from PIL import Image, ImageColor, ImageDraw, ImageFont

SIZE = 600
"""Of a picture, pixels."""
_SMOOTH = 3
"""Drawn so many times larger, and scaled down."""
_LEFT, _TOP, _SIDE = 68, 14, 510
"""Of the frame, pixels."""
_TICKS = range(0, 101, 20)
_TICK, _FRAME, _LINE, _RIM = 6, 1.3, 3.3, 4.2
"""Length of a tick, and widths, pixels."""
_NAME, _LABEL = 12, 17
"""Sizes of letters, pixels."""
_OPACITY = 128

Point = tuple[float, float]


class Picture:
    """A canvas of a side length in its own units; y goes up."""

    def __init__(self, side: float) -> None:
        self._scale = _SIDE / side * _SMOOTH
        self._image = Image.new("RGB", (SIZE * _SMOOTH, SIZE * _SMOOTH), "white")
        self._draw = ImageDraw.Draw(self._image, "RGBA")
        self._texts: list[tuple[Point, str, int, str]] = []

    def disc(self, center: Point, radius: float, color: str, rim: str | None = None) -> None:
        """A translucent disc; a rim is opaque."""
        (x, y), r = self._at(center), radius * self._scale
        self._draw.ellipse((x - r, y - r, x + r, y + r), (*ImageColor.getrgb(color)[:3], _OPACITY))
        if rim:
            self._draw.ellipse((x - r, y - r, x + r, y + r), outline=rim, width=round(_RIM * _SMOOTH))

    def line(self, start: Point, end: Point, color: str | tuple[int, int, int]) -> None:
        """A line with round ends."""
        width = _LINE * _SMOOTH
        self._draw.line([self._at(start), self._at(end)], color, round(width))
        for x, y in (self._at(start), self._at(end)):
            self._draw.ellipse((x - width / 2, y - width / 2, x + width / 2, y + width / 2), color)

    def name(self, center: Point, text: str) -> None:
        """Words around a point, above all else."""
        x, y = self._at(center)
        self._texts.append(((x / _SMOOTH, y / _SMOOTH), text, _NAME, "mm"))

    def save(self, path: Path) -> None:
        """Write it as a PNG file."""
        self._axes()
        image = self._image.resize((SIZE, SIZE), Image.Resampling.BOX)
        draw = ImageDraw.Draw(image)
        for at, text, size, anchor in self._texts:
            draw.text(at, text, "black", _font(size), anchor)
        image.save(path, "PNG")

    def _at(self, point: Point) -> Point:
        x, y = point
        return _LEFT * _SMOOTH + x * self._scale, (_TOP + _SIDE) * _SMOOTH - y * self._scale

    def _axes(self) -> None:
        bottom, right = _TOP + _SIDE, _LEFT + _SIDE
        self._strokes([(_LEFT, _TOP, right, _TOP), (_LEFT, bottom, right, bottom)])
        self._strokes([(_LEFT, _TOP, _LEFT, bottom), (right, _TOP, right, bottom)])
        for tick in _TICKS:
            along = tick / _TICKS[-1] * _SIDE
            self._strokes([(_LEFT + along, bottom, _LEFT + along, bottom + _TICK)])
            self._strokes([(_LEFT - _TICK, bottom - along, _LEFT, bottom - along)])
            self._texts.append(((_LEFT + along, bottom + 10), str(tick), _LABEL, "ma"))
            self._texts.append(((_LEFT - 10, bottom - along), str(tick), _LABEL, "rm"))
        self._texts.append(((_LEFT + _SIDE / 2, bottom + 36), "x", _LABEL, "ma"))
        self._texts.append(((16, _TOP + _SIDE / 2), "y", _LABEL, "mm"))

    def _strokes(self, lines: Sequence[tuple[float, float, float, float]]) -> None:
        for line in lines:
            self._draw.line([pixel * _SMOOTH for pixel in line], "black", round(_FRAME * _SMOOTH))


def _font(size: int) -> Any:
    """The font of matplotlib's pictures."""
    found = find_spec("matplotlib")
    assert found
    assert found.origin
    return ImageFont.truetype(str(Path(found.origin).parent / "mpl-data/fonts/ttf/DejaVuSans.ttf"), size)
