"""One headless PyBullet client of one's own."""

import functools
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from proc3s_tabletop.extra import extra


class Client:
    """The functions and constants of PyBullet, bound to a client that `close` ends.

    PyBullet is imported here and nowhere else, when the first client is made. Raises UsageError if it is
    not installed.
    """

    def __init__(self) -> None:
        self._pybullet = import_pybullet()
        self._id: int = self._pybullet.connect(self._pybullet.DIRECT)

    def __getattr__(self, name: str) -> Any:
        """A function with this client filled in, looked up once; constants as they are."""
        value = getattr(self._pybullet, name)
        if callable(value):
            value = functools.partial(value, physicsClientId=self._id)
        setattr(self, name, value)
        return value

    def close(self) -> None:
        """End the client and everything in it; a second call does nothing."""
        if self._pybullet.isConnected(self._id):
            self._pybullet.disconnect(self._id)


def import_pybullet() -> Any:
    """The module. Raises UsageError where it is not installed."""
    with extra(), _quiet():
        import pybullet  # type: ignore[import-untyped, import-not-found, unused-ignore]
    return pybullet


@contextmanager
def _quiet() -> Iterator[None]:
    """PyBullet's C code prints when it was built to the error stream, each time it is imported."""
    if "pybullet" in sys.modules:
        yield
        return
    sys.stderr.flush()
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)
