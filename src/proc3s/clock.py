"""Where the seconds go: wall and CPU time by stage, children included."""

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager


class Clock:
    """Adds up the seconds spent inside `with clock("stage"):`; child processes count once they ended."""

    def __init__(self, *stages: str) -> None:
        self._begun = _now()
        self.wall = dict.fromkeys(stages, 0.0)
        self.cpu = dict(self.wall)

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
        """Wall and CPU seconds since the clock was made."""
        return _since(self._begun)


def _now() -> tuple[float, float]:
    children = os.times()
    return time.perf_counter(), time.process_time() + children.children_user + children.children_system


def _since(begun: tuple[float, float]) -> tuple[float, float]:
    now = _now()
    return now[0] - begun[0], now[1] - begun[1]
