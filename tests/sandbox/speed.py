"""CPU time of a boxed program, against the same program in this process: `python tests/sandbox/speed.py`."""

import argparse
import textwrap
import time

import numpy as np

from proc3s.domain.plan_batch import Parameter, Signature
from proc3s.plugins.builtin import register_samplers
from proc3s.sandbox import BoxedSketch, Program

PRELUDE = """
from dataclasses import dataclass, field
from typing import Any, List

@dataclass
class Obstacle:
    name: str
    x_pos: float
    y_pos: float
    radius: float
    color: str

@dataclass
class DrawingState:
    obstacles: List[Obstacle] = field(default_factory=list)

@dataclass
class ContinuousSampler:
    min: float
    max: float

@dataclass
class DiscreteSampler:
    values: List[Any]

@dataclass
class Action:
    name: str
    params: List[Any] = field(default_factory=list)
"""
SOURCE = """
def gen_plan(state, cx, cy, size, turn):
    points = []
    for i in range(5):
        angle = turn + 4 * math.pi * i / 5
        points.append((cx + size * math.cos(angle), cy + size * math.sin(angle)))
    points.append(points[0])
    return [Action("draw_line", [*a, *b]) for a, b in zip(points, points[1:])]

def gen_domain(state):
    return {"cx": ContinuousSampler(30, 70), "cy": ContinuousSampler(30, 70),
            "size": ContinuousSampler(5, 30), "turn": ContinuousSampler(0, 6.28)}
"""
ROW = "{:<12}{:>12.1f}{:>10.1f}{:>10.1f}{:>10.1f}{:>10.1f}"
HEAD = "{:<12}{:>12}{:>10}{:>10}{:>10}{:>10}"


def scene(obstacles: int) -> str:
    """The initial state as the domain writes it."""
    rng = np.random.default_rng(0)
    items = (
        f"Obstacle(name='object_{i}', x_pos={x!r}, y_pos={y!r}, radius=5.5, color='red')"
        for i, (x, y) in enumerate((100 * rng.random((obstacles, 2))).tolist())
    )
    return f"DrawingState(obstacles=[{', '.join(items)}])"


def program(obstacles: int) -> Program:
    """Five lines of a star."""
    samplers: list = []
    register_samplers(samplers.append)
    line = Signature("draw_line", tuple(Parameter(n, "float", 0, 100) for n in ("x1", "y1", "x2", "y2")))
    return Program(textwrap.dedent(SOURCE), "sketch", PRELUDE, scene(obstacles), (line,), tuple(samplers))


def cpu_of(pid: int) -> float:
    """CPU seconds of another process, to the nanosecond."""
    return time.clock_gettime(~pid << 3 | 2)


def in_process(task: Program, rows: list[list[float]]) -> tuple[float, float]:
    """Microseconds a call with `exec`, and those of them that build the state."""
    names: dict = {}
    exec("import math\n" + task.prelude, names)
    exec(task.source, names)
    gen_plan, state = names["gen_plan"], eval(f"lambda: {task.initial}", names)
    started = time.process_time()
    for row in rows:
        gen_plan(state(), *row)
    middle = time.process_time()
    for _ in rows:
        state()
    ended = time.process_time()
    return (middle - started) / len(rows) * 1e6, (ended - middle) / len(rows) * 1e6


def boxed(task: Program, u: np.ndarray) -> tuple[float, float]:
    """Microseconds a sample in this process and in the worker."""
    with BoxedSketch(task) as sketch:
        sketch.plans(u[:500])
        pid = sketch._channel._worker.pid
        ours, theirs = time.process_time(), cpu_of(pid)
        assert not sketch.plans(u).errors
        return (
            (time.process_time() - ours) / len(u) * 1e6,
            (cpu_of(pid) - theirs) / len(u) * 1e6,
        )


def main() -> None:
    """Print a table; each figure is the best of several runs."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=10_000)
    parser.add_argument("--runs", type=int, default=3)
    options = parser.parse_args()
    u = np.random.default_rng(1).random((options.samples, 4))
    print("CPU, us a sample")
    print(HEAD.format("obstacles", "in process", "(state)", "parent", "worker", "box"))
    for obstacles in (5, 100):
        task = program(obstacles)
        rows = (u * [40, 40, 25, 6.28] + [30, 30, 5, 0]).tolist()
        plain, state = np.min([in_process(task, rows) for _ in range(options.runs)], axis=0)
        runs = [boxed(task, u) for _ in range(options.runs)]
        ours, theirs = min(runs, key=sum)
        print(ROW.format(obstacles, plain, state, ours, theirs, ours + theirs))


if __name__ == "__main__":
    main()
