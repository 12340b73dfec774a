"""The wheel works by itself: built, installed in a clean environment, and run outside the repository."""

import json
import os
import subprocess
import sys
import time
import venv
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("wheel")]


def call(*command: str | Path, cwd: Path) -> str:
    environment = {
        name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "VIRTUAL_ENV")
    }
    done = subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, timeout=900)
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout


@pytest.fixture(scope="module")
def clean(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A clean virtual environment that has the wheel and what it depends on."""
    folder = tmp_path_factory.mktemp("stranger")
    call(sys.executable, "-m", "build", "--wheel", "--outdir", folder, ROOT, cwd=folder)
    venv.create(folder / "venv", with_pip=True)
    wheel = next(folder.glob("*.whl"))
    call(folder / "venv/bin/pip", "install", "-q", wheel, cwd=folder)
    return folder


def test_the_first_command_of_the_readme_draws_a_star(clean: Path) -> None:
    call(clean / "venv/bin/proc3s", "run", "drawing/star", "--out", "first", cwd=clean)  # writes caches
    begun = time.monotonic()
    summary = json.loads(call(clean / "venv/bin/proc3s", "run", "drawing/star", "--json", cwd=clean))
    assert time.monotonic() - begun < 5
    assert summary["solved"]
    assert summary["goal_reached"]
    assert summary["llm_source"] == "authored"
    assert (clean / summary["run_dir"] / "plan.png").read_bytes().startswith(b"\x89PNG")


def test_every_plugin_comes_with_the_wheel(clean: Path) -> None:
    statuses = json.loads(call(clean / "venv/bin/proc3s", "plugins", "--strict", "--json", cwd=clean))
    assert {status["source"] for status in statuses} == {"proc3s"}
    names = {status["name"] for status in statuses}
    assert names >= {"drawing", "litellm", "methods", "replay", "samplers", "solvers", "templates"}


def test_typing_information_is_shipped(clean: Path) -> None:
    assert list((clean / "venv/lib").glob("python3*/site-packages/proc3s/py.typed"))
