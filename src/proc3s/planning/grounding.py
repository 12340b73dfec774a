"""A program becomes a sketch: loaded in its box as the method wants it, and run again when it wins."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from proc3s.domain.prelude import setup_code
from proc3s.domain.source_text import source_text
from proc3s.domain.values import Plan
from proc3s.planning.parts import Setup
from proc3s.sandbox.box import BoxedSketch, Program
from proc3s.sandbox.errors import SketchContractError, SketchError
from proc3s.search.jitter import Jitter
from proc3s.search.sketch import Sketch
from proc3s.search.trial import Trial

_MOST_UNREPEATABLE = 3


@dataclass(frozen=True)
class Opened:
    """A loaded program, what it printed, and its plan at the centre of the space if the method needs it."""

    sketch: Sketch
    log: str
    plan: Plan | None = None


@contextmanager
def open_sketch(setup: Setup, source: str, probe: bool = True) -> Iterator[Opened]:
    """Load a program in a box of its own, and draw some plans to check unless it was done before.

    Raises SketchError.
    """
    problem, method = setup.problem, setup.method
    program = Program(
        source=source,
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


class ReproducibilityCheck:
    """Confirms an accepted trial by running its sample again in a fresh worker.

    A program that keeps state between calls, or tampered with its worker, gives another plan there.
    """

    def __init__(self, setup: Setup, source: str) -> None:
        self._setup, self._source = setup, source
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
            with open_sketch(self._setup, self._source, probe=False) as again:
                batch = again.sketch.plans(np.array([trial.u]), trial.index)
        except SketchError as error:
            return error
        if 0 not in batch.errors and batch.plan(0) == trial.plan:
            return None
        return SketchContractError(
            "the program gave another plan when the same parameters were tried again: "
            "keep nothing between calls of gen_plan"
        )
