"""What the vectorised screens share: the plans still looked at, and the violations found in the others."""

import functools
from collections.abc import Callable, Collection, Mapping
from typing import Any, TypeAlias

import numpy as np

from proc3s import Domain, FloatArray, PlanBatch, State, Violation, sentence
from proc3s.domain.plan_batch import Signature
from proc3s.specs.domain import ConstraintSpec
from proc3s_tabletop.engine.choice import engine
from proc3s_tabletop.robot.hand_profile import HandProfile
from proc3s_tabletop.screens.layout import Rows
from proc3s_tabletop.sentences import called
from proc3s_tabletop.skills import pick, pick_object, place, place_object

BAND = 0.001
"""What is nearer to the edge than this is left to the world, m."""

Skill: TypeAlias = Callable[..., Any]
Constraint: TypeAlias = Callable[..., Any]
TAKES: Mapping[Skill, tuple[str, ...]] = {
    pick: ("float",) * 3,
    place: ("float",) * 3,
    pick_object: ("object", "pose"),
    place_object: ("object", "pose", "pose"),
}
"""The toolbox's own skills and the types of their parameters: only of these is it known what they do."""

Verdicts: TypeAlias = list[Violation | None]
Details: TypeAlias = Callable[[int], Mapping[str, str]]
"""The details of a violation's sentence, for the i-th of the plans rejected together."""


class BatchScreening:
    """Goes through the actions of a batch, step by step, as long as it is certain what they lead to."""

    def __init__(self, state: State, batch: PlanBatch, domain: Domain) -> None:
        self._objects: Mapping[str, Any] = state.objects  # type: ignore[attr-defined]
        self._batch, self._domain = batch, domain
        self._constraints = [(domain.margins[n], spec) for n, spec in domain.spec.constraints.items()]
        self._skills = [skill_of(domain, signature) for signature in batch.signatures]
        self._lengths = np.diff(batch.start)
        self.open = self._lengths > 0
        """The plans still looked at."""
        self.verdicts: Verdicts = [None] * len(batch)

    @functools.cached_property
    def hand(self) -> HandProfile:
        """The hand as the world's engine has it."""
        return engine(self._domain.spec.world.args.get("engine")).profile()

    @property
    def steps(self) -> range:
        """The steps of the longest plan."""
        return range(int(self._lengths.max(initial=0)))

    def at(self, step: int, skill: Skill, width: int = 3) -> tuple[Rows, FloatArray]:
        """The plans whose step is this skill, and the columns of its parameters, shape (rows, width)."""
        batch = self._batch
        rows = np.flatnonzero(self.open & (self._lengths > step))
        actions = batch.start[rows] + step
        known = np.array([known is skill for known in self._skills])
        mine = known[batch.skill[actions]]
        values = batch.values[batch.offset[actions[mine], None] + np.arange(width)]
        return rows[mine], values

    def args(self, constraint: Constraint) -> Mapping[str, Any]:
        """The arguments of a constraint; none if the domain does not have it."""
        spec = self._spec(constraint)
        return spec.args if spec else {}

    def _spec(self, constraint: Constraint) -> ConstraintSpec | None:
        """Whatever the domain calls the constraint."""
        return next((spec for function, spec in self._constraints if function is constraint), None)

    def leave(self, rows: Rows) -> None:
        """Look at plans no more."""
        self.open[rows] = False

    def leave_all_but(self, skills: Collection[Skill], step: int) -> bool:
        """Look no more at plans whose step is another skill; whether there are any that have the step."""
        batch = self._batch
        rows = np.flatnonzero(self.open & (self._lengths > step))
        known = np.array([skill in skills for skill in self._skills])
        mine = known[batch.skill[batch.start[rows] + step]]
        self.leave(rows[~mine])
        return bool(mine.any())

    def first_other(self, skills: Collection[Skill]) -> Rows:
        """The first step of every plan that is another skill, or the number of its steps."""
        batch, first = self._batch, self._lengths.astype(np.intp)
        known = np.array([skill in skills for skill in self._skills])
        others = np.flatnonzero(~known[batch.skill])
        plans = np.searchsorted(batch.start, others, side="right") - 1
        np.minimum.at(first, plans, others - batch.start[plans])
        return first

    def reject(
        self, step: int, constraint: Constraint, rows: Rows, margins: FloatArray, details: Details
    ) -> None:
        """A violation for each of these plans; they are looked at no more.

        `margins` (rows,) are negative by what is certain. A domain without the constraint rejects nothing.
        """
        self.leave(rows)
        if spec := self._spec(constraint):
            for i in np.flatnonzero(margins < -spec.tolerance).tolist():
                text, skill = sentence(spec, details(i)), self._called(rows[i], step)
                self.verdicts[rows[i]] = Violation(spec.name, step, skill, float(margins[i]), text)

    def _called(self, row: int, step: int) -> str:
        """What the domain calls the skill of a step."""
        batch = self._batch
        signature: Signature = batch.signatures[batch.skill[batch.start[row] + step]]
        return signature.skill

    def called(self, name: str) -> str:
        """A body for people."""
        return called(self._objects, name)


def skill_of(domain: Domain, signature: Signature) -> Skill | None:
    """The toolbox's skill that a domain has under any name; None for a function of its own."""
    function: Skill = domain.skill(signature.skill)
    alike = {"int": "float", "grasp": "pose"}
    types = tuple(alike.get(p.type, p.type) for p in signature.params)
    return next((known for known, taken in TAKES.items() if known is function and taken == types), None)
