"""A judge that lets time pass: what rests on what, and whether it stays."""

from collections.abc import Mapping
from typing import Any

from proc3s import Plan, Score
from proc3s_tabletop.catalogue.body_specs import bodies_of
from proc3s_tabletop.engine.choice import engine
from proc3s_tabletop.engine.protocol import HandSimulation
from proc3s_tabletop.engine.values import ALOFT
from proc3s_tabletop.objects.extents import extent
from proc3s_tabletop.robot import frames as poses
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.robot.settings import LEVER
from proc3s_tabletop.sentences import called
from proc3s_tabletop.tasks.selection import select, selector
from proc3s_tabletop.telemetry import TABLE, displacement

LOW = 0.003
"""What reaches nearer to the table than this lies on it, m."""


def on_another(
    state: Any,
    plan: Plan,
    what: Mapping[str, Any] | None = None,
    below: Mapping[str, Any] | None = None,
    seconds: float = 1.0,
    most: float = 0.005,
    bodies: Mapping[str, Any] | None = None,
) -> Score:
    """One of `what` rests on one of `below`, everything by default, and does not touch the table.

    Everything is let go for `seconds` in a simulation; the object must move by at most `most` (m; a turn
    counts 40 mm a rad) and then touch the other and not the table.
    """
    known = bodies_of(bodies)
    objects: Mapping[str, Any] = state.objects
    spaces = {name: extent(known[o.category], o.pose) for name, o in objects.items()}
    upper = select(objects, selector(what, "on_another.what"))
    lower = select(objects, selector(below, "on_another.below"))
    high = [name for name in upper if spaces[name].bottom > LOW]
    if not high:
        return Score(False, "everything lies on the table")
    named = {name: known[o.category] for name, o in objects.items()}
    scene = engine().hand_scene(named, engine().settings())
    try:
        before = {name: poses.frame(o.pose) for name, o in objects.items()}
        _let_go(scene, before, seconds)
        return _first(scene, before, high, [*lower], most, objects)
    finally:
        scene.close()


def _let_go(scene: HandSimulation, frames: Mapping[str, Frame], seconds: float) -> None:
    scene.hand.put(*ALOFT)
    scene.clear()
    scene.bring_back(frames)
    scene.set_iterations(scene.settings.iterations)
    scene.tick(round(seconds / scene.settings.tick))


def _first(
    scene: HandSimulation,
    before: Mapping[str, Frame],
    high: list[str],
    lower: list[str],
    most: float,
    objects: Mapping[str, Any],
) -> Score:
    """The first that rests on another; else what is wrong with each."""
    reasons = []
    for name in high:
        moved = displacement(name, before[name], scene.frame(name))
        way = moved.shift + LEVER * moved.turned
        touched = scene.touched(name)
        on = [other for other in lower if other in touched]
        if way > most:
            reasons.append(f"{called(objects, name)} moves by {1000 * way:.0f} mm when it is let go")
        elif TABLE in touched:
            reasons.append(f"{called(objects, name)} touches the table")
        elif not on:
            reasons.append(f"{called(objects, name)} rests on nothing")
        else:
            return Score(True, f"{called(objects, name)} rests on {called(objects, on[0])}")
    return Score(False, "; ".join(reasons))
