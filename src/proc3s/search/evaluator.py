"""The evaluator: samples in, trials out, in order."""

import dataclasses
import functools
from collections import Counter
from collections.abc import Callable, Container, Generator, Iterator
from contextlib import closing
from typing import TypeAlias

import numpy as np

from proc3s.domain.plan_batch import PlanBatch
from proc3s.domain.values import FloatArray, Plan
from proc3s.errors import blame
from proc3s.sandbox.errors import SketchError
from proc3s.search.clock import Clock
from proc3s.search.executor import Executor
from proc3s.search.problem import Problem
from proc3s.search.screen_audit import Audit
from proc3s.search.screens import BatchScreen
from proc3s.search.sketch import Sketch
from proc3s.search.trial import Trial

Confirm: TypeAlias = Callable[[Trial], SketchError | None]


ALIKE = 64
"""A search ends if its first samples, this many, all raised the same exception at the same line."""


_FIRST = (4, 16, ALIKE - 20)
"""So many samples are grounded at first: an easy problem with a slow program does not need the others, nor
does a program that always fails."""


class Evaluator:
    """Takes verdicts on samples of one problem. Equal plans are rolled out once.

    Vectorised screens see whole batches here, before any action is made; what they pass goes to the
    executor. `samples` counts verdicts taken, `evaluations` plans that a world was given (and
    `rehearsals` of those it accepted), `rejected_by`
    samples that a screen rejected, by its name; `audit` is offered those, `review` only those of screens
    that are not exact. `confirm` has the last word on a
    trial that the world accepts: it may return the error it becomes.
    """

    def __init__(
        self,
        problem: Problem,
        sketch: Sketch,
        executor: Executor,
        confirm: Confirm = lambda trial: None,
        audit: Audit | None = None,
        review: Audit | None = None,
    ) -> None:
        self.problem = problem
        self.sketch = sketch
        self._executor = executor
        self._confirm = confirm
        self._audit, self._review = audit, review
        self._exact = {spec.name for spec in problem.domain.screens if spec.exact}
        self._screens = [BatchScreen(spec, problem) for spec in problem.active_screens(stateful=False)]
        self._known: dict[bytes, Trial] = {}
        self.samples = 0
        self.evaluations = 0
        self.rehearsals = 0
        self.rejected_by: Counter[str] = Counter({spec.name: 0 for spec in problem.domain.screens})
        self.clock = Clock("program", "screens", "world")
        self._first = iter(_FIRST)

    def stream(self, u: FloatArray) -> Iterator[Trial]:
        """The trials of the samples u, shape (n, dim), in order; closing the iterator cancels the rest.

        Raises SketchError after the trials that were finished if the program had to be stopped.
        """
        at = 0
        while at < len(u):
            part = u[at : at + next(self._first, len(u))]
            at += len(part)
            yield from self._stream(part)

    def _stream(self, u: FloatArray) -> Iterator[Trial]:
        batch, halted = self._plans(u)
        settled = self._settled(batch, u)
        # Actions are made when the executor takes a plan, so none are made far behind an accepted one.
        with closing(self._verdicts(batch, settled)) as verdicts:
            for i in range(len(batch)):
                trial = settled.get(i) or self._rolled_out(_key(batch, i), verdicts, u[i])
                self.samples += 1
                if trial.screen is not None:
                    self._rejected(trial, functools.partial(batch.plan, i))
                elif trial.accepted and (refusal := self._confirm(trial)):
                    trial = Trial(error=refusal, index=trial.index, u=trial.u)
                yield trial
        if halted is not None:
            raise halted

    def _plans(self, u: FloatArray) -> tuple[PlanBatch, SketchError | None]:
        """The plans that the program finished, and what stopped it if something did."""
        with self.clock("program"):
            try:
                return self.sketch.plans(u, self.samples), None
            except SketchError as error:
                if error.done is None:
                    raise
                return error.done, error

    def _settled(self, batch: PlanBatch, u: FloatArray) -> dict[int, Trial]:
        """Trials of the samples that need no world; each screen sees what the ones before it let pass."""
        rows, first = u.tolist(), self.samples
        settled: dict[int, Trial] = {}
        with self.clock("screens"):
            passed = np.array([i for i in range(len(batch)) if i not in batch.errors], np.intp)
            for screen in self._screens:
                verdicts = screen(batch.select(passed))
                for i, violation in zip(passed.tolist(), verdicts, strict=True):
                    if violation is not None:
                        settled[i] = Trial(
                            violations=(violation,),
                            reached=violation.step,
                            screen=screen.name,
                            index=first + i,
                            u=tuple(rows[i]),
                        )
                passed = passed[[violation is None for violation in verdicts]]
        for i, error in batch.errors.items():
            settled[i] = Trial(error=error, index=first + i, u=tuple(rows[i]))
        return settled

    def _rolled_out(self, key: bytes, verdicts: Iterator[Trial], row: FloatArray) -> Trial:
        """The trial of a sample with this plan; `verdicts` are those of the plans not known yet."""
        if key not in self._known:
            with self.clock("world"), blame("executor"):
                self._known[key] = trial = next(verdicts)
            self.evaluations += trial.screen is None
            self.rehearsals += trial.rehearsals
        return dataclasses.replace(self._known[key], index=self.samples, u=tuple(row.tolist()))

    def _verdicts(self, batch: PlanBatch, settled: Container[int]) -> Generator[Trial, None, None]:
        """Trials of the plans that are not known yet, in order; closing it closes what the executor gave."""

        def fresh() -> Iterator[Plan]:
            asked: set[bytes] = set()
            for i in range(len(batch)):
                if i not in settled and (key := _key(batch, i)) not in self._known and key not in asked:
                    asked.add(key)
                    yield batch.plan(i)

        yield from self._executor.map(self.problem, fresh())

    def _rejected(self, trial: Trial, plan: Callable[[], Plan]) -> None:
        assert trial.screen
        self.rejected_by[trial.screen] += 1
        if self._audit:
            self._audit.offer(plan, trial)
        if self._review and trial.screen not in self._exact:
            self._review.offer(plan, trial)


def _key(batch: PlanBatch, i: int) -> bytes:
    """The same for equal plans of one program, without making their actions."""
    first, last = batch.start[i], batch.start[i + 1]
    values = batch.values[batch.offset[first] : batch.offset[last]] + 0.0  # minus zero equals zero
    return bytes(batch.skill[first:last].tobytes() + values.tobytes())
