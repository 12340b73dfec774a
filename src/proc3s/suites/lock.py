"""One benchmark at a time in a folder."""

import fcntl
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from proc3s.errors import UsageError

FILE = ".lock"


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Keep other benchmarks out of a folder; a killed one leaves no lock behind. Raises UsageError."""
    try:
        file = (folder / FILE).open("w")
    except OSError as error:
        raise UsageError(f"the folder {folder} cannot be written: {error.strerror}") from error
    with file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            message = f"another benchmark is at work in {folder}; wait for it, or give another --out"
            raise UsageError(message) from error
        yield
