"""Problems of the walking domain, executors that live as long as a test module, and a search to compare."""

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest

from proc3s.domain.plan_batch import PlanBatch
from proc3s.domain.samplers import ContinuousSampler, Space
from proc3s.plugins.loose_files import import_loose_file
from proc3s.plugins.registry import open_registry
from proc3s.search.evaluator import Evaluator
from proc3s.search.problem import Problem
from proc3s.search.screen_audit import Audit
from proc3s.search.search import Search
from proc3s.specs.base import Target
from proc3s.specs.domain import ScreenSpec
from proc3s_executors.processes import Processes
from proc3s_executors.serial import Serial

LOOSE = Path(__file__).with_name("walk.py")
HOPS = 5


class Walks:
    """A sketch of five hops, each up to 30 m, one parameter a hop; equal samples make equal plans."""

    def __init__(self, problem, decimals=None):
        names = [f"hop_{k}" for k in range(HOPS)]
        self.space = Space(
            {name: ContinuousSampler(0, 30) for name in names},
            lambda: {name: k for k, name in enumerate(names)},
        )
        self._signatures = problem.domain.signatures(problem.initial)
        self._decimals = decimals

    def plans(self, u, first):
        values = self.space.decode(u)
        if self._decimals is not None:
            values = values.round(self._decimals)
        n = values.size
        return PlanBatch(
            self._signatures,
            np.arange(len(u) + 1) * HOPS,
            np.zeros(n, np.uint8),
            np.arange(n + 1),
            values.ravel(),
        )


@pytest.fixture(scope="session")
def walk():
    """The domain, from a loose file."""
    import_loose_file(LOOSE)
    return open_registry([LOOSE]).domain("walk")


@pytest.fixture
def problem(walk):
    """Makes a problem; `screens` are import strings, `world` arguments of the world."""

    def make(*screens, world=None, stateful=(), **fields):
        specs = [ScreenSpec(name=s, target=f"walk:{s}", exact=True) for s in screens]
        specs += [ScreenSpec(name=s, target=f"walk:{s}", exact=True, stateful=True) for s in stateful]
        target = Target(target="walk:Walk", args=world or {})
        spec = walk.spec.model_copy(update={"screens": tuple(specs), "world": target})
        domain = dataclasses.replace(walk, spec=spec)
        task = domain.spec.tasks["far"]
        scene = json.dumps(domain.states.dump(domain.scene(task, 0)))
        return Problem(domain, task, scene, task.instruction, seed=0, samples=1000, **fields)

    return make


def _pool(jobs):
    @pytest.fixture(scope="module")
    def pool():
        executor = Processes(jobs)
        yield executor
        executor.close()

    return pool


one, two, four = (_pool(jobs) for jobs in (1, 2, 4))


@pytest.fixture
def serial():
    executor = Serial()
    yield executor
    executor.close()


@dataclasses.dataclass(frozen=True)
class Found:
    """A search with everything that must not depend on who computed it."""

    plan: tuple
    samples: int
    evaluations: int
    rejected_by: dict
    trials: tuple
    audit: object


def _search(problem, executor, make_solver, budget, seed, audit, decimals, exhaust):
    sketch = Walks(problem, decimals)
    audited = Audit(audit, seed) if audit else None
    evaluator = Evaluator(problem, sketch, executor, audit=audited)
    rng = np.random.default_rng(seed)
    found = Search(sketch.space, make_solver(sketch.space, budget, rng), evaluator)
    if exhaust:
        found.trials += evaluator.stream(rng.random((budget, HOPS)))
    else:
        found.advance(budget)
    assert found.halted is None
    if found.broken_off:
        raise found.broken_off
    return Found(
        found.solution and found.solution.plan,
        evaluator.samples,
        evaluator.evaluations,
        dict(evaluator.rejected_by),
        tuple(found.trials),
        audited and audited.check(problem, executor),
    )


@pytest.fixture
def search():
    from proc3s_solvers.sampling import BatchOptions, Rejection

    def rejection(space, budget, rng):
        return Rejection(space, budget, rng, BatchOptions())

    def run(
        problem, executor, make_solver=rejection, budget=300, seed=0, audit=0, decimals=None, exhaust=False
    ):
        """`exhaust` takes all samples, whatever is accepted among them."""
        return _search(problem, executor, make_solver, budget, seed, audit, decimals, exhaust)

    return run
