import subprocess
import sys

import pytest

from proc3s import UsageError
from proc3s_tabletop.bullet.client import Client


def run(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)


def test_no_simulator_is_loaded_before_a_world_is_made():
    code = (
        "import sys, proc3s_tabletop.world, proc3s_tabletop.actions.motion;"
        "assert not {'pybullet', 'airo_models'} & set(sys.modules)"
    )
    assert run(code).returncode == 0


def test_pybullet_prints_nothing():
    done = run("from proc3s_tabletop.bullet.client import Client; Client().close()")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_without_pybullet_the_way_to_get_it_is_said(monkeypatch):
    monkeypatch.setitem(sys.modules, "pybullet", None)
    with pytest.raises(UsageError, match=r"proc3s\[tabletop\]"):
        Client()
