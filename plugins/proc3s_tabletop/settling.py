"""Letting the scene come to rest, and how far everything moved."""

from collections.abc import Mapping

from proc3s_tabletop.attempt import Attempt
from proc3s_tabletop.recipe import TABLE_BOUNDS
from proc3s_tabletop.scene import Frame, Scene, Snapshot
from proc3s_tabletop.telemetry import Bound, displacement


def settle(attempt: Attempt) -> None:
    """Let time pass until all objects are still at two looks in a row, or the time is up."""
    recipe, scene = attempt.recipe, attempt.scene
    scene.tick(recipe.settle_first)
    ticks, looks = recipe.settle_first, int(still(scene))
    while looks < 2 and ticks < recipe.settle_most:
        scene.tick(recipe.settle_look)
        ticks += recipe.settle_look
        looks = looks + 1 if still(scene) else 0
    attempt.note(at_rest=looks == 2)


def still(scene: Scene) -> bool:
    """Whether no object that is not in hand moves."""
    recipe = scene.recipe
    speeds = (scene.speeds(name) for name in scene.loose())
    return all(v <= recipe.still_speed and w <= recipe.still_turn for v, w in speeds)


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
    inside = {name: _inside(*position) for name, position in positions.items()}
    name = min(inside, key=lambda n: inside[n])
    attempt.note(bounds=Bound(inside[name], name))


def _inside(x: float, y: float) -> float:
    """Signed distance of a point to the nearest edge of the table."""
    (x0, x1), (y0, y1) = TABLE_BOUNDS
    return min(x - x0, x1 - x, y - y0, y1 - y)
