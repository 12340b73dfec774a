"""Scenes: objects scattered over the table, stacked, or at given places, as a flat list in YAML."""

import dataclasses
import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from proc3s import Pose
from proc3s.specs.yaml_files import validate
from proc3s_tabletop.catalogue.body_specs import bodies_of
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.objects.extents import extent, gap
from proc3s_tabletop.objects.shapes import Bowl
from proc3s_tabletop.robot.settings import TABLE_BOUNDS
from proc3s_tabletop.tasks.selection import Selector

SCENES = 200
"""How often a scene is begun again before it is given up."""
DRAWS = 50
"""How many places are drawn for an object before its scene is begun again."""
TOUCHING = 1e-4
"""Objects nearer than this touch, m."""
SINK = 2e-5
"""What stands on something presses into it by this much, m: boxes that only just meet are not in contact."""

Span = tuple[float, float]
Length = Annotated[float, Field(ge=0, allow_inf_nan=False)]


class Entry(BaseModel):
    """`count` objects of a category: scattered, at one place (`at`), or on top of others (`on`)."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)

    category: str
    """A key of `bodies`."""
    color: str | tuple[str, ...] = ""
    """A colour, or several of which each object gets one by chance."""
    count: int = Field(1, ge=1, le=100)
    """How many of them."""
    apart: Length = 0.0
    """Least distance of its centre from that of any other on the table, m, if more than the scene's."""
    within: tuple[Span, Span] | None = None
    """x and y of the region it is scattered over, m; the table less its margin otherwise."""
    at: tuple[float, float] | tuple[float, float, float] | None = None
    """x and y of its centre, m, and z where it stands on something."""
    yaw: float | Literal["any"] = 0.0
    """rad, or `any`: each object is turned by chance."""
    on: Selector | None = None
    """It stands on one of these, drawn from those listed before it that have nothing on top."""
    chance: float = Field(1.0, ge=0, le=1)
    """Of standing on one of those; it is scattered otherwise."""

    @model_validator(mode="after")
    def _one_way(self) -> "Entry":
        if self.at and (self.count > 1 or self.on or self.within):
            raise ValueError("what stands `at` a place is one object, neither scattered nor `on` another")
        if self.within and any(low > high for low, high in self.within):
            raise ValueError("`within` is x and y, each from low to high")
        if self.chance < 1 and not self.on:
            raise ValueError("`chance` is that of standing `on` something")
        return self


@dataclass(frozen=True)
class Rules:
    """What holds for all objects of a scene; lengths in m."""

    bodies: Mapping[str, Body]
    apart: float
    margin: float
    highest: int


@dataclass(frozen=True)
class Placed:
    """An object in a scene under construction: index of what it stands on, and how many stand below it."""

    entry: Entry
    color: str
    x: float
    y: float
    z: float
    yaw: float
    below: int | None = None
    level: int = 0

    @property
    def pose(self) -> Pose:
        """Upright, where it stands."""
        return Pose(self.x, self.y, self.z, yaw=self.yaw)


class _Jammed(Exception):
    """No room for the next object in what there is."""


def scene(
    rng: np.random.Generator,
    objects: Sequence[Mapping[str, Any]],
    apart: float = 0.125,
    margin: float = 0.1,
    highest: int = 3,
    bodies: Mapping[str, Any] | None = None,
) -> dict[str, Any]:
    """Objects object_0, object_1, ... in the order of the entries (see `Entry`), upright and at rest.

    What is scattered lies uniformly within the table less `margin`, centres `apart` (m) or more; stacks
    are at most `highest` objects high. Raises ValueError where no such scene is found.
    """
    rules = Rules(bodies_of(bodies), apart, margin, highest)
    entries = [validate(Entry, given, f"objects.{k}") for k, given in enumerate(objects)]
    if unknown := [e.category for e in entries if e.category not in rules.bodies]:
        raise ValueError(f"there is no body for {unknown[0]!r}; there are {', '.join(sorted(rules.bodies))}")
    singles = [entry for entry in entries for _ in range(entry.count)]
    for _ in range(SCENES):
        try:
            return {"objects": dict(_objects(_placed(rng, singles, rules)))}
        except _Jammed as jammed:
            reason = str(jammed)
    raise ValueError(f"found no such scene in {SCENES} attempts: {reason}")


def _placed(rng: np.random.Generator, entries: Sequence[Entry], rules: Rules) -> list[Placed]:
    placed: list[Placed] = []
    for entry in entries:
        color = entry.color if isinstance(entry.color, str) else str(rng.choice(entry.color))
        placed.append(_place(rng, entry, color, placed, rules))
    _require_room(placed, rules)
    return placed


def _require_room(placed: Sequence[Placed], rules: Rules) -> None:
    """Begin again where two objects touch sideways or sit in one another."""
    spaces = [extent(rules.bodies[p.entry.category], p.pose) for p in placed]
    for (i, a), (k, b) in itertools.combinations(enumerate(spaces), 2):
        upright, sideways = min(a.top, b.top) - max(a.bottom, b.bottom), -gap(a.outline, b.outline)
        if upright > TOUCHING and sideways > -TOUCHING:
            depth = 1000 * max(0.0, min(upright, sideways))
            raise _Jammed(f"object_{i} and object_{k} are in one another's place, by {depth:.0f} mm")


def _place(
    rng: np.random.Generator, entry: Entry, color: str, placed: Sequence[Placed], rules: Rules
) -> Placed:
    standing = rules.bodies[entry.category].height
    yaw = float(rng.uniform(-math.pi, math.pi)) if entry.yaw == "any" else entry.yaw
    if entry.at:
        x, y, *height = entry.at
        return Placed(entry, color, x, y, height[0] if height else standing, yaw)
    if entry.on is not None and rng.uniform() < entry.chance:
        return _stacked(rng, entry, color, yaw, placed, rules)
    for _ in range(DRAWS):
        x, y = rng.uniform(*np.transpose(_region(entry, rules))).tolist()
        if _free(entry, x, y, placed, rules):
            return Placed(entry, color, x, y, standing, yaw)
    raise _Jammed(f"no room for object_{len(placed)} (a {entry.category})")


def _region(entry: Entry, rules: Rules) -> tuple[Span, Span]:
    if entry.within:
        return entry.within
    (x0, x1), (y0, y1) = TABLE_BOUNDS
    m = rules.margin
    return (x0 + m, x1 - m), (y0 + m, y1 - m)


def _free(entry: Entry, x: float, y: float, placed: Sequence[Placed], rules: Rules) -> bool:
    """Whether a place is far enough from everything that stands on the table."""
    return all(
        np.hypot(x - p.x, y - p.y) >= max(rules.apart, entry.apart, p.entry.apart)
        for p in placed
        if p.below is None
    )


def _stacked(
    rng: np.random.Generator, entry: Entry, color: str, yaw: float, placed: Sequence[Placed], rules: Rules
) -> Placed:
    """On top of something that `on` means; without anything left there, the scene is begun again."""
    assert entry.on
    taken = {p.below for p in placed}
    tops = [
        k
        for k, p in enumerate(placed)
        if entry.on.matches(f"object_{k}", p.entry.category, p.color)
        and k not in taken
        and p.level + 1 < rules.highest
        and not isinstance(rules.bodies[p.entry.category].shape, Bowl)
    ]
    if not tops:
        raise _Jammed(f"nothing is left for object_{len(placed)} to stand on ({entry.on})")
    k = int(rng.choice(tops))
    below = placed[k]
    top = below.z + rules.bodies[below.entry.category].top
    z = top + rules.bodies[entry.category].height - SINK
    return Placed(entry, color, below.x, below.y, z, yaw, k, below.level + 1)


def _objects(placed: Sequence[Placed]) -> Iterator[tuple[str, dict[str, Any]]]:
    for k, p in enumerate(placed):
        name, pose = f"object_{k}", dataclasses.asdict(p.pose)
        yield name, {"category": p.entry.category, "color": p.color, "pose": pose, "body": name}
