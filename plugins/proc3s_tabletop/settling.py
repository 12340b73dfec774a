"""Letting the scene come to rest, and how far everything moved."""

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from proc3s_tabletop.attempt import Attempt
from proc3s_tabletop.recipe import TABLE_BOUNDS
from proc3s_tabletop.scene import Snapshot
from proc3s_tabletop.telemetry import Bound, displacement
from proc3s_tabletop.things import Frame, Things

if TYPE_CHECKING:
    from proc3s_tabletop.workbench import Workbench


def settle(things: Things, names: Sequence[str]) -> bool:
    """Let time pass until these objects are still at two looks in a row; False if the time is up before."""
    recipe = things.recipe
    things.tick(recipe.settle_first)
    ticks, looks = recipe.settle_first, int(still(things, names))
    while looks < 2 and ticks < recipe.settle_most:
        things.tick(recipe.settle_look)
        ticks += recipe.settle_look
        looks = looks + 1 if still(things, names) else 0
    return looks == 2


def still(things: Things, names: Iterable[str]) -> bool:
    """Whether none of these objects moves."""
    recipe = things.recipe
    speeds = (things.speeds(name) for name in names)
    return all(v <= recipe.still_speed and w <= recipe.still_turn for v, w in speeds)


def rest(attempt: Attempt, bench: "Workbench", names: Sequence[str]) -> None:
    """Let objects come to rest, if there are any; all others are at rest."""
    scene = attempt.scene
    found = bench.rest(scene.lies(names)) if names else None
    if found:
        scene.bring_back(dict(zip(names, found.frames, strict=True)))
    attempt.note(at_rest=found is None or found.at_rest)


def compare(
    attempt: Attempt, baseline: Mapping[str, Frame], released: str | None = None, drop: float = 0.0
) -> None:
    """Note how far every object that is not in hand moved; the one released was to fall by `drop`."""
    scene = attempt.scene
    moved = tuple(
        displacement(name, before, scene.frame(name), drop if name == released else 0.0)
        for name, before in baseline.items()
        if not scene.held or name != scene.held.name
    )
    tilted = attempt.recipe.knocked_over
    over = tuple(d.name for d in moved if d.leaned > tilted and d.name != released)
    attempt.note(displacements=moved, knocked_over=over)


def note_bounds(attempt: Attempt, snapshot: Snapshot, x: float, y: float) -> None:
    """Note what is nearest to the edge of the table, or furthest over it, once the action is over."""
    positions = {"target": (x, y)}
    positions |= {name: frame.position[:2] for name, frame in snapshot.loose().items()}
    inside = {name: inside_table(*position) for name, position in positions.items()}
    name = min(inside, key=lambda n: inside[n])
    attempt.note(bounds=Bound(inside[name], name))


def inside_table(x: float, y: float) -> float:
    """Signed distance of a point to the nearest edge of the table."""
    (x0, x1), (y0, y1) = TABLE_BOUNDS
    return min(x - x0, x1 - x, y - y0, y1 - y)
