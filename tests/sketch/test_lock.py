"""Programs that mean harm, with everything that the interpreter can give them."""

import os
import platform
import socket
import subprocess
import sys
import textwrap

import numpy as np
import pytest

from proc3s.sketch import Limits, SketchCrash, SketchError

# the modules behind the friendly imports, which are no boundary
ESCAPE = """
import collections.abc
modules = ().__class__.__base__.__subclasses__
os = [c for c in modules() if c.__name__ == "_wrap_close"][0].__init__.__globals__
sys = os["sys"]
socket = sys.modules.get("_socket")
ctypes = sys.modules["ctypes"]
signal = sys.modules["signal"]
io = sys.modules["io"]
"""


def attempt(box, expression):
    """What comes of an expression in a program that has every module at hand."""
    source = f"{ESCAPE}\ndef gen_plan(state):\n    print({expression})\n    return [Action('repeat', [1])]"
    batch = box(source, "program").plans(np.empty((1, 0)))
    assert 0 not in batch.logs, batch.logs
    return str(batch.errors[0])


REFUSED = "PermissionError: .*not permitted"


@pytest.mark.parametrize(
    "expression",
    [
        'io.open("/etc/passwd").read()',
        'io.open("/tmp/proc3s-escape", "w")',
        'os["open"]("/proc/self/environ", 0)',
        'os["listdir"]("/")',
        'os["stat"]("/")',
        'os["fork"]()',
        'os["posix_spawn"]("/bin/true", ["true"], {})',
        'os["execv"]("/bin/true", ["true"])',
        'os["kill"](os["getppid"]() if 0 else 1, 9)',
        'os["getppid"]()  or os["kill"](1, 0)',
        'os["dup"](3)',
        'os["pipe"]()',
        'os["read"](0, 1)',
        'os["write"](1, b"x")',
        'os["close"](4)',
        'os["setuid"](0)',
        'os["chdir"]("/tmp")',
        'os["memfd_create"]("x")',
        'os["unlink"]("/tmp/x")',
        'sys.modules["resource"].setrlimit(0, (1, 1))',
    ],
)
def test_system_calls_are_refused(box, expression):
    with_permission = attempt(box, expression)
    assert "not permitted" in with_permission or "Error" in with_permission


def test_nothing_of_ours_is_in_reach(box, monkeypatch):
    monkeypatch.setenv("SECRET_API_KEY", "hunter2")
    source = (
        f"{ESCAPE}\nprint(sorted(os['environ']), sys.argv[1:], sys.path)\ngen_plan = [Action('repeat', [1])]"
    )
    log = box(source, "plan").log
    assert "SECRET" not in log
    assert "PYTHONHASHSEED" in log
    assert "'sys' in sys.modules" not in log


def test_machine_code_pages_are_refused(box):
    expression = "ctypes.pythonapi and sys.modules['mmap'].mmap(-1, 4096, prot=7)"
    assert "Error" in attempt(box, expression)


def test_a_ready_worker_is_locked(box):
    sketch = box("gen_plan = [Action('repeat', [1])]", "plan")
    pid = sketch._channel._worker.pid
    with open(f"/proc/{pid}/status") as status:
        fields = dict(line.split(":\t", 1) for line in status.read().splitlines() if ":\t" in line)
    assert fields["Seccomp"] == "2"
    assert fields["NoNewPrivs"] == "1"
    assert fields["Threads"] == "1"
    assert all(int(fields[name], 16) == 0 for name in ("CapPrm", "CapEff", "CapInh", "CapAmb"))
    assert "0" not in fields["Uid"].split()
    if os.getuid() == 0:
        assert sorted(os.listdir(f"/proc/{pid}/fd")) == list("012345")
