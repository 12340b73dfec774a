"""States, poses, actions and plans: the plain data that everything else passes around."""

import dataclasses
import itertools
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, TypeAdapter

if TYPE_CHECKING:
    from proc3s.specs import FieldSpec, TypeSpec

FloatArray: TypeAlias = NDArray[np.float64]


@dataclass(frozen=True)
class Pose:
    """A rigid pose in the world frame: metres, and roll, pitch, yaw in radians (fixed axes x, y, z)."""

    x: float
    y: float
    z: float
    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0


Value: TypeAlias = float | int | str | tuple[float, ...] | Pose


@dataclass(frozen=True)
class Action:
    """A ground action: the name of a skill and one value for each of its parameters."""

    skill: str
    args: tuple[Value, ...]

    def __str__(self) -> str:
        return f"{self.skill}({', '.join(_short(value) for value in self.args)})"

    def to_json(self) -> dict[str, Any]:
        """The action as it stands in a summary; a pose becomes its six numbers."""
        return {"skill": self.skill, "args": [_plain(value) for value in self.args]}

    @classmethod
    def from_json(cls, action: Mapping[str, Any]) -> "Action":
        """The action again: six numbers are a pose, other lists points."""
        return cls(action["skill"], tuple(_value(arg) for arg in action["args"]))


Plan: TypeAlias = tuple[Action, ...]


def _plain(value: Value) -> Any:
    return list(dataclasses.astuple(value)) if isinstance(value, Pose) else value


def _value(plain: Any) -> Value:
    if not isinstance(plain, list):
        return cast(Value, plain)
    return Pose(*plain) if len(plain) == len(dataclasses.fields(Pose)) else tuple(plain)


def _short(value: Value) -> str:
    if isinstance(value, Pose):
        return _short(dataclasses.astuple(value))
    if isinstance(value, tuple):
        return "(" + ", ".join(map(_short, value)) + ")"
    return f"{value:.2f}" if isinstance(value, float) else str(value)


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


SCALARS: Mapping[str, type] = {"float": float, "int": int, "str": str, "bool": bool}
"""The types of fields that are no types of the domain."""


@dataclass(frozen=True)
class State:
    """Base of the frozen state classes that are made from the types of a `domain.yaml`."""


class StateModel:
    """The state classes of a domain: parse plain data into a frozen `State`, and dump it again.

    `types` maps the names of the spec to frozen dataclasses, `root` names the one that is the state.
    """

    def __init__(self, types: "Mapping[str, TypeSpec]", root: str) -> None:
        self.types: dict[str, type[State]] = {}
        for name in _dependency_order(types):
            self.types[name] = self._make(name, types[name].fields)
        self._adapter: TypeAdapter[State] = TypeAdapter(self.types[root])

    def parse(self, data: Mapping[str, Any] | State) -> State:
        """The state that plain data describes. Raises `pydantic.ValidationError`."""
        return self._adapter.validate_python(data)

    def dump(self, state: State) -> dict[str, Any]:
        """Plain data that `parse` turns back into an equal state; JSON can hold it."""
        data: dict[str, Any] = self._adapter.dump_python(state, mode="json")
        return data

    def _make(self, name: str, fields: "Mapping[str, FieldSpec]") -> type[State]:
        members = [(n, self._annotation(f.type), _default(f)) for n, f in fields.items()]
        made = dataclasses.make_dataclass(name, members, bases=(State,), frozen=True)
        made.__pydantic_config__ = ConfigDict(extra="forbid", allow_inf_nan=False)  # type: ignore[attr-defined]
        return made

    def _annotation(self, text: str) -> Any:
        container, inner = split_type(text)
        scalar: Any = SCALARS.get(inner) or self.types[inner]
        return {"": scalar, "list": tuple[scalar, ...], "dict": dict[str, scalar]}[container]


def _default(spec: "FieldSpec") -> Any:
    value = tuple(spec.default) if isinstance(spec.default, list) else spec.default
    if spec.required:
        return field()
    return field(default_factory=lambda: dict(value)) if isinstance(value, dict) else field(default=value)


def split_type(text: str) -> tuple[str, str]:
    """`list[Obstacle]` -> ("list", "Obstacle"); `float` -> ("", "float")."""
    container, bracket, rest = text.partition("[")
    return (container, rest.removesuffix("]")) if bracket else ("", text)


def _dependency_order(types: "Mapping[str, TypeSpec]") -> list[str]:
    done: list[str] = []

    def visit(name: str) -> None:
        if name in types and name not in done:
            for spec in types[name].fields.values():
                visit(split_type(spec.type)[1])
            done.append(name)

    for name in types:
        visit(name)
    return done


def source_text(value: Any, decimals: int | None = None) -> str:
    """A value as the Python expression that builds it: what the LLM reads and what the box evaluates.

    `decimals` rounds numbers for reading; without it every float keeps its full precision.
    Raises ValueError on a number that is not finite.
    """
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        inside = ((f.name, getattr(value, f.name)) for f in dataclasses.fields(value))
        return f"{type(value).__name__}({', '.join(f'{n}={source_text(v, decimals)}' for n, v in inside)})"
    if isinstance(value, tuple | list):
        return f"[{', '.join(source_text(v, decimals) for v in value)}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{k!r}: {source_text(v, decimals)}' for k, v in value.items())}}}"
    if isinstance(value, float):
        if not math.isfinite(value):
            raise ValueError(f"{value} is not a finite number")
        return repr(value if decimals is None else round(value, decimals) + 0.0)
    return repr(value)
