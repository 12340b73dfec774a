"""The environment of a stranger: the wheel and what it depends on, nothing of this checkout."""

import os
import subprocess
import sys
import venv
from pathlib import Path

ROOT = Path(__file__).parents[2]
_OURS = ("PYTHONPATH", "VIRTUAL_ENV")


def call(*command: str | Path, cwd: Path) -> str:
    """What a command prints that must not fail, run without the variables of this process's environment."""
    environment = {name: value for name, value in os.environ.items() if name not in _OURS}
    done = subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, timeout=900)
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def install(folder: Path, *packages: str | Path) -> None:
    """Install packages into the environment `folder/venv`."""
    pip = (sys.executable, "-m", "pip", "--python", folder / "venv/bin/python", "install", "-q")
    call(*pip, *packages, cwd=folder)


def with_the_wheel(folder: Path, source: Path = ROOT) -> None:
    """Build the wheel and install it, alone, into a new `folder/venv`."""
    call(sys.executable, "-m", "build", "--wheel", "--outdir", folder, source, cwd=folder)
    venv.create(folder / "venv")
    install(folder, next(folder.glob("*.whl")))


def on_top_of(lower: Path, folder: Path) -> None:
    """A new `folder/venv` that sees what `lower/venv` has installed, and leaves it as it is."""
    venv.create(folder / "venv")
    (packages,) = (folder / "venv/lib").glob("python3*/site-packages")
    (seen,) = (lower / "venv/lib").glob("python3*/site-packages")
    (packages / "lower.pth").write_text(f"{seen}\n")
