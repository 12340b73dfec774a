"""The picture of the house, from the code: its layers as the contract has them, a sentence for each room.

`python docs/hooks/architecture.py` writes docs/images/architecture.svg anew.
"""

import ast
import textwrap
import tomllib
from pathlib import Path
from typing import Any, NamedTuple

import jinja2

ROOT = Path(__file__).parents[2]
PICTURE = ROOT / "docs" / "images" / "architecture.svg"
WIDTH, HEIGHT, GAP = 960, 76, 8
FILLS = ("#eaf1f8", "#f6efe2")
TITLE = "The rooms of proc3s: each imports only from those below it"


class Box(NamedTuple):
    """A room in the picture, in pixels."""

    name: str
    lines: list[str]
    x: float
    y: float
    width: float
    height: int
    fill: str


def layers() -> list[list[str]]:
    """The rooms from the roof down, as the contract in pyproject.toml has them."""
    contracts: list[dict[str, Any]] = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"][
        "importlinter"
    ]["contracts"]
    found = next(contract["layers"] for contract in contracts if contract.get("containers") == ["proc3s"])
    return [[room.strip() for room in layer.split("|")] for layer in found if layer != "__main__"]


def sentence(room: str) -> str:
    """What a room is for: the first line of its docstring."""
    package = ROOT / "src" / "proc3s" / room
    path = package / "__init__.py" if package.is_dir() else package.with_suffix(".py")
    doc = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    return doc.split("\n")[0].replace("`", "")


def svg() -> str:
    """The picture."""
    boxes = [
        _box(room, row, column, len(rooms))
        for row, rooms in enumerate(layers())
        for column, room in enumerate(rooms)
    ]
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent), trim_blocks=True, autoescape=True
    )
    height = GAP + len(layers()) * (HEIGHT + GAP)
    return environment.get_template("architecture.svg.j2").render(
        boxes=boxes, width=WIDTH, height=height, title=TITLE
    )


def _box(room: str, row: int, column: int, rooms: int) -> Box:
    width = (WIDTH - GAP * (rooms + 1)) / rooms
    lines = textwrap.wrap(sentence(room), int(width / 6.9), max_lines=3, placeholder=" …")
    x, y = GAP + column * (width + GAP), GAP + row * (HEIGHT + GAP)
    return Box(room, lines, round(x, 1), y, round(width, 1), HEIGHT, FILLS[row % 2])


if __name__ == "__main__":
    PICTURE.write_text(svg(), encoding="utf-8")
