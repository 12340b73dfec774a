"""Programs that use up too much, by accident."""

import time

import numpy as np
import pytest

from proc3s.sandbox import Limits, SketchCrash, SketchMemoryError, SketchTimeout

from .conftest import cube

SHORT = Limits(call=0.4, load=1.0, restarts=0)


def after(number, what):
    """A sketch whose sample of that number does `what`."""
    return f"""
def gen_plan(state, x):
    if x > {number - 0.5}:
        {what}
    return [Action("draw_line", [x / 10, 2, 3, 4])]

def gen_domain(state):
    return {{"x": DiscreteSampler(range(1000))}}
"""


COUNTING = (np.arange(1000)[:, None] + 0.5) / 1000


@pytest.mark.parametrize(
    ("what", "where"),
    [
        ("while True: pass", "while True: pass"),
        ("sum(itertools.repeat(0)) if (itertools := __import__('itertools')) else 0", "sum("),
        ("'a' * 5000000 in 'a' * 4999999 + 'b' + 'a' * 4999999 or 3 ** (10 ** 9)", "3 **"),
    ],
)
def test_a_hang_keeps_the_finished_samples_and_names_the_line(box, what, where):
    sketch = box(after(700, what), limits=SHORT)
    started = time.monotonic()
    with pytest.raises(
        SketchTimeout, match=r"line 3: one call of gen_plan took longer than 0\.4 s"
    ) as caught:
        sketch.plans(COUNTING)
    assert time.monotonic() - started < 5
    assert where in caught.value.source
    done = caught.value.done
    assert len(done) == 700
    assert not done.errors
    assert [done.plan(i)[0].args[0] for i in (0, 699)] == [0.0, 69.9]
    with pytest.raises(SketchCrash, match="has ended"):
        sketch.plans(COUNTING)


def test_a_hang_while_loading(box):
    with pytest.raises(SketchTimeout, match=r"line 2: loading the program took longer than 1 s"):
        box("x = 1\nwhile x: x += 1", limits=SHORT)


def test_a_batch_has_a_limit_of_its_own(box):
    slow = after(0, "sum(range(3_000_000))")
    with pytest.raises(SketchTimeout, match=r"the batch took longer than 0\.4 s") as caught:
        box(slow, limits=Limits(batch=0.4)).plans(COUNTING)
    assert 0 < len(caught.value.done) < 200


def test_cpu_time_has_a_limit(box):
    with pytest.raises(SketchTimeout, match="used more than 2 s of CPU time"):
        box(after(700, "while True: pass"), limits=Limits(cpu=2, call=20)).plans(COUNTING)


@pytest.mark.parametrize(
    "what", ["hog = bytearray(10**12)", "hog = []\n        while True: hog.append({len(hog): 1})"]
)
def test_memory(box, what):
    with pytest.raises(SketchMemoryError, match="MemoryError") as caught:
        box(after(700, what), limits=Limits(memory=64 << 20, restarts=0)).plans(COUNTING)
    assert len(caught.value.done) == 700


def test_memory_while_loading(box):
    with pytest.raises(SketchMemoryError, match="line 1: "):
        box("x = [0] * 10**10")
    with pytest.raises(SketchMemoryError):
        box("x = np.zeros(10**9)")


def test_a_crash_inside_c_code(box):
    crash = "np.lib.stride_tricks.as_strided(np.zeros(1), (10**6,), (4096,)).sum()"
    sketch = box(after(700, crash), limits=Limits(restarts=0))
    with pytest.raises(SketchCrash, match=r"process died \(SIGSEGV\)") as caught:
        sketch.plans(COUNTING)
    assert len(caught.value.done) == 700


def test_what_a_program_said_before_it_died_is_read_though_it_takes_no_more_samples(box):
    """Its long replies wait in the pipe when the next samples can no longer be sent."""
    crash = "np.lib.stride_tricks.as_strided(np.zeros(1), (10**6,), (4096,)).sum()"
    long = after(570, crash).replace("2, 3, 4])]", "2, 3, 4])] * 30")
    with pytest.raises(SketchCrash) as caught:
        box(long, limits=Limits(restarts=0)).plans(COUNTING)
    assert len(caught.value.done) == 570


def test_a_program_cannot_be_ended_by_an_exception(box):
    batch = box(after(1, "raise SystemExit(0) from KeyboardInterrupt()")).plans(COUNTING[:3])
    assert str(batch.errors[1]) == "line 3: SystemExit: 0"


def test_replies_of_a_batch_have_a_limit(box):
    with pytest.raises(Exception, match="the plans of this batch take more than 0 MiB") as caught:
        box(after(0, "pass"), limits=Limits(replies=2000)).plans(cube(1000, 1))
    assert caught.value.kind == "SketchContractError"
