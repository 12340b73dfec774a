"""A vectorised screen at work on the plans of a batch."""

import inspect
from collections.abc import Sequence

from proc3s.domain.margins import Violation
from proc3s.domain.plan_batch import PlanBatch
from proc3s.errors import Issue, SpecError, blame, not_wanted
from proc3s.search.problem import Problem
from proc3s.specs.domain import ScreenSpec


class BatchScreen:
    """A vectorised screen at work on one problem; it is given the domain if it has a parameter `domain`."""

    def __init__(self, spec: ScreenSpec, problem: Problem) -> None:
        self.name = spec.name
        self._initial = problem.initial
        self._check = spec.load()
        wants = inspect.signature(self._check).parameters
        self._args = spec.args | ({"domain": problem.domain} if "domain" in wants else {})

    def __call__(self, batch: PlanBatch) -> Sequence[Violation | None]:
        """A violation or None for every plan. Raises SpecError for anything else."""
        with blame(f"screen {self.name}"):
            verdicts = self._check(self._initial, batch, **self._args)
        part = f"screen {self.name}"
        if not isinstance(verdicts, Sequence) or not all(isinstance(v, Violation | None) for v in verdicts):
            raise not_wanted(part, verdicts, "a list with a Violation or None for every plan")
        if len(verdicts) != len(batch):
            raise SpecError([Issue(part, "target", f"gave {len(verdicts)} verdicts on {len(batch)} plans")])
        return verdicts
