"""The pictures of a run in its folder, and the film that more are drawn from."""

import json
import re
from pathlib import Path
from typing import Any

from proc3s.errors import UsageError

FILM = "film.json"
"""What was carried out, frame by frame, as its world draws it."""
OUTCOME = "plan.png"
"""The world after the last step."""
SCENE, NEAREST_MISS = "scene.png", "nearest_miss.png"
"""Pictures of an unsolved run: where plans begin, and the one that came furthest, at the step that failed."""

_STEP = re.compile(r"plan-step(\d+)\.png")


def step_picture(done: int) -> str:
    """The name of the picture of the world after so many steps."""
    return f"plan-step{done}.png"


def step_pictures(run: Path) -> dict[int, Path]:
    """The pictures of steps that are drawn, in order, by how many steps were done."""
    found = {int(m[1]): path for path in run.glob("plan-step*.png") if (m := _STEP.fullmatch(path.name))}
    return dict(sorted(found.items()))


def pictures_of(run: Path) -> list[Path]:
    """All that are drawn: those of the plan first."""
    return [path for kind in ("plan*.png", NEAREST_MISS, SCENE) for path in sorted(run.glob(kind))]


def read_film(run: Path) -> list[Any]:
    """The frames of a run's film; empty without. Raises UsageError for a file that holds none."""
    try:
        frames = json.loads((run / FILM).read_bytes())
    except FileNotFoundError:
        return []
    except ValueError as error:
        raise UsageError(f"{run / FILM}: not valid JSON: {error}") from error
    if not isinstance(frames, list) or not frames:
        raise UsageError(f"{run / FILM}: not a list of frames")
    return frames


def undrawn(run: Path) -> bool:
    """Whether a film has more than is drawn."""
    frames = len(read_film(run))
    return frames > 0 and (not (run / OUTCOME).is_file() or 1 < frames > len(step_pictures(run)))
