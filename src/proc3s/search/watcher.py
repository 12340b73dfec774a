"""The watcher of a process, run as a script: ends it when something in it takes too long, and says what.

It imports nothing of proc3s, so that it is there within milliseconds.
"""

import mmap
import os
import signal
import struct
import sys
import time
from pathlib import Path

NOTE = struct.Struct("<dd192s")
"""As in `watch.py`."""
GRACE = 5.0
"""The process has so long to notice the alarm itself, s."""
LOOK = 0.5
"""Between looks, s."""


def overdue(note: mmap.mmap) -> tuple[str, float] | None:
    """What is under way for too long, and its limit in s."""
    begun, seconds, what = NOTE.unpack_from(note)
    if not begun or time.monotonic() < begun + seconds + GRACE:
        return None
    return what.rstrip(b"\0").decode(errors="replace"), seconds


def end(process: int, told: str, what: str, seconds: float) -> None:
    """Say why, and end the process."""
    text = f"{what} did not end within {seconds:g} s (--limit step={seconds:g}), nor when it was interrupted"
    if told:
        Path(told).write_text(text, encoding="utf-8")
    else:
        print(f"error: {text}; the process is ended", file=sys.stderr, flush=True)
    os.kill(process, signal.SIGKILL)


def main(process: int, file: int, told: str) -> None:
    """Look until the process is gone."""
    note = mmap.mmap(file, mmap.PAGESIZE)
    while os.getppid() == process:
        found = overdue(note)
        time.sleep(LOOK)
        if found and overdue(note) == found:
            end(process, told, *found)
            return


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), sys.argv[3])
