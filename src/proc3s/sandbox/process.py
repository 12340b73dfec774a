"""Starts boxes, ahead of time if asked."""

import os
import sys
import weakref
from collections import deque
from concurrent.futures import ThreadPoolExecutor
from functools import cache

from proc3s.sandbox.errors import SandboxUnavailable
from proc3s.sandbox.template import Kind, Template, Worker

PYTHON = f"{sys.version_info.major}.{sys.version_info.minor}"
"""Version of the interpreter that runs programs: workers are started with the one that runs proc3s."""


class Launcher:
    """Has boxes forked from one template, which it starts from a thread that lives as long as this process.

    The template is killed by the kernel when the thread that started it ends, so any other thread would do
    only for as long as it runs.
    """

    def __init__(self) -> None:
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="sketch-launcher")
        self._spares: dict[Kind, deque[Worker]] = {}
        self._templates: list[Template] = []
        weakref.finalize(self, _end_all, self._spares, self._templates)

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
            if worker.exit_code() is None:
                return worker
            worker.close()
        return self._start(kind)

    @property
    def cpu_seconds(self) -> float:
        """Of the template and of boxes that have ended, which are no children of this process."""
        return sum(template.cpu_seconds for template in self._templates)

    def _start(self, kind: Kind) -> Worker:
        if kind.locked and sys.platform != "linux":
            raise SandboxUnavailable(f"this is {sys.platform}")
        try:
            return self._thread.submit(self._template).result().order(kind)
        except OSError as error:
            raise SandboxUnavailable(f"{sys.executable} cannot be started: {error}") from error

    def _template(self) -> Template:
        if not self._templates or not self._templates[-1].alive:
            self._templates.append(Template())
        return self._templates[-1]


def _end_all(spares: dict[Kind, deque[Worker]], templates: list[Template]) -> None:
    for worker in (worker for queue in spares.values() for worker in queue):
        worker.close()
    for template in templates:
        template.close()


@cache
def launcher() -> Launcher:
    """The launcher of this process."""
    return Launcher()


# a forked child has neither the thread nor a right to the spares
os.register_at_fork(after_in_child=launcher.cache_clear)
