"""The Containerfile: what it copies is there, what it installs is what the README says, and it builds."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from stranger import call, with_the_wheel

ROOT = Path(__file__).parents[2]
FILE = ROOT / "docs/container/Containerfile"
ENGINES = ("docker", "podman")


def instructions(name):
    """The arguments of all instructions of a kind, in order."""
    return re.findall(rf"^{name} (.+)$", FILE.read_text(encoding="utf-8"), re.MULTILINE)


def copied():
    """What comes from the repository."""
    return [path for line in instructions("COPY") if "--from" not in line for path in line.split()[:-1]]


def test_what_it_copies_is_there():
    assert {"src", "pyproject.toml"} <= set(copied())
    for path in copied():
        assert (ROOT / path).exists(), path


def test_it_installs_as_the_readme_says():
    (installed,) = [line for line in instructions("RUN") if line.startswith("pip install")]
    packages = installed.removeprefix("pip install --no-cache-dir ")
    assert f"pip install {packages} && " in (ROOT / "README.md").read_text(encoding="utf-8")


def test_its_python_has_the_simulator():
    assert {line.split()[0].split(":")[1].removesuffix("-slim") for line in instructions("FROM")} == {"3.11"}


def test_the_page_builds_this_file():
    page = (ROOT / "docs/how-to/container.md").read_text(encoding="utf-8")
    assert "docker build -f docs/container/Containerfile -t proc3s ." in page
    assert "WSL 2" in page


@pytest.mark.slow
def test_what_it_copies_makes_the_wheel(tmp_path):
    """No part of the package is left out of the copy."""
    source = tmp_path / "source"
    source.mkdir()
    for path in copied():
        copy = shutil.copytree if (ROOT / path).is_dir() else shutil.copy
        copy(ROOT / path, source / path)
    with_the_wheel(tmp_path, source)
    assert '"drawing/star"' in call(tmp_path / "venv/bin/proc3s", "list", "tasks", "--json", cwd=tmp_path)


def _engine():
    """A container engine that answers, if there is one."""
    for name in filter(shutil.which, ENGINES):
        if subprocess.run([name, "info"], capture_output=True, timeout=60).returncode == 0:
            return name
    return None


@pytest.mark.slow
def test_it_builds_and_runs_a_program_locked_in(tmp_path):
    engine = _engine()
    if engine is None:
        pytest.skip("no container engine answers here: neither `docker info` nor `podman info` succeeds")
    build = [engine, "build", "-f", FILE, "-t", "proc3s-test", ROOT]
    built = subprocess.run(build, capture_output=True, text=True, timeout=3600)
    assert built.returncode == 0, built.stderr
    run = [engine, "run", "--rm", "-v", f"{tmp_path}:/data", "proc3s-test"]
    assert "programs run locked in" in call(*run, "doctor", cwd=tmp_path)
    assert "solved" in call(*run, "run", "drawing/star", "--out", "star", cwd=tmp_path)
    assert (tmp_path / "star/plan.png").is_file()
