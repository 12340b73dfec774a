"""The end of an action: waits for rest, and measures what moved and what left the table."""

from collections.abc import Mapping, Sequence

from proc3s_tabletop.actions.attempt import Attempt
from proc3s_tabletop.engine.protocol import GripSimulation
from proc3s_tabletop.engine.snapshot import Snapshot
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.robot.settings import inside_table
from proc3s_tabletop.telemetry import Bound, displacement


def rest(attempt: Attempt, grips: GripSimulation, names: Sequence[str]) -> None:
    """Let objects come to rest, if there are any; all others are at rest."""
    scene = attempt.scene
    found = grips.rest(scene.lies(names)) if names else None
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
    tilted = attempt.settings.knocked_over
    over = tuple(d.name for d in moved if d.leaned > tilted and d.name != released)
    attempt.note(displacements=moved, knocked_over=over)


def note_bounds(attempt: Attempt, snapshot: Snapshot, x: float, y: float) -> None:
    """Note what is nearest to the edge of the table, or furthest over it, once the action is over."""
    positions = {"target": (x, y)}
    positions |= {name: frame.position[:2] for name, frame in snapshot.loose().items()}
    inside = {name: inside_table(*position) for name, position in positions.items()}
    name = min(inside, key=lambda n: inside[n])
    attempt.note(bounds=Bound(inside[name], name))
