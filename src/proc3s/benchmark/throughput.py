"""The benchmark of the second stage: fixed programs, every search variant, paired by seed. No LLM.

A domain brings its programs as `bench/TASK.NAME.py`; a first line `# scene: count=100` sets options of the
scene generator.
"""

import dataclasses
import itertools
from collections.abc import Iterator, Sequence

import numpy as np

from proc3s.benchmark.cases import Case
from proc3s.benchmark.measurement import PLAIN, SCREENED, Measurement, Meter, SearchVariant
from proc3s.planning.grounding import open_sketch
from proc3s.planning.options import RunOptions
from proc3s.planning.parts import Setup
from proc3s.planning.setup import make_executor, make_setup
from proc3s.plugins.registry import Registry
from proc3s.search.evaluator import Evaluator
from proc3s.search.executor import Executor
from proc3s.search.screen_audit import Audit
from proc3s.search.sketch import Sketch
from proc3s.search.start import space_of, start_search
from proc3s.search.trial import Trial

_BATCHES = (64, 192, 768, 1024)
"""Samples of the batches of a throughput run; the last again and again."""


_ENOUGH = 8.0
"""CPU seconds after which a throughput run starts no further batch; simulators need few plans."""


_AUDITED = 50


_WARMING = 6
"""Plans before the first measurement: enough for every worker to start."""


class Bench:
    """Measures cases; a context manager. Every variant keeps its executor, so workers start once, outside a
    measurement.

    `samples` replaces the budget of the tasks.
    """

    def __init__(
        self, registry: Registry, variants: Sequence[SearchVariant], samples: int | None = None
    ) -> None:
        self._registry = registry
        self._variants = (PLAIN, *variants)
        self._samples = samples
        kinds = {(variant.executor, variant.jobs) for variant in self._variants}
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
        """Measure every variant on one scene, the plain one first."""
        with open_sketch(self._setup(case, seed, PLAIN), case.program) as opened:
            for variant in self._variants:
                setup = self._setup(case, seed, variant)
                if variant.name not in self._warm:
                    _warm_up(setup, opened.sketch)
                    self._warm.add(variant.name)
                yield _search(case, variant, setup, opened.sketch)

    def throughput(self, case: Case, seed: int, samples: int) -> Iterator[Measurement]:
        """Uniform samples in large batches, whatever is accepted among them: plain, and screened.

        A few plans that screens reject are re-checked in the world afterwards, outside the measurement.
        """
        for variant in (PLAIN, SCREENED):
            yield self.stream(case, seed, variant, samples)

    def stream(self, case: Case, seed: int, variant: SearchVariant, samples: int) -> Measurement:
        """The same for one variant; `audited` and `wrong` count re-checked and wrong rejects."""
        with open_sketch(self._setup(case, seed, PLAIN), case.program) as opened:
            return _stream(case, variant, self._setup(case, seed, variant), opened.sketch, samples)

    def _setup(self, case: Case, seed: int, variant: SearchVariant) -> Setup:
        options = RunOptions.model_validate(
            {
                "task": case.task,
                "solver": variant.solver,
                "preset": "paper",
                "seed": seed,
                "samples": self._samples,
                "domain_options": case.scene,
                "world_options": case.world,
                "check_goal": False,
            }
        )
        executor, saving = self._executors[variant.executor, variant.jobs], variant.saving
        setup = make_setup(self._registry, options, goal_needed=False)
        problem = dataclasses.replace(setup.problem, screens="all" if saving else "none", prefixes=saving)
        return dataclasses.replace(setup, problem=problem, executor=executor)


def _warm_up(setup: Setup, sketch: Sketch) -> None:
    """Import what solver, world and workers need: a few plans, and a solver whose samples all fail."""
    u = np.random.default_rng(0).random((_WARMING, sketch.space.dim))
    evaluator = Evaluator(setup.problem, sketch, setup.executor)
    list(evaluator.stream(u))
    solver = setup.make_solver(space_of(evaluator), setup.problem.samples, np.random.default_rng(0))
    for _ in range(8):
        asked = solver.ask(setup.problem.samples)
        solver.tell([Trial(u=tuple(row)) for row in asked.tolist()])


def _search(case: Case, variant: SearchVariant, setup: Setup, sketch: Sketch) -> Measurement:
    problem = setup.problem
    meter = Meter(problem, setup.executor, sketch)
    found = start_search(meter.evaluator, setup.make_solver, problem.samples)
    found.advance(problem.samples)
    if found.broken_off is not None:
        raise found.broken_off
    stopped = found.trials[-1].error if found.alike else found.halted
    error = str(stopped) if stopped else None
    return meter.read(case, variant, found.solution is not None, error)


def _stream(case: Case, variant: SearchVariant, setup: Setup, sketch: Sketch, samples: int) -> Measurement:
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
    measured = meter.read(case, variant, accepted > 0, None)
    found = audit.check(problem, executor)
    return dataclasses.replace(measured, audited=found.checked, wrong=len(found.wrong))
