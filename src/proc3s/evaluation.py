"""The evaluator: samples in, trials out, in order."""

import dataclasses
import functools
from collections.abc import Callable, Iterator
from typing import Protocol, TypeAlias

from proc3s.executors import Executor
from proc3s.problem import Problem, Trial
from proc3s.samplers import Space
from proc3s.sketch.errors import SketchError
from proc3s.state import FloatArray, Plan, PlanBatch


class Sketch(Protocol):
    """A program with open parameters: `space` says which, `plans` grounds it."""

    @property
    def space(self) -> Space:
        """The open parameters."""
        ...

    def plans(self, u: FloatArray, first: int) -> PlanBatch:
        """The plans of the samples u, shape (n, dim), numbered from `first`.

        The number seeds what the program draws itself. Raises SketchError, with what was done before.
        """
        ...


Confirm: TypeAlias = Callable[[Trial], SketchError | None]


class Evaluator:
    """Takes verdicts on samples of one problem. Equal plans are rolled out once.

    `samples` counts verdicts taken, `evaluations` counts rollouts. `confirm` has the last word on a trial
    that the world accepts: it may return the error that the trial becomes.
    """

    def __init__(
        self, problem: Problem, sketch: Sketch, executor: Executor, confirm: Confirm = lambda trial: None
    ) -> None:
        self.problem = problem
        self._sketch = sketch
        self._executor = executor
        self._confirm = confirm
        self._known: dict[Plan, Trial] = {}
        self.samples = 0
        self.evaluations = 0

    def stream(self, u: FloatArray) -> Iterator[Trial]:
        """The trials of the samples u, shape (n, dim), in order; closing the iterator cancels the rest.

        Raises SketchError after the trials that were finished if the program had to be stopped.
        """
        halted: SketchError | None = None
        try:
            batch = self._sketch.plans(u, self.samples)
        except SketchError as error:
            if error.done is None:
                raise
            batch, halted = error.done, error
        for i, trial in enumerate(self._trials(batch)):
            trial = dataclasses.replace(trial, index=self.samples, u=tuple(u[i].tolist()))
            self.samples += 1
            if trial.accepted and (refusal := self._confirm(trial)):
                trial = Trial(error=refusal, index=trial.index, u=trial.u)
            yield trial
        if halted is not None:
            raise halted

    def _trials(self, batch: PlanBatch) -> Iterator[Trial]:
        # Actions are made when the executor takes a plan, so none are made behind an accepted one.
        plan = functools.cache(batch.plan)
        verdicts = self._executor.map(self.problem, self._fresh(batch, plan))
        for i in range(len(batch)):
            if i in batch.errors:
                yield Trial(error=batch.errors[i])
                continue
            if plan(i) not in self._known:
                self._known[plan(i)] = next(verdicts)
                self.evaluations += 1
            yield self._known[plan(i)]

    def _fresh(self, batch: PlanBatch, plan: Callable[[int], Plan]) -> Iterator[Plan]:
        asked: set[Plan] = set()
        for i in range(len(batch)):
            if i not in batch.errors and plan(i) not in self._known and plan(i) not in asked:
                asked.add(plan(i))
                yield plan(i)
