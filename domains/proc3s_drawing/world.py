"""The canvas: pymunk says which obstacles a line touches, and by how much it clears them."""

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from proc3s import FloatArray, Margin, Plan, State, Transition, World

CANVAS_SIZE = 100.0
CLEARANCE = 1.0
"""The pen keeps this far from an obstacle, canvas units."""


@dataclass(frozen=True)
class Stroke:
    """What drawing one line measured, canvas units: the obstacle it comes nearest to, negative if it touches.

    `obstacle` is None on a canvas without obstacles.
    """

    clearance: float
    obstacle: str | None


class Canvas(World[Stroke]):
    """A static pymunk space of inflated discs; drawing a line is a query in it."""

    measures = Stroke

    def place(self, state: State) -> None:
        """Build the space of the obstacles, unless it is there: nothing in it ever moves."""
        previous = self.state
        super().place(state)
        if previous is None or previous.obstacles != self.state.obstacles:
            self._build()

    def _build(self) -> None:
        import pymunk  # here: `proc3s show` imports this module to list what may be chosen

        self._space, self._everything = pymunk.Space(), pymunk.ShapeFilter()
        body = self._space.static_body
        for obstacle in self.state.obstacles:
            centre = (obstacle.x_pos, obstacle.y_pos)
            self._space.add(pymunk.Circle(body, obstacle.radius + CLEARANCE, centre))
        self._discs = list(self._space.shapes)
        self._centres = np.array([[o.x_pos, o.y_pos] for o in self.state.obstacles]).reshape(-1, 2)
        self._radii = np.array([o.radius + CLEARANCE for o in self.state.obstacles])

    def draw(self, p1: tuple[float, float], p2: tuple[float, float]) -> Stroke:
        """Put a line on the canvas, whether it touches an obstacle or not."""
        make_line: Any = self.domain.states.types["DrawnLine"]
        line = make_line(*p1, *p2)
        lines = (*self.state.drawn_lines, line)
        self.state = dataclasses.replace(self.state, drawn_lines=lines)
        if not self._discs:
            return Stroke(np.inf, None)
        # A query with a radius misses grazing hits: the discs are inflated instead.
        hits = self._space.segment_query(p1, p2, 0.0, self._everything)
        touched = {id(hit.shape) for hit in hits}
        distance = np.abs(_distances(self._centres, p1, p2) - self._radii)
        signed = np.where([id(disc) in touched for disc in self._discs], -distance, distance)
        nearest = int(np.argmin(signed))
        return Stroke(float(signed[nearest]), self.state.obstacles[nearest].name)

    def render(self, plan: Plan, path: Path) -> None:
        """A picture of the canvas, later lines darker."""
        self._draw(path)

    def film(self) -> list[list[dict[str, float]]]:
        """The lines in the end: the picture has them all, one after the other."""
        return [[dataclasses.asdict(line) for line in self.state.drawn_lines]]

    def render_film(self, initial: State, frames: Mapping[Path, Any]) -> None:
        """Draw lines on the canvas."""
        make_line: Any = self.domain.states.types["DrawnLine"]
        self.state = initial
        for path, lines in frames.items():
            drawn = tuple(make_line(**line) for line in lines)
            self.state = dataclasses.replace(self.state, drawn_lines=drawn)
            self._draw(path)

    def render_marked(self, plan: Plan, path: Path, marked: Sequence[str]) -> None:
        """The same, obstacles that are marked with a red rim, and the last line red."""
        self._draw(path, marked, "red" if plan else "black")

    def _draw(self, path: Path, marked: Sequence[str] = (), last: str = "black") -> None:
        from proc3s_drawing.picture import Picture

        picture = Picture(CANVAS_SIZE)
        for o in self.state.obstacles:
            picture.disc((o.x_pos, o.y_pos), o.radius, o.color, "red" if o.name in marked else None)
            picture.name((o.x_pos, o.y_pos), o.name)
        lines = self.state.drawn_lines
        for n, line in enumerate(lines, start=1):
            shade = round(255 * 0.5 * (1 - n / len(lines)))
            color = last if n == len(lines) else (shade, shade, shade)
            picture.line((line.p1_x, line.p1_y), (line.p2_x, line.p2_y), color)
        picture.save(path)


def _distances(centres: FloatArray, p1: tuple[float, float], p2: tuple[float, float]) -> FloatArray:
    """Distances of points, shape (n, 2), from a segment that may be a point."""
    start, along = np.array(p1), np.subtract(p2, p1)
    length2 = float(along @ along)
    t = np.clip((centres - start) @ along / length2, 0, 1) if length2 > 0 else np.zeros(len(centres))
    distances: FloatArray = np.linalg.norm(centres - start - t[:, None] * along, axis=1)
    return distances


def draw_line(world: Canvas, p1_x: float, p1_y: float, p2_x: float, p2_y: float) -> Stroke:
    """The skill: a straight line between two points, canvas units."""
    return world.draw((p1_x, p1_y), (p2_x, p2_y))


def inside(transition: Transition[Stroke]) -> Margin:
    """Distance of the end points from the border, canvas units."""
    p1_x, p1_y, p2_x, p2_y = (float(value) for value in transition.action.args)  # type: ignore[arg-type]
    by_axis = {
        axis: min(*values, *(CANVAS_SIZE - v for v in values))
        for axis, values in {"x": (p1_x, p2_x), "y": (p1_y, p2_y)}.items()
    }
    axis = min(by_axis, key=lambda name: by_axis[name])
    return Margin(by_axis[axis], {"axis": axis})


def clear_of_obstacles(transition: Transition[Stroke]) -> Margin | None:
    """Clearance from the nearest obstacle beyond the distance the pen keeps, canvas units."""
    stroke = transition.telemetry
    return Margin(stroke.clearance, {"obstacle": stroke.obstacle}) if stroke.obstacle else None
