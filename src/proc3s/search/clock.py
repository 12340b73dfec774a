"""Where the seconds go: wall and CPU time by stage, children and boxes included."""

import math
import os
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from proc3s.errors import OutOfTime
from proc3s.sandbox.process import launcher

STAGES = ("llm", "solve", "execute")
"""Stages of a run."""


class Clock:
    """Adds up the seconds spent inside `with clock("stage"):`; child processes count once they ended.

    `wall` and `cpu` are seconds by stage that went by before.
    """

    def __init__(
        self, *stages: str, wall: Mapping[str, float] | None = None, cpu: Mapping[str, float] | None = None
    ) -> None:
        self._begun = _now()
        self.wall = dict.fromkeys(stages, 0.0) | dict(wall or {})
        self.cpu = dict.fromkeys(stages, 0.0) | dict(cpu or {})
        self._earlier = sum(self.wall.values()), sum(self.cpu.values())

    @contextmanager
    def __call__(self, stage: str) -> Iterator[None]:
        """Add the time inside to a stage."""
        begun = _now()
        try:
            yield
        finally:
            wall, cpu = _since(begun)
            self.wall[stage] += wall
            self.cpu[stage] += cpu

    def totals(self) -> tuple[float, float]:
        """Wall and CPU seconds since the clock was made, and those that went by before."""
        wall, cpu = _since(self._begun)
        return self._earlier[0] + wall, self._earlier[1] + cpu


class Deadline:
    """Wall-clock seconds from now on; without a number there is no end. `option` is what set it."""

    def __init__(self, option: str, seconds: float | None) -> None:
        self._option, self._seconds = option, seconds
        self._end = math.inf if seconds is None else time.monotonic() + seconds

    def check(self) -> None:
        """Raises OutOfTime once the time is over."""
        if time.monotonic() >= self._end:
            raise OutOfTime(
                f"broken off after {self._seconds:g} s ({self._option}={self._seconds:g}); "
                "more time might have found a plan"
            )


def _now() -> tuple[float, float]:
    times = os.times()
    boxes = launcher().cpu_seconds
    return time.perf_counter(), time.process_time() + times.children_user + times.children_system + boxes


def _since(begun: tuple[float, float]) -> tuple[float, float]:
    now = _now()
    return now[0] - begun[0], now[1] - begun[1]
