"""The process that boxes are forked from, and the handle of each box."""

import contextlib
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import NamedTuple

from proc3s.sandbox.boxed.wire import BOX, BOX_STATE, ORDER, RUNNING, SIGNAL
from proc3s.sandbox.errors import SandboxUnavailable

_SCRIPT = Path(__file__).with_name("worker.py")
# no key or path of ours; fixed hashing and one BLAS thread so that runs repeat and stay on one core
_ENVIRONMENT = {
    "LANG": "C.UTF-8",
    "PYTHONHASHSEED": "0",
    "OPENBLAS_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
}
_MOST = 1 << 60
"""Bytes or seconds that a box may be ordered with; no machine has more."""
_LAST_WORDS = 16 << 10
_GLANCE = 0.002


class Kind(NamedTuple):
    """What a box is started with: bytes, CPU seconds, and whether the kernel locks it in."""

    memory: int
    cpu_seconds: int
    locked: bool


class Template:
    """A process that has imported what programs may import, and forks a box for each order.

    It is killed by the kernel when the thread that makes this object ends. Raises OSError if it cannot be
    started.
    """

    def __init__(self) -> None:
        self._socket, theirs = socket.socketpair()
        self._boxes = 0
        self._owner = os.getpid()
        self._talking = threading.Lock()
        self.cpu_seconds = 0.0
        """Of the template and of the boxes that have ended, when one was asked last."""
        with theirs:
            self._process = subprocess.Popen(
                [sys.executable, "-s", "-B", str(_SCRIPT)],
                stdin=theirs.fileno(),
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                env=_ENVIRONMENT,
                cwd="/",
                start_new_session=True,
            )

    @property
    def alive(self) -> bool:
        """Whether it takes orders."""
        return self._process.poll() is None

    def order(self, kind: Kind) -> "Worker":
        """A box; it is under way, not ready. Raises SandboxUnavailable."""
        memory, seconds = min(kind.memory, _MOST), min(kind.cpu_seconds, _MOST)
        (asked, requests), (replies, replied), (traces, traced) = os.pipe(), os.pipe(), os.pipe()
        theirs = [asked, replied, traced]
        with self._talking:
            self._boxes += 1
            worker = Worker(self, self._boxes, requests, replies, traces)
            try:
                order = ORDER.pack(BOX, self._boxes, memory, seconds, kind.locked)
                socket.send_fds(self._socket, [order], theirs)
            except OSError as error:
                worker.release()
                reason = self.last_line() or error
                raise SandboxUnavailable(f"the worker does not start ({reason})") from error
            finally:
                for descriptor in theirs:
                    os.close(descriptor)
        return worker

    def state(self, number: int, sent: int) -> tuple[int, int]:
        """Process id and exit code, or RUNNING, of a box, after it was sent a signal, if `sent` is one.

        Boxes end with their template.
        """
        with self._talking, contextlib.suppress(OSError):
            self._socket.sendall(ORDER.pack(SIGNAL, number, sent, 0, 0))
            if len(answer := self._socket.recv(BOX_STATE.size)) == BOX_STATE.size:
                pid, code, self.cpu_seconds = BOX_STATE.unpack(answer)
                return pid, code
        return 0, -signal.SIGKILL

    @property
    def ours(self) -> bool:
        """Whether this process started it, and is no fork of the one that did."""
        return os.getpid() == self._owner

    def last_line(self) -> str:
        """The last line that it said of itself, if it has ended."""
        assert self._process.stderr
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(0.2)
            lines = self._process.stderr.read(_LAST_WORDS).decode(errors="replace").strip().splitlines()
            return lines[-1] if lines else ""
        return ""

    def close(self) -> None:
        """End it and all of its boxes."""
        assert self._process.stderr
        if self.ours:
            self._process.kill()
            self._process.wait()
        self._socket.close()
        self._process.stderr.close()


class Worker:
    """A box: a process forked from the template, and our ends of its three pipes, as descriptors."""

    def __init__(self, template: Template, number: int, requests: int, replies: int, traces: int) -> None:
        self._template = template
        self._number = number
        self._pid, self._code = 0, RUNNING
        self._open = True
        self.requests, self.replies, self.traces = requests, replies, traces

    @property
    def pid(self) -> int:
        """Its process id."""
        if not self._pid:
            self.exit_code()
        return self._pid

    def exit_code(self, sent: int = 0) -> int | None:
        """That of a process that has ended, minus a signal's number; None while it runs.

        A signal may be sent first; SIGKILL is waited for.
        """
        if self._code == RUNNING:
            pid, self._code = self._template.state(self._number, sent)
            self._pid = pid or self._pid
        return None if self._code == RUNNING else self._code

    def wait(self, seconds: float) -> int | None:
        """The exit code as soon as there is one; None after so many seconds."""
        end = time.monotonic() + seconds
        while (code := self.exit_code()) is None and time.monotonic() < end:
            time.sleep(_GLANCE)
        return code

    def last_line(self) -> str:
        """What the template said last, if it has ended."""
        return self._template.last_line()

    def close(self) -> None:
        """Kill it and give back all that it held; harmless when it has ended, or is another process's."""
        if self._open and self._template.ours:
            self.exit_code(signal.SIGKILL)
        self.release()

    def release(self) -> None:
        """Close the pipes."""
        if self._open:
            self._open = False
            for descriptor in (self.requests, self.replies, self.traces):
                os.close(descriptor)
