"""The benchmark of the second stage: fixed programs, every way of searching them, paired by seed. No LLM.

A domain brings its programs as `bench/TASK.NAME.py`; a first line `# scene: count=100` sets options of the
scene generator.
"""

import dataclasses
import itertools
import multiprocessing
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from proc3s.audit import Audit
from proc3s.errors import UsageError, did_you_mean
from proc3s.evaluation import Evaluator, Sketch
from proc3s.executors import Executor
from proc3s.grounding import Setup, open_sketch
from proc3s.influence import influence
from proc3s.options import RunOptions, key_values, make_executor, make_problem, make_setup
from proc3s.problem import Problem, Trial
from proc3s.registry import Registry
from proc3s.samplers import Space
from proc3s.solving import Search
from proc3s.specs import DomainSpec
from proc3s.textfiles import read_text

_SCENE = "# scene:"
_BATCHES = (64, 192, 768, 1024)
"""Samples of the batches of a throughput run; the last again and again."""
_ENOUGH = 8.0
"""CPU seconds after which a throughput run begins no further batch: in a simulator few plans say enough."""
_AUDITED = 50
_WARMING = 6
"""Plans before the first measurement: enough for every worker to start."""
STAGES = ("program", "screens", "world", "other")
"""Where CPU time goes; `other` is the solver and the bookkeeping."""


@dataclass(frozen=True)
class Case:
    """A program for a task, and the options of its scene."""

    task: str
    name: str
    program: str
    scene: Mapping[str, str] = field(default_factory=dict)

    @property
    def label(self) -> str:
        """`domain/task.name`."""
        return f"{self.task}.{self.name}"


@dataclass(frozen=True)
class Way:
    """A way to search: a solver, and what saves work around it."""

    name: str
    solver: str
    executor: str = "serial"
    jobs: int = 1
    saving: bool = True
    """Whether screens and the prefix cache are used."""


PLAIN = Way("plain", "rejection", saving=False)
"""What everything is compared with: rejection, no screens, no prefix cache, in this process."""


SCREENED = Way("screened", "rejection")
"""The same with all that saves work."""


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


def find_cases(registry: Registry, wanted: Sequence[str] = ()) -> list[Case]:
    """The programs that domains bring, or those of the wanted domains, tasks or `domain/task.name`.

    Raises UsageError for a name that has no program.
    """
    found = [case for spec in registry.all(DomainSpec).values() for case in _cases_of(spec)]
    names = {name for case in found for name in _names(case)}
    for name in wanted:
        if name not in names:
            raise UsageError(f"there is no benchmark program for {name!r}{did_you_mean(name, names)}")
    return [case for case in found if not wanted or set(wanted) & set(_names(case))]


def _names(case: Case) -> tuple[str, str, str]:
    return case.task.partition("/")[0], case.task, case.label


def _cases_of(spec: DomainSpec) -> Iterator[Case]:
    for path in sorted((spec.folder / "bench").glob("*.*.py")) if spec.folder else ():
        task, name = path.stem.split(".", 1)
        if task not in spec.tasks:
            hint = did_you_mean(task, spec.tasks)
            raise UsageError(f"{path}: domain {spec.name} has no task {task!r}{hint}")
        program = read_text(path)
        yield Case(f"{spec.name}/{task}", name, program, _scene(program))


def _scene(program: str) -> dict[str, str]:
    first = program.partition("\n")[0]
    return key_values(first.removeprefix(_SCENE).split()) if first.startswith(_SCENE) else {}


class Bench:
    """Measures cases; a context manager. Every way keeps its executor, so workers start once and not in a
    measurement.

    `samples` replaces the budget of the tasks.
    """

    def __init__(self, registry: Registry, ways: Sequence[Way], samples: int | None = None) -> None:
        self._registry = registry
        self._ways = (PLAIN, *ways)
        self._samples = samples
        kinds = {(way.executor, way.jobs) for way in self._ways}
        self._executors: dict[tuple[str, int], Executor] = {
            (name, jobs): make_executor(registry, name, jobs) for name, jobs in sorted(kinds)
        }
        self._warm: set[str] = set()

    def __enter__(self) -> "Bench":
        return self

    def __exit__(self, *_: object) -> None:
        for executor in self._executors.values():
            executor.close()

    def search(self, case: Case, seed: int) -> Iterator[Measurement]:
        """Every way on one scene, the plain one first."""
        with open_sketch(self._setup(case, seed, PLAIN)) as opened:
            for way in self._ways:
                setup = self._setup(case, seed, way)
                if way.name not in self._warm:
                    _warm_up(setup, opened.sketch)
                    self._warm.add(way.name)
                yield _search(case, way, setup, opened.sketch)

    def throughput(self, case: Case, seed: int, samples: int) -> Iterator[Measurement]:
        """Uniform samples in large batches, whatever is accepted among them: plain, and screened.

        Of what the screens reject a few are put to the world afterwards, which no time counts.
        """
        for way in (PLAIN, SCREENED):
            yield self.stream(case, seed, way, samples)

    def stream(self, case: Case, seed: int, way: Way, samples: int) -> Measurement:
        """The same in one of these ways; `audited` and `wrong` tell how the screens did."""
        with open_sketch(self._setup(case, seed, PLAIN)) as opened:
            return _stream(case, way, self._setup(case, seed, way), opened.sketch, samples)

    def _setup(self, case: Case, seed: int, way: Way) -> Setup:
        options = RunOptions.model_validate(
            {
                "task": case.task,
                "solver": way.solver,
                "preset": "paper",
                "seed": seed,
                "samples": self._samples,
                "domain_options": case.scene,
                "check_goal": False,
            }
        )
        problem = dataclasses.replace(
            make_problem(self._registry, options, goal_needed=False),
            program=case.program,
            screens="all" if way.saving else "none",
            prefixes=way.saving,
        )
        setup = make_setup(self._registry, options, problem)
        return dataclasses.replace(setup, executor=self._executors[way.executor, way.jobs])


def _warm_up(setup: Setup, sketch: Sketch) -> None:
    """Import what solver, world and workers need: a few plans, and a solver whose samples all fail."""
    u = np.random.default_rng(0).random((_WARMING, sketch.space.dim))
    list(Evaluator(setup.problem, sketch, setup.executor).stream(u))
    solver = setup.make_solver(_space(sketch), setup.problem.samples, np.random.default_rng(0))
    for _ in range(8):
        asked = solver.ask(setup.problem.samples)
        solver.tell([Trial(u=tuple(row)) for row in asked.tolist()])


def _space(sketch: Sketch) -> Space:
    return dataclasses.replace(sketch.space, probe=lambda: influence(sketch))


def _search(case: Case, way: Way, setup: Setup, sketch: Sketch) -> Measurement:
    problem = setup.problem
    meter = Meter(problem, setup.executor, sketch)
    space = _space(sketch)
    rng = np.random.default_rng(np.random.SeedSequence(problem.seed, spawn_key=(0,)))
    solver = setup.make_solver(space, problem.samples, rng)
    found = Search(space, solver, meter.evaluator)
    found.advance(problem.samples)
    if found.broken_off is not None:
        raise found.broken_off
    stopped = found.trials[-1].error if found.alike else found.halted
    error = str(stopped) if stopped else None
    return meter.read(case, way, found.solution is not None, error)


def _stream(case: Case, way: Way, setup: Setup, sketch: Sketch, samples: int) -> Measurement:
    problem, executor = setup.problem, setup.executor
    u = np.random.default_rng(problem.seed).random((samples, sketch.space.dim))
    list(Evaluator(problem, sketch, executor).stream(u[:64]))
    audit = Audit(_AUDITED, problem.seed)
    meter = Meter(problem, executor, sketch, audit)
    at = accepted = 0
    sizes = itertools.chain(_BATCHES, itertools.repeat(_BATCHES[-1]))
    while at < samples and sum(meter.cpu().values()) < _ENOUGH:
        batch = u[at : at + next(sizes)]
        accepted += sum(trial.accepted for trial in meter.evaluator.stream(batch))
        at += len(batch)
    measured = meter.read(case, way, accepted > 0, None)
    found = audit.check(problem, executor)
    return dataclasses.replace(measured, audited=found.checked, wrong=len(found.wrong))


class Meter:
    """An evaluator, and the time that goes by around it from now on, worker processes included."""

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

    def read(self, case: Case, way: Way, solved: bool, error: str | None) -> Measurement:
        """What was done since."""
        cpu, wall = self.cpu(), time.perf_counter() - self._wall
        evaluator = self.evaluator
        return Measurement(
            case=case.label,
            way=way.name,
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
