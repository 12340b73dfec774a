"""A wall-clock limit on what a plugin does in this process: it aborts, and is never a verdict.

Python code is interrupted by an alarm. Code in C that never comes back cannot be, and no thread of Python
runs beside it: a watcher, a process of its own, then ends this one and says why.
"""

import atexit
import mmap
import os
import signal
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import FrameType

from proc3s.errors import OutOfTime

SECONDS = 60.0
"""The default limit, s."""
AGAIN = 1.0
"""An interruption that a skill swallows is repeated after so long, s."""
NOTE = struct.Struct("<dd192s")
"""Start of the watched step (0: none) and its limit, monotonic s; and the name of the step."""
SUFFIX = ".over"
"""Suffix of the file, named by the process, that says why a watcher ended it."""


class Watch:
    """Watches one thing at a time in the main thread of this process; the watcher starts with the first.

    `told` is the folder for the last words of a process that is not seen; else they go to stderr.
    """

    def __init__(self) -> None:
        self.told: Path | None = None
        self._note: mmap.mmap | None = None

    @contextmanager
    def within(self, seconds: float, what: str) -> Iterator[None]:
        """Raises OutOfTime in what is done in here once the time is over.

        In another thread, and where someone else has set an alarm, there is no limit.
        """
        if (
            threading.current_thread() is not threading.main_thread()
            or signal.getitimer(signal.ITIMER_REAL)[0]
        ):
            yield
            return
        note, late = self._noted(), _Late(seconds, what)
        before = signal.signal(signal.SIGALRM, late)
        NOTE.pack_into(note, 0, time.monotonic(), seconds, what.encode()[:192])
        signal.setitimer(signal.ITIMER_REAL, seconds, AGAIN)
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            NOTE.pack_into(note, 0, 0.0, 0.0, b"")
            signal.signal(signal.SIGALRM, before)
        if late.fired:  # and the error was swallowed
            raise late.error()

    def _noted(self) -> mmap.mmap:
        if self._note is None:
            file = os.memfd_create("proc3s-watch")
            os.ftruncate(file, mmap.PAGESIZE)
            self._note = mmap.mmap(file, mmap.PAGESIZE)
            self._start(file)
            os.close(file)
        return self._note

    def _start(self, file: int) -> None:
        script = str(Path(__file__).with_name("watcher.py"))
        told = str(self.told / f"{os.getpid()}{SUFFIX}") if self.told else ""
        watcher = subprocess.Popen(
            [sys.executable, "-I", "-S", "-B", script, str(os.getpid()), str(file), told],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            env={"LANG": "C.UTF-8"},
            cwd="/",
            pass_fds=[file],
            start_new_session=True,
        )
        atexit.register(_end, watcher)


class _Late:
    """The alarm."""

    def __init__(self, seconds: float, what: str) -> None:
        self._seconds, self._what = seconds, what
        self.fired = False

    def __call__(self, number: int, frame: FrameType | None) -> None:
        self.fired = True
        raise self.error()

    def error(self) -> OutOfTime:
        """What to say."""
        return OutOfTime(words(self._what, self._seconds))


def words(what: str, seconds: float) -> str:
    """What is said of something that takes too long."""
    return f"{what} did not end within {seconds:g} s (--limit step={seconds:g})"


def _end(watcher: "subprocess.Popen[bytes]") -> None:
    watcher.kill()
    watcher.wait()


@cache
def watch() -> Watch:
    """The watch of this process."""
    return Watch()


# a forked child has a note that is its parent's, and no watcher
os.register_at_fork(after_in_child=watch.cache_clear)
