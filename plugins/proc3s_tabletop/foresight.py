"""What the vectorised screens share: the plans still looked at, and the violations found in the others."""

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

import numpy as np

from proc3s import Domain, FloatArray, PlanBatch, State, Violation, sentence
from proc3s_tabletop.constraints import called
from proc3s_tabletop.layout import Rows

BAND = 0.001
"""What is nearer to the edge than this is left to the world, m."""

WORLD, CONSTRAINTS = "proc3s_tabletop.world", "proc3s_tabletop.constraints:"
"""Only of the toolbox's own skills and constraints is it known what they do."""

Verdicts: TypeAlias = list[Violation | None]
Details: TypeAlias = Callable[[int], Mapping[str, str]]
"""The details of a violation's sentence, for the i-th of the plans rejected together."""


class Foresight:
    """Goes through the actions of a batch, step by step, as long as it is certain what they lead to."""

    def __init__(self, state: State, batch: PlanBatch, domain: Domain) -> None:
        self._objects: Mapping[str, Any] = state.objects  # type: ignore[attr-defined]
        self._batch = batch
        self._specs = {name: spec for name, spec in domain.spec.constraints.items() if _ours(spec.target)}
        self._skills = {name for name, spec in domain.spec.skills.items() if spec.target == f"{WORLD}:{name}"}
        self._lengths = np.diff(batch.start)
        self.open = self._lengths > 0
        """The plans still looked at."""
        self.verdicts: Verdicts = [None] * len(batch)

    @property
    def steps(self) -> range:
        """The steps of the longest plan."""
        return range(int(self._lengths.max(initial=0)))

    def at(self, step: int, skill: str, width: int = 3) -> tuple[Rows, FloatArray]:
        """The plans whose step is this skill, and the columns of its parameters, shape (rows, width)."""
        batch = self._batch
        rows = np.flatnonzero(self.open & (self._lengths > step))
        actions = batch.start[rows] + step
        known = np.array([s.skill == skill for s in batch.signatures])
        mine = known[batch.skill[actions]]
        values = batch.values[batch.offset[actions[mine], None] + np.arange(width)]
        return rows[mine], values

    def args(self, constraint: str) -> Mapping[str, Any]:
        """The arguments of a constraint; none if the domain does not have it."""
        return self._specs[constraint].args if constraint in self._specs else {}

    def leave(self, rows: Rows) -> None:
        """Look at plans no more."""
        self.open[rows] = False

    def leave_all_but(self, skills: frozenset[str], step: int) -> bool:
        """Look no more at plans whose step is another skill; whether there are any that have the step."""
        batch = self._batch
        rows = np.flatnonzero(self.open & (self._lengths > step))
        known = np.array([s.skill in skills & self._skills for s in batch.signatures])
        mine = known[batch.skill[batch.start[rows] + step]]
        self.leave(rows[~mine])
        return bool(mine.any())

    def reject(
        self, step: int, skill: str, constraint: str, rows: Rows, margins: FloatArray, details: Details
    ) -> None:
        """A violation for each of these plans; they are looked at no more.

        `margins` (rows,) are negative by what is certain. A domain without the constraint rejects nothing.
        """
        self.leave(rows)
        if constraint in self._specs:
            spec = self._specs[constraint]
            for i in np.flatnonzero(margins < -spec.tolerance).tolist():
                text = sentence(spec, details(i))
                self.verdicts[rows[i]] = Violation(constraint, step, skill, float(margins[i]), text)

    def called(self, name: str) -> str:
        """A body for people."""
        return called(self._objects, name)


def _ours(target: str) -> bool:
    """Whether a constraint is one of the toolbox's."""
    return target.startswith(CONSTRAINTS)
