"""The evaluator: samples in, trials out, in order."""

import dataclasses
import functools
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from typing import Protocol, TypeAlias

from proc3s.audit import Audit
from proc3s.clock import Clock
from proc3s.errors import blame
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

    Vectorised screens see whole batches here, before any action is made; what they pass goes to the
    executor. `samples` counts verdicts taken, `evaluations` rollouts, `rejected_by` rejections by screen.
    `confirm` has the last word on a trial that the world accepts: it may return the error it becomes.
    """

    def __init__(
        self,
        problem: Problem,
        sketch: Sketch,
        executor: Executor,
        confirm: Confirm = lambda trial: None,
        audit: Audit | None = None,
    ) -> None:
        self.problem = problem
        self._sketch = sketch
        self._executor = executor
        self._confirm = confirm
        self._audit = audit
        self._screens = [(spec, spec.load()) for spec in problem.active_screens(stateful=False)]
        self._known: dict[Plan, Trial] = {}
        self.samples = 0
        self.evaluations = 0
        self.rejected_by: Counter[str] = Counter({spec.name: 0 for spec in problem.domain.spec.screens})
        self.clock = Clock("program", "screens", "world")

    def stream(self, u: FloatArray) -> Iterator[Trial]:
        """The trials of the samples u, shape (n, dim), in order; closing the iterator cancels the rest.

        Raises SketchError after the trials that were finished if the program had to be stopped.
        """
        halted: SketchError | None = None
        with self.clock("program"):
            try:
                batch = self._sketch.plans(u, self.samples)
            except SketchError as error:
                if error.done is None:
                    raise
                batch, halted = error.done, error
        for trial, row in zip(self._trials(batch), u.tolist(), strict=False):
            trial = dataclasses.replace(trial, index=self.samples, u=tuple(row))
            self.samples += 1
            if trial.screen is not None:
                self.rejected_by[trial.screen] += 1
            if trial.accepted and (refusal := self._confirm(trial)):
                trial = Trial(error=refusal, index=trial.index, u=trial.u)
            yield trial
        if halted is not None:
            raise halted

    def _trials(self, batch: PlanBatch) -> Iterator[Trial]:
        # Actions are made when the executor takes a plan, so none are made behind an accepted one.
        plan = functools.cache(batch.plan)
        settled = self._screened(batch)
        settled |= {i: Trial(error=error) for i, error in batch.errors.items()}
        verdicts = self._executor.map(self.problem, self._fresh(batch, settled, plan))
        for i in range(len(batch)):
            if i in settled:
                if self._audit and settled[i].screen:
                    self._audit.offer(functools.partial(plan, i), settled[i].violations[0])
                yield settled[i]
                continue
            if plan(i) not in self._known:
                with self.clock("world"):
                    self._known[plan(i)] = next(verdicts)
                self.evaluations += 1
            yield self._known[plan(i)]

    def _screened(self, batch: PlanBatch) -> dict[int, Trial]:
        """Trials of the plans that a vectorised screen rejects; the first to do so gives the reason."""
        settled: dict[int, Trial] = {}
        with self.clock("screens"):
            for spec, screen in self._screens:
                with blame(f"screen {spec.name}"):
                    verdicts = screen(self.problem.initial, batch, **spec.args)
                for i, violation in enumerate(verdicts):
                    if violation is not None and i not in settled:
                        settled[i] = Trial(None, (violation,), violation.step, screen=spec.name)
        return settled

    def _fresh(
        self, batch: PlanBatch, settled: Mapping[int, Trial], plan: Callable[[int], Plan]
    ) -> Iterator[Plan]:
        asked: set[Plan] = set()
        for i in range(len(batch)):
            if i not in settled and plan(i) not in self._known and plan(i) not in asked:
                asked.add(plan(i))
                yield plan(i)
