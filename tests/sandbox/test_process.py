"""Workers start ahead of time, die with their parent, and leave nothing behind."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import textwrap
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from proc3s.sandbox import BoxedSketch, Limits, SketchError, SketchMemoryError, prewarm
from proc3s.sandbox.process import launcher

from .conftest import LINE, cube, descendants, program


def pid_of(sketch):
    return sketch._channel._worker.pid


def test_the_next_box_takes_the_warm_worker():
    limits = Limits(cpu=1234)
    prewarm(limits)
    prewarm(limits)
    [spare] = launcher()._spares[limits.memory, limits.cpu, True]
    with BoxedSketch(program(LINE), limits) as first, BoxedSketch(program(LINE), limits) as second:
        assert pid_of(first) == spare.pid != pid_of(second)
        assert np.array_equal(first.plans(cube(9, 2)).values, second.plans(cube(9, 2)).values)


def test_a_spare_that_died_is_replaced():
    limits = Limits(cpu=1235)
    prewarm(limits)
    [spare] = launcher()._spares[limits.memory, limits.cpu, True]
    os.kill(spare.pid, signal.SIGKILL)
    assert spare.wait(5) == -signal.SIGKILL
    with BoxedSketch(program(LINE), limits) as sketch:
        assert pid_of(sketch) != spare.pid


def descriptors():
    return len(list(Path("/proc/self/fd").iterdir()))


def test_nothing_is_left_behind():
    BoxedSketch(program(LINE)).close()
    before = descendants(), descriptors()
    for source in (LINE, "syntax error", LINE, "raise SystemExit", LINE):
        try:
            with BoxedSketch(program(source)) as sketch:
                sketch.plans(cube(3, 2))
        except SketchError:
            continue
    dropped = BoxedSketch(program(LINE))
    del dropped
    assert (descendants(), descriptors()) == before


def test_boxes_in_several_threads_do_not_mix():
    def run(number):
        with BoxedSketch(program(LINE.replace("o.y", str(number)))) as sketch:
            return {sketch.plans(cube(50, 2)).plan(i)[0].args[1] for i in range(50)}

    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(run, range(6))) == [{float(n)} for n in range(6)]


PARENT = """
    import os, sys, threading, time
    sys.path.insert(0, sys.argv[1])
    from sandbox.conftest import *

    sketches = []
    # the thread that asks for a box may end before it
    thread = threading.Thread(target=lambda: sketches.append(BoxedSketch(program(LINE))))
    thread.start()
    thread.join()
    time.sleep(0.1)
    assert len(sketches[0].plans(cube(5, 2))) == 5
    print(sketches[0]._channel._worker.pid, flush=True)
    time.sleep(60)
"""


def start_parent(tmp_path, *prefix):
    script = tmp_path / "parent.py"
    script.write_text(textwrap.dedent(PARENT))
    command = [*prefix, sys.executable, str(script), str(Path(__file__).parents[1])]
    return subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd="/", start_new_session=True
    )


def gone(pid):
    return not Path(f"/proc/{pid}").exists() or "State:\tZ" in Path(f"/proc/{pid}/status").read_text()


@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGTERM])
def test_a_worker_dies_with_its_parent_and_not_with_a_thread(tmp_path, end):
    with start_parent(tmp_path) as parent:
        line = parent.stdout.readline()
        assert line, parent.stderr.read()
        pid = int(line)
        assert not gone(pid)
        parent.send_signal(end)
        parent.wait()
    deadline = time.monotonic() + 5
    while not gone(pid) and time.monotonic() < deadline:
        time.sleep(0.02)
    assert gone(pid)


def runs(parent):
    """Whether a parent gets its plans, and that its worker is locked."""
    with parent:
        line = parent.stdout.readline()
        status = Path(f"/proc/{int(line)}/status").read_text() if line.strip().isdigit() else ""
        parent.kill()
        assert "Seccomp:\t2" in status, line + parent.stderr.read()


def tool(*names):
    """Skip unless the system has these commands."""
    for name in names:
        if shutil.which(name) is None:
            pytest.skip(f"this system has no command {name!r}")


def test_an_ordinary_user_can_run_boxes(tmp_path):
    if os.getuid() != 0:
        pytest.skip("the other tests of this file show it: they do not run as root")
    tool("setpriv")
    # the files of this checkout may lie in root's home, so the right to read them is all that is kept
    keep = ["--inh-caps=+dac_read_search", "--ambient-caps=+dac_read_search"]
    user = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", *keep]
    if subprocess.run([*user, "true"], capture_output=True).returncode:
        pytest.skip("this container does not let root become another user who may read its files")
    runs(start_parent(tmp_path, *user))


def test_boxes_run_in_an_unprivileged_namespace(tmp_path):
    tool("unshare")
    namespace = ["unshare", "--user", "--map-root-user"]
    if subprocess.run([*namespace, "true"], capture_output=True).returncode:
        pytest.skip("this kernel or container does not allow user namespaces")
    runs(start_parent(tmp_path, *namespace))


@pytest.mark.slow
def test_two_hundred_programs_leave_nothing_behind(tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path))  # a folder of its own: other tests use the common one
    monkeypatch.setattr(tempfile, "tempdir", None)
    BoxedSketch(program(LINE)).close()
    before = descendants(), descriptors()
    sources = [
        LINE,
        "syntax error",
        "raise SystemExit",
        "import random; random._os._exit(1)",
        "x = [0] * 10**12",
    ]
    for number in range(200):
        try:
            with BoxedSketch(program(sources[number % len(sources)])) as sketch:
                sketch.plans(cube(3, 2))
        except SketchError:
            continue
    assert (descendants(), descriptors()) == before
    assert list(tmp_path.iterdir()) == []
    assert zombies() == []


def zombies():
    status = (Path(f"/proc/{pid}/status").read_text() for pid in descendants())
    return [text for text in status if "State:\tZ" in text]


def test_a_forked_child_leaves_the_workers_of_its_parent_alone():
    limits = Limits(cpu=1236)
    prewarm(limits)
    with BoxedSketch(program(LINE)) as sketch:
        prewarm(limits)
        [spare] = launcher()._spares[limits.memory, limits.cpu, True]
        child = os.fork()
        if not child:
            sketch.close()
            launcher.cache_clear()
            os._exit(0)
        os.waitpid(child, 0)
        assert len(sketch.plans(cube(5, 2))) == 5
        assert spare.exit_code() is None


def test_without_the_lock_the_limits_stay():
    limits = Limits(memory=64 << 20)
    with BoxedSketch(program(LINE), limits, locked=False) as sketch:
        status = Path(f"/proc/{pid_of(sketch)}/status").read_text()
        rlimits = Path(f"/proc/{pid_of(sketch)}/limits").read_text()
        assert "Seccomp:\t0" in status
        assert "NoNewPrivs:\t1" in status
        assert "Max file size             0                    0" in rlimits
        assert "Max open files            6                    6" in rlimits
        assert len(sketch.plans(cube(5, 2))) == 5
    with pytest.raises(SketchMemoryError):
        BoxedSketch(program("x = bytearray(10**9)"), limits, locked=False)
    source = "import os\nassert 'HOME' not in os.environ\nos.stat('/')\ngen_plan = [Action('repeat', [1])]"
    with BoxedSketch(program(source, "plan"), limits, locked=False, friendly=False) as sketch:
        assert len(sketch.plans(np.empty((1, 0))).plan(0)) == 1


def test_a_locked_box_never_takes_an_unlocked_spare():
    limits = Limits(cpu=1237)
    prewarm(limits, locked=False)
    [spare] = launcher()._spares[limits.memory, limits.cpu, False]
    with BoxedSketch(program(LINE), limits) as sketch:
        assert pid_of(sketch) != spare.pid
    with BoxedSketch(program(LINE), limits, locked=False) as sketch:
        assert pid_of(sketch) == spare.pid
