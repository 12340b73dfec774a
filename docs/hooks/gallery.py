"""Runs that are done while the site is built: their pictures, and the report of one of them."""

import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

from words import render

_RUNS = {
    "star": ("drawing/star",),
    "arrow": ("drawing/arrow",),
    "letters": ("drawing/letters",),
    "enclosed": ("drawing/enclosed", "--samples", "500"),
    "unstack": ("blocks/unstack", "--seed", "1", "--samples", "50"),
}
_REPORTED = "enclosed"


def files() -> dict[str, str | bytes]:
    """The page of the gallery, its pictures and one report, by their place in the site."""
    runs = {
        name: args
        for name, args in _RUNS.items()
        if not args[0].startswith("blocks") or find_spec("pybullet")
    }
    made: dict[str, str | bytes] = {}
    with tempfile.TemporaryDirectory() as scratch:
        for name, args in runs.items():
            # Named, or whoever builds the site would ask the model of their own settings.
            _proc3s(Path(scratch), "run", *args, "--llm", "replay", "--out", name)
            made[f"gallery/{name}.png"] = (Path(scratch) / name / "plan.png").read_bytes()
        _proc3s(Path(scratch), "report", _REPORTED, "--out", "report.html")
        made["gallery/report.html"] = (Path(scratch) / "report.html").read_bytes()
    made["gallery.md"] = render("gallery.md.j2", runs=runs, reported=_REPORTED)
    return made


def _proc3s(folder: Path, *args: str) -> None:
    command = [sys.executable, "-P", "-m", "proc3s", *args]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"proc3s {' '.join(args)} ended with {done.returncode}:\n{done.stderr}")
