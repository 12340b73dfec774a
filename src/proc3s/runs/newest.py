"""The newest run of a folder: `latest`, a link that every run below `runs` moves to itself when it begins."""

import contextlib
import json
import tempfile
from collections.abc import Iterator
from pathlib import Path

from proc3s.errors import UsageError
from proc3s.runs.reading import LOG

RUNS = Path("runs")
"""Where runs go that are given no other place, below the working directory."""
LATEST = "latest"


def link_latest(run: Path) -> None:
    """Have `runs/latest` lead to a run that is in `runs`.

    A file or folder of that name stays what it is, and a file system without links goes without.
    """
    link = run.parent / LATEST
    if run.parent.resolve() != RUNS.resolve() or (link.exists() and not link.is_symlink()):
        return
    with contextlib.suppress(OSError), tempfile.TemporaryDirectory(dir=run.parent, prefix=".") as scratch:
        made = Path(scratch) / LATEST
        made.symlink_to(run.name)
        made.replace(link)


def itself(run: Path) -> Path:
    """The run folder that a path means, by its own name where the path is a link to its neighbour."""
    return run.parent / run.readlink() if run.is_symlink() else run


def newest_run(folder: Path = RUNS) -> Path:
    """Where `latest` leads, else the run that began last. Raises UsageError if the folder has none."""
    latest = folder / LATEST
    if latest.is_symlink() and (latest / LOG).is_file():
        return itself(latest)
    if runs := runs_of(folder):
        return runs[0]
    raise UsageError(f"there is no run in {folder}; name a run folder, or begin a run: proc3s run TASK")


def runs_of(folder: Path) -> list[Path]:
    """The run folders in a folder, the one that began last first."""
    found = [path for path in _folders(folder) if (path / LOG).is_file()]
    return sorted(found, key=lambda path: (_began(path), path.name), reverse=True)


def _folders(folder: Path) -> Iterator[Path]:
    try:
        yield from (path for path in folder.iterdir() if path.name != LATEST or not path.is_symlink())
    except FileNotFoundError:
        return
    except OSError as error:
        raise UsageError(f"{folder} cannot be read: {error.strerror}") from error


def _began(run: Path) -> str:
    """When a run began, ISO 8601 in UTC; empty where its log does not say."""
    try:
        with (run / LOG).open("rb") as log:
            return str(json.loads(log.readline())["time"])
    except (OSError, ValueError, TypeError, KeyError, RecursionError):
        return ""
