"""Judges of final states on the table: each must hold, each says why in words.

A judge sees poses and knows the bodies, no velocities: the worlds look when everything has come to rest.
Objects are chosen by `{name, category, color}`; `count` says how many of them must do what is asked, all by
default. Tolerances are metres and radians; `bodies` as the world has them.

The margin of a score is how far one object may be shifted on the level until the goal is missed, m. Where
things stand level on the right height, heights and leans do not count: no shift changes them.
"""

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np

from proc3s import Plan, Score
from proc3s_tabletop.objects.extents import gap, strip
from proc3s_tabletop.robot.settings import LEVER
from proc3s_tabletop.tasks.final_table import Choice, FinalTable, Solid, listed
from proc3s_tabletop.tasks.resting import bears, contains, rests, stands, touches
from proc3s_tabletop.tasks.selection import selector
from proc3s_tabletop.tasks.verdicts import Finding, measured, nth_largest, verdict

LEVEL = 0.01
"""What leans less stands flat on what is level, rad."""


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

    def resting(solid: Solid) -> Finding:
        overlaps = [(other, rests(solid, other, tolerance)) for other in supporting if other is not solid]
        least = nth_largest((margin for _, margin in overlaps), supports)
        found = [(other, margin) for other, margin in overlaps if margin >= 0]
        names = listed([other for other, _ in found])
        if least < 0:
            return Finding(least, f"rests on {names}, not on {supports} of what it should")
        near, apart = _nearest_two(found, most_gap)
        steady = stands(solid, table.others(solid), tolerance)
        fault = f"rests on {names} with a gap of {1000 * apart:.0f} mm between them" if near < 0 else ""
        return Finding(min(least, near, steady), fault)

    kind = f"on {supports} of {selector(below, 'on.below')}"
    return verdict(table.chosen(what, "on.what"), selector(what, "on.what"), kind, resting, count)


def _nearest_two(found: Sequence[tuple[Solid, float]], most_gap: float | None) -> tuple[float, float]:
    """How much wider the gap of two supports may get, with the margins of both, and the least gap, m."""
    pairs = [
        (gap(a.extent.outline, b.extent.outline), min(margin, other))
        for (a, margin), (b, other) in itertools.combinations(found, 2)
    ]
    if most_gap is None or not pairs:
        return math.inf, 0.0
    return max(min(most_gap - apart, margin) for apart, margin in pairs), min(apart for apart, _ in pairs)


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
    least `depth` (m) below the rim. Both count for the margin."""
    table = FinalTable(state, bodies)
    containers = table.chosen(inside, "in_.inside")

    def contained(solid: Solid) -> Finding:
        if not containers:
            return Finding(-math.inf, "has nothing to be in")
        found = [contains(c, solid, depth) for c in containers if c is not solid]
        far = min(float(np.hypot(solid.x - c.x, solid.y - c.y)) for c in containers)
        where = f"is {1000 * far:.0f} mm from the middle, its lowest point at z = {solid.extent.bottom:.3f}"
        return Finding(max(found, default=-math.inf), where)

    kind = f"in a {selector(inside, 'in_.inside')}"
    return verdict(table.chosen(what, "in_.what"), selector(what, "in_.what"), kind, contained, count)


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
    flat = [s for s in flat if not any(rests(other, s, tolerance) >= 0 for other in table.others(s))]
    wanted = len(chosen) if count is None else count
    name = selector(what, "line.what")
    if len(flat) < max(wanted, 1):
        return Score(False, f"{len(flat)} of {wanted} ({name}) stand on the table with nothing on top")
    middles = np.array([[s.x, s.y] for s in flat])
    off = min(strip(middles[list(some)]) for some in itertools.combinations(range(len(flat)), wanted))
    text = f"{wanted} ({name}) stand within {1000 * off:.1f} mm of one straight line"
    return Score(off <= width, text if off <= width else f"{text}, more than {1000 * width:.0f}", width - off)


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

    def near(solid: Solid) -> Finding:
        dx, dy = abs(solid.x - centre[0]), abs(solid.y - centre[1])
        off = max(dx, dy) if measure == "axis" else float(np.hypot(dx, dy))
        return Finding(reach - off, f"is {1000 * off:.0f} mm off, more than {1000 * reach:.0f}")

    name = selector(what, "within.what")
    kind = f"within {1000 * reach:.0f} mm of ({centre[0]:g}, {centre[1]:g})"
    return verdict(table.chosen(what, "within.what"), name, kind, near, count)


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
    margins = _towers([[_stacks(table, s, t, tolerance) for t in chosen] for s in chosen])
    tallest = sum(margin >= 0 for margin in margins)
    text = f"the tallest tower of {selector(what, 'stacked.what')} is {tallest} high, of {wanted}"
    margin = margins[wanted - 1] if 0 < wanted <= len(margins) else math.inf
    return Score(tallest >= max(wanted, 1), text, measured(margin))


def _stacks(table: FinalTable, below: Solid, solid: Solid, tolerance: float) -> float:
    """How far an object is from falling off another."""
    if solid is below:
        return -math.inf
    margin = rests(solid, below, tolerance)
    return margin if margin < 0 else min(margin, stands(solid, table.others(solid), tolerance))


def _towers(links: Sequence[Sequence[float]]) -> list[float]:
    """The best margins of towers one, two, three... high; `links[k][n]` is that of n on k."""
    best = [math.inf] * len(links)
    found = []
    for _ in links:
        found.append(max(best))
        best = [max(min(link, rest) for link, rest in zip(row, best, strict=True)) for row in links]
    return found


def touching(
    state: Any,
    plan: Plan,
    what: Choice,
    tolerance: float = 0.002,
    bodies: Mapping[str, Any] | None = None,
) -> Score:
    """All of `what` hang together: from each to every other over gaps of at most `tolerance` (m)."""
    chosen = FinalTable(state, bodies).chosen(what, "touching.what")
    group, left, margin = {0} if chosen else set(), set(range(1, len(chosen))), math.inf
    loose: list[Solid] = []
    while left:
        links = {
            (k, n): touches(chosen[k], chosen[n], tolerance) for k in sorted(group) for n in sorted(left)
        }
        widest = max(links, key=lambda link: links[link])
        margin = min(margin, links[widest])
        if margin < 0 and not loose:
            loose = [chosen[n] for n in sorted(left)]
        group.add(widest[1])
        left.remove(widest[1])
    text = f"{len(chosen) - len(loose)} of {len(chosen)} ({selector(what, 'touching.what')}) hang together"
    text = f"{text}; apart: {listed(loose)}" if loose else text
    return Score(bool(chosen) and not loose, text, measured(margin))


def upright(
    state: Any,
    plan: Plan,
    what: Choice | None = None,
    most: float = 0.10,
    count: int | None = None,
    bodies: Mapping[str, Any] | None = None,
) -> Score:
    """Each of `what`, everything by default, leans by at most `most` (rad). For the margin a rad counts
    40 mm; what stands flat has none."""

    def straight(solid: Solid) -> Finding:
        lean, spare = solid.extent.lean, most - solid.extent.lean
        if spare >= 0 and lean < LEVEL:
            return Finding(math.inf)
        return Finding(LEVER * spare, f"leans by {lean:.2f} rad, more than {most:g}")

    chosen = FinalTable(state, bodies).chosen(what, "upright.what")
    return verdict(chosen, selector(what, "upright.what"), "upright", straight, count)


def still(
    state: Any,
    plan: Plan,
    what: Choice | None = None,
    tolerance: float = 0.003,
    count: int | None = None,
    bodies: Mapping[str, Any] | None = None,
) -> Score:
    """Each of `what`, everything by default, is where a thing at rest can be: its lowest point is on the
    table, or on or in another object, within `tolerance` (m). What hangs in the hand is not; what is on the
    table has no margin."""
    table = FinalTable(state, bodies)

    def resting(solid: Solid) -> Finding:
        bottom = solid.extent.bottom
        if abs(bottom) <= tolerance:
            return Finding(math.inf)
        held_up = [bears(other, solid, tolerance) for other in table.others(solid)]
        return Finding(max([tolerance - abs(bottom), *held_up]), f"hangs in the air at z = {bottom:.3f}")

    chosen = table.chosen(what, "still.what")
    return verdict(chosen, selector(what, "still.what"), "at rest on something", resting, count)
