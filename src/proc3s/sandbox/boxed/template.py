"""The template of all boxes: it imports what programs may import, then forks a box for each order.

It has no privileges, reads orders of a fixed size from a socket, and never a program: that comes through the
pipes of the box, which only the box has. Where a process that has imported everything had better not fork,
the box imports for itself.
"""

import os
import signal
import socket
import sys
from importlib import import_module

from .lock import disarm
from .wire import BOX, BOX_STATE, ORDER, PIPES, RUNNING

_READY_MADE = sys.platform == "linux"
_FOR_ORDERS = ("socket", "_socket")
"""Modules that a program does not find, as it may use no socket."""
_ENGINE = __package__ + ".serve"


def main() -> None:
    """Serve as the template or, in a process that was forked for it, as a box."""
    if _READY_MADE:
        import_module(_ENGINE).prepare()
        disarm()
    box = Template(socket.socket(fileno=0)).next_box()
    if box is not None:
        import_module(_ENGINE).main(*box)


class Template:
    """Carries out orders; boxes go by the numbers that the other side gave them."""

    def __init__(self, orders: socket.socket) -> None:
        self._orders = orders
        self._pids: dict[int, int] = {}

    def next_box(self) -> tuple[int, int, bool] | None:
        """Memory, CPU seconds and lock of a box, in its process; None in the template, at the end."""
        while True:
            data, descriptors, _, _ = socket.recv_fds(self._orders, ORDER.size, PIPES)
            if not data:
                return None
            operation, number, *values = ORDER.unpack(data)
            if operation != BOX:
                self._orders.sendall(self._state(number, values[0]))
            elif self._fork(number, descriptors):
                return values[0], values[1], bool(values[2])

    def _fork(self, number: int, descriptors: list[int]) -> bool:
        """Whether this is the box. Of one that cannot be forked the pipes close, and its traces say why."""
        try:
            pid = os.fork()
        except OSError as error:
            os.write(descriptors[-1], f"{error}\n".encode())
            pid = -1
        if pid == 0:
            self._become_box(descriptors)
            return True
        for descriptor in descriptors:
            os.close(descriptor)
        if pid > 0:
            self._pids[number] = pid
        return False

    def _become_box(self, descriptors: list[int]) -> None:
        self._orders.detach()  # the first pipe takes its descriptor
        for name in _FOR_ORDERS:
            del sys.modules[name]
        for standard, descriptor in enumerate(descriptors):
            os.dup2(descriptor, standard)
        os.setsid()

    def _state(self, number: int, sent: int) -> bytes:
        """Send a box a signal, if it is one, and say what has become of it.

        Nobody else waits for the process, so its id is that of no other yet.
        """
        pid, code = self._pids.get(number, 0), -signal.SIGKILL
        if pid:
            if sent:
                os.kill(pid, sent)
            ended, status = os.waitpid(pid, 0 if sent == signal.SIGKILL else os.WNOHANG)
            code = os.waitstatus_to_exitcode(status) if ended else RUNNING
            if ended:
                del self._pids[number]
        return BOX_STATE.pack(pid, code, sum(os.times()[:4]))
