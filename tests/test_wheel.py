"""The wheel works by itself: built, installed in a clean environment, and run outside the repository."""

import json
import time
from pathlib import Path

import pytest

from stranger import call

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("wheel")]


def test_the_first_command_of_the_readme_draws_a_star(stranger: Path) -> None:
    call(stranger / "venv/bin/proc3s", "run", "drawing/star", "--out", "first", cwd=stranger)  # writes caches
    begun = time.monotonic()
    summary = json.loads(call(stranger / "venv/bin/proc3s", "run", "drawing/star", "--json", cwd=stranger))
    assert time.monotonic() - begun < 5
    assert summary["solved"]
    assert summary["goal_reached"]
    assert summary["llm_source"] == "authored"
    assert (stranger / summary["run_dir"] / "plan.png").read_bytes().startswith(b"\x89PNG")


def test_every_plugin_comes_with_the_wheel(stranger: Path) -> None:
    statuses = json.loads(call(stranger / "venv/bin/proc3s", "plugins", "--strict", "--json", cwd=stranger))
    assert {status["source"] for status in statuses} == {"proc3s"}
    names = {status["name"] for status in statuses}
    assert names >= {"drawing", "litellm", "methods", "replay", "samplers", "solvers", "templates"}


def test_typing_information_is_shipped(stranger: Path) -> None:
    assert list((stranger / "venv/lib").glob("python3*/site-packages/proc3s/py.typed"))
