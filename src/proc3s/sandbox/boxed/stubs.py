"""Stand-ins for two modules: `sys` without the system, `time` without the time, so that samples repeat."""

import sys
from types import ModuleType

_TICK = 1_000_000
"""Nanoseconds by which each reading of the clock advances it."""
_SYS = (
    "byteorder",
    "exit",
    "float_info",
    "getrecursionlimit",
    "int_info",
    "maxsize",
    "version",
    "version_info",
)


class Ticks:
    """A clock that counts how often it is read: a millisecond each time, from zero in every sample."""

    def __init__(self) -> None:
        self.readings = 0

    def nanoseconds(self) -> int:
        """The time in nanoseconds."""
        self.readings += 1
        return self.readings * _TICK

    def seconds(self) -> float:
        """The time in seconds."""
        return self.nanoseconds() / 1e9


def time_module(ticks: Ticks) -> ModuleType:
    """`time`: every clock is that one, and `sleep` does nothing."""
    module = ModuleType("time")
    for name in ("time", "monotonic", "perf_counter", "process_time", "thread_time"):
        vars(module).update({name: ticks.seconds, f"{name}_ns": ticks.nanoseconds})
    vars(module)["sleep"] = lambda seconds: None
    return module


def sys_module() -> ModuleType:
    """`sys`: what is the same everywhere, and where `print` goes."""
    module = ModuleType("sys")
    vars(module).update({name: getattr(sys, name) for name in _SYS})
    vars(module).update(stdout=sys.stdout, stderr=sys.stderr, argv=[""], setrecursionlimit=lambda limit: None)
    return module
