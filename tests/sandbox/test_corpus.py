"""Hostile and ordinary programs, with the friendly layer and without: then only the kernel holds."""

import os
import signal
from pathlib import Path

import numpy as np
import pytest

from proc3s.sandbox import BoxedSketch, Limits
from proc3s.sandbox.process import Launcher

from .conftest import LINE, cube, descendants, program
from .corpus import SHORT, cases, check, run

HOSTILE, ORDINARY = cases("hostile"), cases("ordinary")
MARKS = [Path(folder, "proc3s-was-here") for folder in ("/tmp", "/dev/shm", "/var/tmp", "/root", "/")]
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGCHLD, signal.SIGUSR1, signal.SIGPIPE)


def twice(every):
    """Each program with the friendly layer off and on; the second run of a program waits for `-m slow`."""
    slow = pytest.mark.slow
    off = [pytest.param(case, False, id=f"{case.name}-kernel") for case in every]
    return off + [pytest.param(case, True, id=f"{case.name}-friendly", marks=slow) for case in every]


def condition():
    """Everything of this process that a program might harm."""
    return {
        "children": descendants(),
        "descriptors": {path.name for path in Path("/proc/self/fd").iterdir()},
        "environment": dict(os.environ),
        "folder": Path.cwd(),
        "handlers": [signal.getsignal(number) for number in SIGNALS],
        "marks": [path for path in MARKS if path.exists()],
    }


def session_of(pid):
    """Processes that belong to the session of a worker, whoever is their parent."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[3]) == pid:
            found.append(stat.parent.name)
    return found


@pytest.fixture
def workers(monkeypatch):
    """Every worker that is taken."""
    taken, take = [], Launcher.take

    def noting(self, kind):
        taken.append(take(self, kind))
        return taken[-1]

    monkeypatch.setattr(Launcher, "take", noting)
    return taken


@pytest.fixture(scope="module")
def usual():
    """What an ordinary program says when nothing hostile has run before."""
    with BoxedSketch(program(LINE)) as sketch:
        return sketch.plans(cube(5, 2)).values


@pytest.mark.parametrize(("case", "friendly"), twice(HOSTILE))
def test_hostile(case, friendly, workers, usual, monkeypatch):
    monkeypatch.setenv("SECRET_API_KEY", "hunter2")
    before = condition()
    result = run(case, SHORT, friendly)
    after = condition()
    check(case, result, friendly)
    assert after == before
    assert "hunter2" not in str(result)
    assert 1 <= len(workers) <= 4  # another where a sample hung or killed the last
    for worker in workers:
        assert worker.exit_code() is not None
        assert session_of(worker.pid) == []
    with BoxedSketch(program(LINE)) as sketch:
        assert np.array_equal(sketch.plans(cube(5, 2)).values, usual)


@pytest.mark.parametrize(("case", "friendly"), twice(ORDINARY))
def test_ordinary(case, friendly):
    check(case, run(case, Limits(), friendly), friendly)


def test_the_corpus_is_large():
    assert len(HOSTILE) >= 60
    assert len(ORDINARY) >= 30
    assert all("expect" in case.fields for case in HOSTILE + ORDINARY)
