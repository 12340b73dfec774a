"""A program becomes a sketch: loaded in its box as the method wants it, and run again when it wins."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

import numpy as np

from proc3s.evaluation import Sketch
from proc3s.executors import Executor
from proc3s.jitter import Jitter
from proc3s.limits import ClockLimits
from proc3s.problem import Problem, Trial
from proc3s.samplers import Space
from proc3s.setup_code import setup_code
from proc3s.sketch.box import BoxedSketch, Limits, Program
from proc3s.sketch.errors import SketchContractError, SketchError
from proc3s.solving import Solver
from proc3s.specs import MethodSpec, PresetSpec
from proc3s.state import Plan, source_text

MakeSolver: TypeAlias = Callable[[Space, int, np.random.Generator], Solver]
_MOST_UNREPEATABLE = 3


@dataclass(frozen=True)
class Setup:
    """Everything a run is made of, but for the one who proposes programs.

    `locked` is False only if the user asked for programs to run outside the kernel's lock.
    """

    problem: Problem
    method: MethodSpec
    preset: PresetSpec
    solver: str
    make_solver: MakeSolver
    executor: Executor
    limits: Limits = field(default_factory=Limits)
    clock_limits: ClockLimits = field(default_factory=ClockLimits)
    locked: bool = True
    audit: int = 0
    picture: Path | None = None


@dataclass(frozen=True)
class Opened:
    """A loaded program, what it printed, and its plan at the centre of the space if the method needs it."""

    sketch: Sketch
    log: str
    plan: Plan | None = None


@contextmanager
def open_sketch(setup: Setup, probe: bool = True) -> Iterator[Opened]:
    """Load the program of the problem in a box of its own, and draw some plans to check unless it was done
    before. Raises SketchError.
    """
    problem, method = setup.problem, setup.method
    program = Program(
        source=problem.program,
        answer=method.answer,
        prelude=setup_code(problem.domain),
        initial=source_text(problem.initial),
        signatures=problem.domain.signatures(problem.initial),
        samplers=problem.domain.samplers,
        seed=problem.seed,
    )
    with BoxedSketch(program, setup.limits, locked=setup.locked, probe=probe) as boxed:
        if method.fallback == "none" and method.perturb == "none":
            yield Opened(boxed, boxed.log)
            return
        centre = boxed.plans(np.full((1, boxed.space.dim), 0.5), first=0)
        if centre.errors and (method.perturb == "gaussian" or method.samples == "none"):
            raise centre.errors[0]  # there is nothing to perturb, or to carry out
        plan = None if centre.errors else centre.plan(0)
        yield Opened(Jitter(centre) if method.perturb == "gaussian" else boxed, boxed.log, plan)


class Repeatable:
    """Confirms an accepted trial by running its sample again in a fresh worker.

    A program that keeps state between calls, or tampered with its worker, gives another plan there.
    """

    def __init__(self, setup: Setup) -> None:
        self._setup = setup
        self._refused = 0

    def __call__(self, trial: Trial) -> SketchError | None:
        """None if the plan is the same; the third that is not ends the round (raises the error)."""
        error = self._difference(trial)
        if error is not None:
            self._refused += 1
            if self._refused == _MOST_UNREPEATABLE:
                raise error
        return error

    def _difference(self, trial: Trial) -> SketchError | None:
        try:
            with open_sketch(self._setup, probe=False) as again:
                batch = again.sketch.plans(np.array([trial.u]), trial.index)
        except SketchError as error:
            return error
        if 0 not in batch.errors and batch.plan(0) == trial.plan:
            return None
        return SketchContractError(
            "the program gave another plan when the same parameters were tried again: "
            "keep nothing between calls of gen_plan"
        )
