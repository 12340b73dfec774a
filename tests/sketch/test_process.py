"""Workers start ahead of time, die with their parent, and leave nothing behind."""

import os
import signal
import subprocess
import sys
import textwrap
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from proc3s.sketch import BoxedSketch, Limits, SketchError, prewarm
from proc3s.sketch.process import launcher

from .conftest import LINE, cube, program


def pid_of(sketch):
    return sketch._channel._worker.pid


def children():
    """Process ids of the children of all threads."""
    tasks = Path("/proc/self/task").iterdir()
    return {child for task in tasks for child in (task / "children").read_text().split()}


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
    spare.wait()
    with BoxedSketch(program(LINE), limits) as sketch:
        assert pid_of(sketch) != spare.pid


def descriptors():
    return len(list(Path("/proc/self/fd").iterdir()))


def test_nothing_is_left_behind():
    BoxedSketch(program(LINE)).close()
    before = children(), descriptors()
    for source in (LINE, "syntax error", LINE, "raise SystemExit", LINE):
        try:
            with BoxedSketch(program(source)) as sketch:
                sketch.plans(cube(3, 2))
        except SketchError:
            continue
    dropped = BoxedSketch(program(LINE))
    del dropped
    assert (children(), descriptors()) == before


def test_boxes_in_several_threads_do_not_mix():
    def run(number):
        with BoxedSketch(program(LINE.replace("o.y", str(number)))) as sketch:
            return {sketch.plans(cube(50, 2)).plan(i)[0].args[1] for i in range(50)}

    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(run, range(6))) == [{float(n)} for n in range(6)]


PARENT = """
    import os, sys, threading, time
    sys.path.insert(0, sys.argv[1])
    from sketch.conftest import *

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


def start_parent(tmp_path, **options):
    script = tmp_path / "parent.py"
    script.write_text(textwrap.dedent(PARENT))
    command = [sys.executable, str(script), str(Path(__file__).parents[1])]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)


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


def test_an_ordinary_user_can_run_boxes(tmp_path):
    if os.getuid() != 0:
        pytest.skip("only root can change the user")
    for folder in (tmp_path, *tmp_path.parents):
        if not folder.stat().st_mode & 0o001:
            folder.chmod(0o711)
    try:
        parent = start_parent(tmp_path, user=65534, group=65534, extra_groups=[], cwd="/")
    except PermissionError:
        pytest.skip(f"{sys.executable} is closed to ordinary users")
    with parent:
        line = parent.stdout.readline()
        parent.kill()
        assert line.strip().isdigit(), parent.stderr.read()
