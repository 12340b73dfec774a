"""The plans of many samples as ragged columns."""

import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from proc3s.domain.values import Action, FloatArray, Plan, Pose, Value

WIDTH: Mapping[str, int] = {"float": 1, "int": 1, "str": 1, "object": 1, "point": 3, "pose": 6, "grasp": 6}
"""How many float64 columns a value of each parameter type takes in a `PlanBatch`."""


@dataclass(frozen=True)
class Parameter:
    """A typed parameter of a skill; `choices` are the strings that a `str` or `object` may be."""

    name: str
    type: str
    low: float = -math.inf
    high: float = math.inf
    noise: float = 0.0
    turn_noise: float = 0.0
    choices: tuple[str, ...] = ()


@dataclass(frozen=True)
class Signature:
    """A skill as the program sees it: a name and its parameters in order."""

    skill: str
    params: tuple[Parameter, ...]

    @property
    def width(self) -> int:
        """Columns that one action of this skill takes in a `PlanBatch`."""
        return sum(WIDTH[p.type] for p in self.params)


@dataclass(frozen=True)
class PlanBatch:
    """The plans of n samples as ragged columns, so that a batch is checked without a Python object a sample.

    Actions of sample i are `start[i]:start[i + 1]`; action a has skill `signatures[skill[a]]` and its
    values at `values[offset[a]:offset[a + 1]]`. A string stands there as an index into the choices of its
    parameter. `errors` holds the samples that have no plan.
    """

    signatures: tuple[Signature, ...]
    start: NDArray[np.int64]
    skill: NDArray[np.uint8]
    offset: NDArray[np.int64]
    values: FloatArray
    errors: Mapping[int, Exception] = field(default_factory=dict)
    logs: Mapping[int, str] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.start) - 1

    def select(self, samples: NDArray[np.intp]) -> "PlanBatch":
        """The same plans, only of these samples, in ascending order."""
        if len(samples) == len(self):
            return self
        lengths = np.diff(self.start)[samples]
        actions = _ranges(self.start[samples], lengths)
        widths = np.diff(self.offset)[actions]
        where = {int(sample): k for k, sample in enumerate(samples)}
        return PlanBatch(
            signatures=self.signatures,
            start=np.concatenate([[0], np.cumsum(lengths)]),
            skill=self.skill[actions],
            offset=np.concatenate([[0], np.cumsum(widths)]),
            values=self.values[_ranges(self.offset[actions], widths)],
            errors={where[i]: error for i, error in self.errors.items() if i in where},
            logs={where[i]: log for i, log in self.logs.items() if i in where},
        )

    def plan(self, i: int) -> Plan:
        """Sample i as ground actions. Raises the sample's own error if it has no plan."""
        if i in self.errors:
            raise self.errors[i]
        first, last = self.start[i], self.start[i + 1]
        columns = iter(self.values[self.offset[first] : self.offset[last]].tolist())
        skills = (self.signatures[k] for k in self.skill[first:last].tolist())
        return tuple(Action(s.skill, tuple(_decode(p, columns) for p in s.params)) for s in skills)


def _ranges(starts: NDArray[np.int64], lengths: NDArray[np.int64]) -> NDArray[np.int64]:
    """The numbers of every range, from its start on, one range after the other."""
    ends = np.cumsum(lengths)
    return np.arange(ends[-1] if len(ends) else 0) + np.repeat(starts - ends + lengths, lengths)


def _decode(param: Parameter, columns: Iterator[float]) -> Value:
    """Take the columns of one argument."""
    if param.type == "float":
        return next(columns)
    if param.type == "int":
        return int(next(columns))
    if param.choices:
        return param.choices[int(next(columns))]
    vector = tuple(itertools.islice(columns, WIDTH[param.type]))
    return vector if param.type == "point" else Pose(*vector)
