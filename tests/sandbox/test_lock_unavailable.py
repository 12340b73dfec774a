"""Where the kernel does not let a process lock itself in, no program runs."""

import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from proc3s.sandbox import BoxedSketch, SandboxUnavailable
from proc3s.sandbox.boxed.lock import Unavailable, lock_down
from proc3s.sandbox.process import launcher

from .conftest import LINE, program

LOCKED_OUT = """
    import ctypes, platform, struct, sys

    def refuse_seccomp():
        '''A filter under which no further filter can be installed.'''
        prctl = {"x86_64": 157, "aarch64": 167}[platform.machine()]
        load, equal, give_back = 0x20, 0x15, 0x06
        rules = [(load, 0, 0, 0), (equal, 0, 3, prctl), (load, 0, 0, 16), (equal, 0, 1, 22),
                 (give_back, 0, 0, 0x00050001), (give_back, 0, 0, 0x7FFF0000)]
        lock.install([struct.pack("=HBBI", *rule) for rule in rules])

    sys.path.insert(0, sys.argv[1])
    from proc3s.sandbox import BoxedSketch, SandboxUnavailable
    from proc3s.sandbox.boxed import lock
    from sandbox.conftest import program

    ctypes.CDLL(None).prctl(38, 1, 0, 0, 0)
    refuse_seccomp()
    try:
        BoxedSketch(program("raise SystemExit('it ran')"))
    except SandboxUnavailable as error:
        print(error)
"""


def test_nothing_runs_where_the_filter_is_refused(tmp_path):
    script = tmp_path / "locked_out.py"
    script.write_text(textwrap.dedent(LOCKED_OUT))
    command = [sys.executable, str(script), str(Path(__file__).parents[1])]
    result = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert "cannot be locked in here: [Errno 1] prctl(22) failed: Operation not permitted" in result.stdout, (
        result
    )
    for way_out in ("seccomp filters", "virtual machine", "leave the sandbox", "--unsafe-exec"):
        assert way_out in result.stdout
    assert "it ran" not in result.stdout + result.stderr


def test_an_unknown_processor_is_refused(monkeypatch):
    monkeypatch.setattr("platform.machine", lambda: "riscv64")
    with pytest.raises(Unavailable, match="no list of system calls for riscv64"):
        lock_down(1 << 30, 10)


@pytest.fixture
def no_template():
    """The process that boxes are forked from is started anew, and not used after this test."""
    launcher.cache_clear()
    yield
    launcher.cache_clear()


@pytest.mark.usefixtures("no_template")
def test_an_interpreter_that_cannot_start(monkeypatch):
    monkeypatch.setattr("sys.executable", "/nowhere/python")
    with pytest.raises(SandboxUnavailable, match="/nowhere/python cannot be started"):
        BoxedSketch(program(LINE))


@pytest.mark.usefixtures("no_template")
def test_a_worker_that_dies_early_says_why(monkeypatch, tmp_path):
    python = tmp_path / "python"
    python.write_text("#!/bin/sh\necho \"ModuleNotFoundError: No module named 'numpy'\" >&2; exit 1\n")
    python.chmod(0o755)
    monkeypatch.setattr("sys.executable", str(python))
    with pytest.raises(SandboxUnavailable, match="No module named 'numpy'"):
        BoxedSketch(program(LINE))


def test_another_platform_is_refused(monkeypatch):
    monkeypatch.setattr("sys.platform", "darwin")
    with pytest.raises(SandboxUnavailable, match=r"this is darwin.*WSL 2"):
        BoxedSketch(program(LINE))
