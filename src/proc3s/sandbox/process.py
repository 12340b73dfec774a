"""Starts worker processes, ahead of time if asked."""

import os
import subprocess
import sys
import weakref
from collections import deque
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import NamedTuple, TypeAlias

from proc3s.sandbox.errors import SandboxUnavailable

Worker: TypeAlias = "subprocess.Popen[bytes]"

PYTHON = f"{sys.version_info.major}.{sys.version_info.minor}"
"""Version of the interpreter that runs programs: workers are started with the one that runs proc3s."""
# no key or path of ours; fixed hashing and one BLAS thread so that runs repeat and stay on one core
_ENVIRONMENT = {
    "LANG": "C.UTF-8",
    "PYTHONHASHSEED": "0",
    "OPENBLAS_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
}


class Kind(NamedTuple):
    """What a worker is started with: bytes, CPU seconds, and whether the kernel locks it in."""

    memory: int
    cpu_seconds: int
    locked: bool


class Launcher:
    """Starts workers from one thread that lives as long as this process.

    A worker is killed by the kernel when the thread that started it ends, so any other thread would do
    only for as long as it runs.
    """

    def __init__(self) -> None:
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="sketch-launcher")
        self._spares: dict[Kind, deque[Worker]] = {}
        weakref.finalize(self, _end_all, self._spares)

    def warm(self, kind: Kind) -> None:
        """Start a spare of this kind unless one is waiting. Raises SandboxUnavailable."""
        spares = self._spares.setdefault(kind, deque())
        if not spares:
            spares.append(self._start(kind))

    def take(self, kind: Kind) -> Worker:
        """Take a worker: the spare if there is one. Raises SandboxUnavailable."""
        spares = self._spares.get(kind, deque())
        while spares:
            worker = spares.popleft()
            if worker.poll() is None:
                return worker
            end(worker)
        return self._start(kind)

    def _start(self, kind: Kind) -> Worker:
        if kind.locked and sys.platform != "linux":
            raise SandboxUnavailable(f"this is {sys.platform}")
        script = str(Path(__file__).with_name("worker.py"))
        lock = "locked" if kind.locked else "unlocked"
        command = [sys.executable, "-s", "-B", script, str(kind.memory), str(kind.cpu_seconds), lock]
        try:
            return self._thread.submit(_spawn, command).result()
        except OSError as error:
            raise SandboxUnavailable(f"{sys.executable} cannot be started: {error}") from error


def _spawn(command: list[str]) -> Worker:
    pipe = subprocess.PIPE
    return subprocess.Popen(
        command,
        stdin=pipe,
        stdout=pipe,
        stderr=pipe,
        bufsize=0,
        env=_ENVIRONMENT,
        cwd="/",
        start_new_session=True,
    )


def end(worker: Worker) -> None:
    """Kill a worker and give back all that it held; harmless when it has ended already."""
    if worker.poll() is None:
        worker.kill()
    worker.wait()
    for pipe in (worker.stdin, worker.stdout, worker.stderr):
        if pipe is not None:
            pipe.close()


def _end_all(spares: dict[Kind, deque[Worker]]) -> None:
    for worker in (worker for queue in spares.values() for worker in queue):
        end(worker)


@cache
def launcher() -> Launcher:
    """The launcher of this process."""
    return Launcher()


# a forked child has neither the thread nor a right to the spares
os.register_at_fork(after_in_child=launcher.cache_clear)
