"""How far bodies are from one another: a look at spheres around them first, and at their geoms then."""

from collections.abc import Iterable

import mujoco
import numpy as np

from proc3s import FloatArray
from proc3s_mujoco.parts import Indices, Thing
from proc3s_mujoco.simulation import TableScene
from proc3s_mujoco.specs import TABLE
from proc3s_tabletop.engine.values import ANY
from proc3s_tabletop.telemetry import Clearance

_SAME = 1e-9
"""Points nearer than this are one, and in no direction from one another, m."""
_TOUCHING = 0.001
"""Bodies nearer than this hold one another, m."""


def distance(
    scene: TableScene, one: Indices, other: Indices, most: float, steepest: float = ANY
) -> tuple[float, int] | None:
    """The smallest distance of geoms (n,) to geoms (m,), and the geom of the first that has it.

    Negative where they overlap; None where it is `most` or more, metres. Distances whose direction has an
    upward part of more than `steepest` are passed over.
    """
    least = _at_least(scene, one, other)
    found: tuple[float, int] | None = None
    model, data, ends = scene.state.model, scene.state.data, np.zeros(6)
    for k in np.argsort(least, axis=None, kind="stable").tolist():
        if least.flat[k] >= most:
            break
        a, b = int(one[k // len(other)]), int(other[k % len(other)])
        apart = mujoco.mj_geomDistance(model, data, a, b, max(most, 0.0) + 1e-6, ends)
        if apart < most and abs(ends[5] - ends[2]) <= steepest * max(abs(apart), _SAME):
            most, found = apart, (apart, a)
    return found


def _at_least(scene: TableScene, one: Indices, other: Indices) -> FloatArray:
    """Distances (n, m) of the spheres around geoms; the table begins at z = 0."""
    model, data = scene.state.model, scene.state.placed()
    if len(other) == 1 and other[0] == scene.parts.table:
        lowest: FloatArray = data.geom_xpos[one, 2:] - model.geom_rbound[one, None]
        return lowest
    apart = np.linalg.norm(data.geom_xpos[one, None] - data.geom_xpos[other], axis=2)
    spheres: FloatArray = apart - model.geom_rbound[one, None] - model.geom_rbound[other]
    return spheres


def _close(scene: TableScene, one: str, other: str, most: float) -> bool:
    """Whether two objects are nearer than `most`, metres."""
    a, b = scene.parts.things[one], scene.parts.things[other]
    return _spheres(scene, a, b) < most and distance(scene, a.geoms, b.geoms, most) is not None


def _spheres(scene: TableScene, one: Thing, other: Thing) -> float:
    """The distance of the spheres around two objects, metres."""
    here, there = (scene.state.data.qpos[thing.position][:3] for thing in (one, other))
    return float(np.linalg.norm(here - there)) - one.radius - other.radius


def near(scene: TableScene, name: str, distance: float) -> list[str]:
    """The other objects that are this close to one, metres."""
    return [other for other in scene.shapes if other != name and _close(scene, name, other, distance)]


def company(scene: TableScene, names: Iterable[str]) -> set[str]:
    """The objects among `names`, and all that touch them, directly or through others."""
    found: set[str] = set()
    todo = [name for name in names if name in scene.shapes]
    while todo:
        name = todo.pop()
        if name not in found:
            found.add(name)
            todo += [other for other in near(scene, name, _TOUCHING) if other not in found]
    return found


def hand_clearances(
    scene: TableScene, gripped: str | None = None, steepest: float = ANY
) -> dict[str, Clearance]:
    """The smallest distance of the robot to everything near but the gripped object, by name.

    Directions with an upward part of more than `steepest` do not count.
    """
    parts, most = scene.parts, scene.settings.near
    geoms = {name: thing.geoms for name, thing in parts.things.items()} | {TABLE: np.array([parts.table])}
    found = {
        name: distance(scene, parts.robot, theirs, most, steepest)
        for name, theirs in geoms.items()
        if name != gripped
    }
    return {name: Clearance(hit[0], parts.part[hit[1]], name) for name, hit in found.items() if hit}


def beside(scene: TableScene, name: str, other: str, most: float) -> float | None:
    """The smallest distance of two objects of which one is beside the other, if it is less than `most`, m."""
    a, b = scene.parts.things[name], scene.parts.things[other]
    if _spheres(scene, a, b) >= most:
        return None
    found = distance(scene, a.geoms, b.geoms, most, steepest=scene.settings.supporting)
    return found and found[0]
