"""A judge that lets time pass: what rests on what, and whether it stays."""

import math
from collections.abc import Mapping
from typing import Any

from proc3s import Plan, Score
from proc3s_tabletop.catalogue.body_specs import bodies_of
from proc3s_tabletop.engine.choice import engine
from proc3s_tabletop.engine.protocol import HandSimulation
from proc3s_tabletop.engine.values import ALOFT
from proc3s_tabletop.robot import frames as poses
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.robot.settings import LEVER
from proc3s_tabletop.tasks.final_table import FinalTable
from proc3s_tabletop.tasks.resting import stands
from proc3s_tabletop.tasks.selection import select, selector
from proc3s_tabletop.tasks.verdicts import Finding, measured
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
    counts 40 mm a rad) and then touch the other and not the table. The margin is what it may still move or,
    where that is less, how far it may be shifted until it tips over, m.
    """
    known = bodies_of(bodies)
    objects: Mapping[str, Any] = state.objects
    table = FinalTable(state, bodies)
    upper = select(objects, selector(what, "on_another.what"))
    lower = select(objects, selector(below, "on_another.below"))
    high = [name for name in upper if table.named(name).extent.bottom > LOW]
    if not high:
        return Score(False, "everything lies on the table")
    named = {name: known[o.category] for name, o in objects.items()}
    scene = engine().hand_scene(named, engine().settings())
    try:
        before = {name: poses.frame(o.pose) for name, o in objects.items()}
        _let_go(scene, before, seconds)
        found = [_finding(scene, table, name, before[name], [*lower], most) for name in high]
    finally:
        scene.close()
    margin = measured(max(finding.margin for finding, _ in found))
    good = next((says for finding, says in found if finding.margin >= 0), None)
    return Score(good is not None, good or "; ".join(finding.fault for finding, _ in found), margin)


def _let_go(scene: HandSimulation, frames: Mapping[str, Frame], seconds: float) -> None:
    scene.hand.put(*ALOFT)
    scene.clear()
    scene.bring_back(frames)
    scene.set_iterations(scene.settings.iterations)
    scene.tick(round(seconds / scene.settings.tick))


def _finding(
    scene: HandSimulation, table: FinalTable, name: str, before: Frame, lower: list[str], most: float
) -> tuple[Finding, str]:
    """How far an object is from not resting on another, and on which it rests."""
    solid, touched = table.named(name), scene.touched(name)
    moved = displacement(name, before, scene.frame(name))
    way = moved.shift + LEVER * moved.turned
    found = [table.named(other).says for other in lower if other in touched]
    if way > most:
        return Finding(most - way, f"{solid.says} moves by {1000 * way:.0f} mm when it is let go"), ""
    if TABLE in touched:
        return Finding(-math.inf, f"{solid.says} touches the table"), ""
    if not found:
        return Finding(-math.inf, f"{solid.says} rests on nothing"), ""
    return Finding(
        min(most - way, stands(solid, table.others(solid), LOW))
    ), f"{solid.says} rests on {found[0]}"
