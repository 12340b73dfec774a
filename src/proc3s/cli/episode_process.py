"""The process of an episode: `proc3s`, that ends when the suite's process does.

Else episodes would go on after a `kill -9`, and be in the way when the suite is resumed.
"""

import ctypes
import os
import signal

from proc3s.cli import main

PR_SET_PDEATHSIG = 1
"""prctl(2)"""


def end_with_parent() -> None:
    """Have this process killed when the thread that started it ends; where the system can do that."""
    prctl = getattr(ctypes.CDLL(None), "prctl", None)
    if prctl is not None:
        prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() == 1:
        raise SystemExit(1)  # it ended in between


if __name__ == "__main__":
    end_with_parent()
    main()
