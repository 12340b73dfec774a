"""Systems and Pythons on which something is missing: a sentence says what to do."""

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement

import proc3s
from proc3s import UsageError
from proc3s_tabletop.extra import extra

PROJECT = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
NOT_ON_WINDOWS = """
import os, sys
sys.modules |= dict.fromkeys(["fcntl", "resource", "pwd", "grp", "termios"])
del os.register_at_fork, os.fork
sys.argv = ["proc3s", "--help"]
from proc3s.cli import main
main()
"""


def test_the_help_needs_nothing_that_windows_lacks(here):
    command = [sys.executable, "-c", NOT_ON_WINDOWS]
    done = subprocess.run(command, cwd=here, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert "doctor" in done.stdout


def test_windows_is_told_where_to_go(cli, monkeypatch):
    monkeypatch.setattr("proc3s.errors.sys.platform", "win32")
    result = cli("run", "drawing/star")
    assert result.code == 2
    assert "WSL 2" in result.stderr
    assert "container" in result.stderr
    with pytest.raises(UsageError, match="WSL 2"):
        proc3s.run("drawing/star")


def evaluated(python):
    """What the extra installs on a Python."""
    environment = {"python_version": python, "python_full_version": f"{python}.0"}
    needs = map(Requirement, PROJECT["optional-dependencies"]["tabletop"])
    return {need.name for need in needs if need.marker is None or need.marker.evaluate(environment)}


def test_a_newer_python_goes_without_the_simulator_alone():
    assert evaluated("3.11") - evaluated("3.12") == {"pybullet"}
    assert evaluated("3.12") == evaluated("3.13")


@pytest.mark.parametrize(
    ("python", "package", "words"),
    [
        ((3, 11, 9), "pybullet", r"needs pybullet: pip install 'proc3s\[tabletop\]'"),
        (
            (3, 12, 1),
            "pybullet",
            r"no wheel .*: take another engine by pip .*mujoco.*, or make an environment of Python 3\.11",
        ),
        ((3, 13, 0), "trimesh", r"needs trimesh: pip install 'proc3s\[tabletop\]'"),
    ],
)
def test_a_missing_package_is_asked_for_where_it_exists(monkeypatch, python, package, words):
    def import_it():
        with monkeypatch.context() as patch, extra():
            patch.setattr("proc3s_tabletop.extra.sys.version_info", python)
            raise ModuleNotFoundError(name=package)

    with pytest.raises(UsageError, match=words):
        import_it()


def test_doctor_names_what_this_python_cannot_have(cli, monkeypatch):
    older = "slide-rule>=1; python_version < '3.0' and extra == 'tabletop'"
    monkeypatch.setattr("proc3s.checks.installation.requires", lambda name: [older])
    (found,) = [f for f in cli("doctor", "--json").json if f["subject"] == "slide-rule"]
    assert (found["level"], "needs another Python than" in found["text"]) == ("note", True)
    assert "uv venv --python 3.11" in found["advice"]
