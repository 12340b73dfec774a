"""Worlds that are closed after the test."""

from importlib.util import find_spec

import pytest
from tables import world_of

# Without the extra `tabletop` there is no simulator to test.
MISSING = [name for name in ("pybullet", "airo_models") if find_spec(name) is None]
collect_ignore_glob = ["test_[!i]*.py", "test_ik.py"] if MISSING else []


@pytest.fixture
def table():
    """Makes worlds of named positions and closes them."""
    worlds = []

    def make(positions, speed=1.0):
        worlds.append(world_of(positions, speed))
        return worlds[-1]

    yield make
    for world in worlds:
        world.close()
