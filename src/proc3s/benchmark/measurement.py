"""What a benchmark measures: CPU seconds by stage, samples, verdicts."""

import multiprocessing
import time
from dataclasses import dataclass
from pathlib import Path

from proc3s.benchmark.cases import Case
from proc3s.search.evaluator import Evaluator
from proc3s.search.executor import Executor
from proc3s.search.problem import Problem
from proc3s.search.screen_audit import Audit
from proc3s.search.sketch import Sketch

STAGES = ("program", "screens", "world", "other")
"""Where CPU time goes; `other` is the solver and the bookkeeping."""


@dataclass(frozen=True)
class SearchVariant:
    """A variant of the search: a solver, with or without screens and prefix cache."""

    name: str
    solver: str
    executor: str = "serial"
    jobs: int = 1
    saving: bool = True
    """Whether screens and the prefix cache are used."""


PLAIN = SearchVariant("plain", "rejection", saving=False)
"""The baseline: rejection sampling without screens or prefix cache, in this process."""


SCREENED = SearchVariant("screened", "rejection")
"""The baseline with screens and prefix cache."""


@dataclass(frozen=True)
class Measurement:
    """One search, or one throughput run, of a case with one seed. CPU seconds by stage, wall seconds."""

    case: str
    way: str
    seed: int
    solved: bool
    samples: int
    evaluations: int
    rejected_by: dict[str, int]
    cpu: dict[str, float]
    wall: float
    error: str | None = None
    audited: int = 0
    """Rejects of the screens that were put to the world after all, and how many of them it accepts."""
    wrong: int = 0

    @property
    def total(self) -> float:
        """CPU seconds of all stages."""
        return sum(self.cpu.values())


class Meter:
    """Measures the CPU time of an evaluator from now on, worker processes included."""

    def __init__(
        self, problem: Problem, executor: Executor, sketch: Sketch, audit: Audit | None = None
    ) -> None:
        self._seed = problem.seed
        self.evaluator = Evaluator(problem, sketch, executor, audit=audit)
        self._wall, self._cpu = time.perf_counter(), time.process_time()
        self._pool, self._boxes = _cpu_of_children()

    def cpu(self) -> dict[str, float]:
        """CPU seconds since then by stage; the program's process counts as program, pool workers as world."""
        cpu = time.process_time() - self._cpu
        pool, boxes = _cpu_of_children()
        parts = dict(self.evaluator.clock.cpu)
        parts["other"] = max(cpu - sum(parts.values()), 0.0)
        parts["program"] += max(boxes - self._boxes, 0.0)
        parts["world"] += max(pool - self._pool, 0.0)
        return {stage: parts[stage] for stage in STAGES}

    def read(self, case: Case, variant: SearchVariant, solved: bool, error: str | None) -> Measurement:
        """The measurement since the meter was made."""
        cpu, wall = self.cpu(), time.perf_counter() - self._wall
        evaluator = self.evaluator
        return Measurement(
            case=case.label,
            way=variant.name,
            seed=self._seed,
            solved=solved,
            samples=evaluator.samples,
            evaluations=evaluator.evaluations,
            rejected_by=dict(evaluator.rejected_by),
            cpu=cpu,
            wall=wall,
            error=error,
        )


def _cpu_of_children() -> tuple[float, float]:
    """CPU seconds of the living pool workers, and of the other children: the programs' processes."""
    workers = {process.pid for process in multiprocessing.active_children()}
    spent = [0.0, 0.0]
    for listed in Path("/proc/self/task").glob("*/children"):
        for pid in map(int, listed.read_text().split()):
            spent[pid not in workers] += time.clock_gettime(_clock_of(pid))
    return spent[0], spent[1]


def _clock_of(pid: int) -> int:
    """Linux's number for the CPU clock of another process, as clock_getcpuclockid(3) gives it."""
    return ~pid << 3 | 2
