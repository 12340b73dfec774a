"""Judges of final states on the table: each must hold, each says why in words.

A judge sees poses and knows the bodies, no velocities: the worlds look when everything has come to rest.
Objects are chosen by `{name, category, color}`; `count` says how many of them must do what is asked, all by
default. Tolerances are metres and radians; `bodies` as the world has them.
"""

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from proc3s import Plan, Score
from proc3s_tabletop.catalogue.body_specs import bodies_of
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.objects.extents import Extent, covers, extent, gap, strip
from proc3s_tabletop.sentences import called
from proc3s_tabletop.tasks.selection import select, selector

Choice = Mapping[str, Any]

OVERLAP = 0.001
"""Two outlines must overlap by this much for one object to rest on the other, m."""

FEW = 2
"""More objects than this are counted where all is well, not listed."""


@dataclass(frozen=True)
class Solid:
    """An object of the final state: its name for people, where its middle is, and its extent."""

    says: str
    x: float
    y: float
    z: float
    extent: Extent


class FinalTable:
    """All objects of a final state."""

    def __init__(self, state: Any, bodies: Mapping[str, Any] | None) -> None:
        known = bodies_of(bodies)
        self._objects: Mapping[str, Any] = state.objects
        self._solids = {
            name: _solid(called(state.objects, name), o.pose, known[o.category])
            for name, o in state.objects.items()
        }

    def chosen(self, what: Choice | None, where: str) -> list[Solid]:
        """The objects that are meant. Raises SpecError on a choice that cannot be read."""
        return [self._solids[name] for name in select(self._objects, selector(what, where))]

    def others(self, solid: Solid) -> list[Solid]:
        """Everything else."""
        return [other for other in self._solids.values() if other is not solid]


def on(
    state: Any,
    plan: Plan,
    what: Choice,
    below: Choice,
    supports: int = 1,
    most_gap: float | None = None,
    count: int | None = None,
    tolerance: float = 0.003,
    bodies: Mapping[str, Any] | None = None,
) -> Score:
    """Each of `what` rests on at least `supports` of `below`, its lowest point within `tolerance` of their
    tops; the nearest two of those are at most `most_gap` (m) apart."""
    table = FinalTable(state, bodies)
    supporting = table.chosen(below, "on.below")

    def rests(solid: Solid) -> str | None:
        found = [other for other in supporting if other is not solid and _rests(solid, other, tolerance)]
        if len(found) < supports:
            return f"rests on {_listed(found)}, not on {supports} of what it should"
        apart = [gap(a.extent.outline, b.extent.outline) for a, b in itertools.combinations(found, 2)]
        if most_gap is not None and apart and min(apart) > most_gap:
            return f"rests on {_listed(found)} with a gap of {1000 * min(apart):.0f} mm between them"
        return None

    kind = f"on {supports} of {selector(below, 'on.below')}"
    return _verdict(table.chosen(what, "on.what"), selector(what, "on.what"), kind, rests, count)


def in_(
    state: Any,
    plan: Plan,
    what: Choice,
    inside: Choice,
    depth: float = 0.010,
    count: int | None = None,
    bodies: Mapping[str, Any] | None = None,
) -> Score:
    """Each of `what` is in one of the upright `inside`: its middle over the opening, its lowest point at
    least `depth` (m) below the rim."""
    table = FinalTable(state, bodies)
    containers = table.chosen(inside, "in_.inside")

    def contained(solid: Solid) -> str | None:
        if any(_contains(c, solid, depth) for c in containers if c is not solid):
            return None
        if not containers:
            return "has nothing to be in"
        far = min(float(np.hypot(solid.x - c.x, solid.y - c.y)) for c in containers)
        return f"is {1000 * far:.0f} mm from the middle, its lowest point at z = {solid.extent.bottom:.3f}"

    kind = f"in a {selector(inside, 'in_.inside')}"
    return _verdict(table.chosen(what, "in_.what"), selector(what, "in_.what"), kind, contained, count)


def line(
    state: Any,
    plan: Plan,
    what: Choice,
    count: int | None = None,
    width: float = 0.010,
    tolerance: float = 0.003,
    bodies: Mapping[str, Any] | None = None,
) -> Score:
    """`count` of `what` stand upright on the table, nothing on top of them, their middles within `width` (m)
    of one straight line."""
    table = FinalTable(state, bodies)
    chosen = table.chosen(what, "line.what")
    flat = [s for s in chosen if s.extent.upright and abs(s.extent.bottom) <= tolerance]
    flat = [s for s in flat if not any(_rests(other, s, tolerance) for other in table.others(s))]
    wanted = len(chosen) if count is None else count
    name = selector(what, "line.what")
    if len(flat) < max(wanted, 1):
        return Score(False, f"{len(flat)} of {wanted} ({name}) stand on the table with nothing on top")
    middles = np.array([[s.x, s.y] for s in flat])
    off = min(strip(middles[list(some)]) for some in itertools.combinations(range(len(flat)), wanted))
    text = f"{wanted} ({name}) stand within {1000 * off:.1f} mm of one straight line"
    return Score(off <= width, text if off <= width else f"{text}, more than {1000 * width:.0f}")


def within(
    state: Any,
    plan: Plan,
    what: Choice,
    centre: Sequence[float],
    reach: float,
    measure: Literal["axis", "distance"] = "axis",
    count: int | None = None,
    bodies: Mapping[str, Any] | None = None,
) -> Score:
    """The middle of each of `what` is within `reach` (m) of a point x, y (m): along x and along y each
    (`axis`), or as the crow flies (`distance`)."""
    table = FinalTable(state, bodies)

    def near(solid: Solid) -> str | None:
        dx, dy = abs(solid.x - centre[0]), abs(solid.y - centre[1])
        off = max(dx, dy) if measure == "axis" else float(np.hypot(dx, dy))
        return None if off <= reach else f"is {1000 * off:.0f} mm off, more than {1000 * reach:.0f}"

    name = selector(what, "within.what")
    kind = f"within {1000 * reach:.0f} mm of ({centre[0]:g}, {centre[1]:g})"
    return _verdict(table.chosen(what, "within.what"), name, kind, near, count)


def stacked(
    state: Any,
    plan: Plan,
    what: Choice,
    high: int | None = None,
    tolerance: float = 0.003,
    bodies: Mapping[str, Any] | None = None,
) -> Score:
    """`high` of `what`, all by default, stand in one tower, each on the one before."""
    table = FinalTable(state, bodies)
    chosen = table.chosen(what, "stacked.what")
    wanted = len(chosen) if high is None else high
    above = [[k for k, t in enumerate(chosen) if t is not s and _rests(t, s, tolerance)] for s in chosen]
    tallest = max((_height(above, k) for k in range(len(chosen))), default=0)
    name = selector(what, "stacked.what")
    return Score(tallest >= max(wanted, 1), f"the tallest tower of {name} is {tallest} high, of {wanted}")


def touching(
    state: Any,
    plan: Plan,
    what: Choice,
    tolerance: float = 0.002,
    bodies: Mapping[str, Any] | None = None,
) -> Score:
    """All of `what` hang together: from each to every other over gaps of at most `tolerance` (m)."""
    chosen = FinalTable(state, bodies).chosen(what, "touching.what")
    group, waiting = set(), [0] if chosen else []
    while waiting:
        k = waiting.pop()
        group.add(k)
        waiting += [n for n, s in enumerate(chosen) if n not in group and _touch(chosen[k], s, tolerance)]
    text = f"{len(group)} of {len(chosen)} ({selector(what, 'touching.what')}) hang together"
    loose = [s for k, s in enumerate(chosen) if k not in group]
    return Score(bool(chosen) and not loose, f"{text}; apart: {_listed(loose)}" if loose else text)


def upright(
    state: Any,
    plan: Plan,
    what: Choice | None = None,
    most: float = 0.10,
    count: int | None = None,
    bodies: Mapping[str, Any] | None = None,
) -> Score:
    """Each of `what`, everything by default, leans by at most `most` (rad)."""

    def stands(solid: Solid) -> str | None:
        lean = solid.extent.lean
        return None if lean <= most else f"leans by {lean:.2f} rad, more than {most:g}"

    chosen = FinalTable(state, bodies).chosen(what, "upright.what")
    return _verdict(chosen, selector(what, "upright.what"), "upright", stands, count)


def still(
    state: Any,
    plan: Plan,
    what: Choice | None = None,
    tolerance: float = 0.003,
    count: int | None = None,
    bodies: Mapping[str, Any] | None = None,
) -> Score:
    """Each of `what`, everything by default, is where a thing at rest can be: its lowest point is on the
    table, or on or in another object, within `tolerance` (m). What hangs in the hand is not."""
    table = FinalTable(state, bodies)

    def rests(solid: Solid) -> str | None:
        bottom = solid.extent.bottom
        if abs(bottom) <= tolerance:
            return None
        held_up = any(_bears(other, solid, tolerance) for other in table.others(solid))
        return None if held_up else f"hangs in the air at z = {bottom:.3f}"

    chosen = table.chosen(what, "still.what")
    return _verdict(chosen, selector(what, "still.what"), "at rest on something", rests, count)


def _solid(says: str, pose: Any, body: Body) -> Solid:
    return Solid(says, pose.x, pose.y, pose.z, extent(body, pose))


def _verdict(
    chosen: Sequence[Solid],
    name: object,
    kind: str,
    fault: Callable[[Solid], str | None],
    count: int | None,
) -> Score:
    """How many of the chosen have no fault, and of the others what it is."""
    wanted = len(chosen) if count is None else count
    faults = [(solid, fault(solid)) for solid in chosen]
    good = [solid for solid, text in faults if text is None]
    if not chosen:
        return Score(False, f"there is no {name}")
    if len(good) >= wanted:
        return Score(True, f"{kind}: {_listed(good) if len(good) <= FEW else f'{len(good)} ({name})'}")
    wrong = "; ".join(f"{solid.says} {text}" for solid, text in faults if text is not None)
    return Score(False, f"{kind}: {len(good)} of {wanted} ({name}): {wrong}")


def _listed(solids: Sequence[Solid]) -> str:
    return ", ".join(solid.says for solid in solids) or "nothing"


def _rests(solid: Solid, below: Solid, tolerance: float) -> bool:
    meets = abs(solid.extent.bottom - below.extent.top) <= tolerance
    return meets and gap(solid.extent.outline, below.extent.outline) <= -OVERLAP


def _bears(other: Solid, solid: Solid, tolerance: float) -> bool:
    """Whether an object's lowest point is somewhere on or in another."""
    high = other.extent.bottom - tolerance <= solid.extent.bottom <= other.extent.top + tolerance
    return high and gap(solid.extent.outline, other.extent.outline) <= -OVERLAP


def _contains(container: Solid, solid: Solid, depth: float) -> bool:
    around = covers(container.extent.outline, solid.x, solid.y)
    return container.extent.upright and around and solid.extent.bottom <= container.extent.top - depth


def _touch(a: Solid, b: Solid, tolerance: float) -> bool:
    high = max(a.extent.bottom, b.extent.bottom) - min(a.extent.top, b.extent.top)
    return max(high, gap(a.extent.outline, b.extent.outline)) <= tolerance


def _height(above: Sequence[Sequence[int]], k: int) -> int:
    return 1 + max((_height(above, n) for n in above[k]), default=0)
