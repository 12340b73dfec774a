"""Boxes are forked from one process, and share nothing but what it had before it saw any order."""

import os
import signal
import socket
from pathlib import Path

import numpy as np
import pytest

from proc3s.sandbox import BoxedSketch
from proc3s.sandbox.boxed.template import Template
from proc3s.sandbox.boxed.wire import BOX, ORDER
from proc3s.sandbox.process import launcher

from .conftest import LINE, cube, program

SAYS = """
import random
import numpy as np
{change}

def gen_plan(state):
    print({seen})
    return [Action("repeat", [1])]
"""


def pid_of(sketch):
    return sketch._channel._worker.pid


def parent_of(pid):
    return int(fields_of(pid)["PPid"])


def fields_of(pid):
    text = Path(f"/proc/{pid}/status").read_text()
    return dict(line.split(":\t", 1) for line in text.splitlines() if ":\t" in line)


def said(seen, change=""):
    with BoxedSketch(program(SAYS.format(seen=seen, change=change), "program")) as sketch:
        return sketch.plans(np.empty((1, 0))).logs[0].strip()


def test_the_template_has_no_privileges_and_is_the_parent_of_all_boxes():
    with BoxedSketch(program(LINE)) as one, BoxedSketch(program(LINE)) as two:
        template = parent_of(pid_of(one))
        assert parent_of(pid_of(two)) == template
        assert parent_of(template) == os.getpid()
        fields = fields_of(template)
    assert fields["NoNewPrivs"] == "1"
    assert all(int(fields[name], 16) == 0 for name in ("CapPrm", "CapEff", "CapInh", "CapAmb"))
    assert "0" not in fields["Uid"].split()


@pytest.mark.skipif(os.getuid() != 0, reason="only root may look into a locked process")
def test_boxes_that_run_side_by_side_share_no_pipe_and_no_memory():
    with BoxedSketch(program(LINE)) as one, BoxedSketch(program(LINE)) as two:
        pipes = [
            {str(fd.readlink()) for fd in Path(f"/proc/{pid_of(box)}/fd").iterdir()} for box in (one, two)
        ]
        assert pipes[0] & pipes[1] == {os.devnull}
        maps = Path(f"/proc/{pid_of(one)}/maps").read_text().splitlines()
        assert maps
        assert not [line for line in maps if line.split()[1] in ("rw-s", "-w-s")]


def test_what_a_program_changes_is_gone_with_it():
    seen = "np.pi, random.SEEN if hasattr(random, 'SEEN') else None"
    assert said(seen, "np.pi = 4\nrandom.SEEN = 1") == "4 1"
    assert said(seen) == f"{np.pi} None"


def test_boxes_end_with_their_template_and_the_next_one_has_another():
    with BoxedSketch(program(LINE)) as sketch:
        template = parent_of(pid_of(sketch))
        sketch.plans(cube(5, 2))
        os.kill(template, signal.SIGKILL)
        os.waitid(os.P_PID, template, os.WEXITED | os.WNOWAIT)
        with BoxedSketch(program(LINE)) as another:
            assert parent_of(pid_of(another)) != template
            assert len(another.plans(cube(5, 2))) == 5
        assert set(sketch.plans(cube(5, 2)).errors) == {0}  # the others went on in a fresh one


def test_a_box_that_cannot_be_forked_says_why(monkeypatch):
    def refuse():
        raise BlockingIOError(11, "no more processes")

    monkeypatch.setattr(os, "fork", refuse)
    ours, theirs = socket.socketpair()
    read, write = os.pipe()
    with ours, theirs:
        socket.send_fds(ours, [ORDER.pack(BOX, 1, 1 << 30, 10, 1)], [write, write, write])
        os.close(write)
        ours.shutdown(socket.SHUT_WR)
        assert Template(theirs).next_box() is None
    with os.fdopen(read, "rb") as traces:
        assert b"no more processes" in traces.read()


def test_the_seconds_of_boxes_that_ended_are_counted():
    BoxedSketch(program(LINE)).close()
    before = launcher().cpu_seconds
    with BoxedSketch(program("gen_plan = [Action('repeat', [sum(range(10**7)) and 1])]", "plan")):
        pass
    assert launcher().cpu_seconds - before > 0.05
