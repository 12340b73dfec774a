"""Plans as numbers: what `gen_plan` returned becomes skill numbers and float64 values.

`encode` is the fast path and only knows that something is wrong; `problems` then finds out what.
"""

from array import array
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from difflib import get_close_matches
from itertools import islice
from math import isfinite
from numbers import Real
from typing import Any

import numpy as np

from .wire import WIDTH

_FAITHFUL = frozenset({float, int, np.float64, np.float32, np.int64, np.int32})
"""Exact types that `array("d")` converts as they are."""
STAND_IN = float("0.5")
"""What a probe passes for a parameter without a sampler; this very object is never judged."""
_POSE = ("x", "y", "z", "roll", "pitch", "yaw")
_NAMES_SHOWN = 20


class Unfit(Exception):
    """A value or plan that cannot cross; the text says why."""


@dataclass(frozen=True)
class Param:
    """A parameter of a skill; `index` numbers the strings it may be."""

    name: str
    type: str
    index: Mapping[str, int]


@dataclass(frozen=True)
class Skill:
    """A skill as the program may use it."""

    number: int
    name: str
    params: tuple[Param, ...]

    @property
    def plain(self) -> bool:
        """Whether every parameter is one number."""
        return all(param.type in ("float", "int") for param in self.params)


def skills_from(data: Iterable[tuple[str, list[tuple[str, str, list[str]]]]]) -> dict[str, Skill]:
    """Skills by name from (name, [(parameter, type, choices)])."""
    return {
        name: Skill(number, name, tuple(Param(p, t, {c: i for i, c in enumerate(cs)}) for p, t, cs in params))
        for number, (name, params) in enumerate(data)
    }


class Encoder:
    """Turns plans into columns. `longest` is the greatest number of actions of a plan."""

    def __init__(self, skills: Mapping[str, Skill], longest: int) -> None:
        self.skills = skills
        self.longest = longest
        self._fast = {s.name: (s.number, len(s.params), None if s.plain else s) for s in skills.values()}

    def encode(self, plan: list[Any]) -> tuple[bytearray, "array[float]"]:
        """Skill numbers and values of a plan. Raises any exception if something is wrong."""
        numbers = bytearray()
        values: list[Any] = []
        table = self._fast
        if len(plan) > self.longest:
            raise Unfit("too many actions")
        for action in plan:
            number, arity, skill = table[action.name]
            args = action.params
            if type(args) is not list:
                args = _sequence(args)
            if len(args) != arity:
                raise Unfit("wrong number of values")
            values += args if skill is None else _columns(args, skill)
            numbers.append(number)
        if not _FAITHFUL.issuperset(map(type, values)):
            values = [_number(value) for value in values]
        return numbers, array("d", values)

    def problems(self, plan: Any) -> Iterator[tuple[str, Any]]:
        """What is wrong with a plan: (message, the action or None)."""
        if plan is None:
            yield "gen_plan returned None (is `return plan` missing?)", None
        elif not isinstance(plan, list):
            yield f"the plan is {shown(plan)}, expected a list of actions", None
        elif not plan:
            yield "the plan is empty", None
        elif len(plan) > self.longest:
            yield f"the plan has more than {self.longest} actions", None
        else:
            for step, action in enumerate(plan):
                for text in self._action_problems(action):
                    yield f"step {step}{text}", action

    def _action_problems(self, action: Any) -> Iterator[str]:
        try:
            name, args = action.name, action.params
        except AttributeError:
            yield f" is {shown(action)}, expected an Action"
            return
        skill = self.skills.get(name) if isinstance(name, str) else None
        if skill is None:
            yield f": unknown skill {shown(name)}{near(name, self.skills)}"
            return
        try:
            args = _sequence(args)
        except Unfit as error:
            yield f", {skill.name}: the values {error}"
            return
        if len(args) != len(skill.params):
            expected = ", ".join(param.name for param in skill.params)
            yield f": {skill.name} takes {len(skill.params)} values ({expected}), got {len(args)}"
            return
        for value, param in zip(args, skill.params, strict=True):
            if value is not STAND_IN:
                try:
                    _check(value, param)
                except Unfit as error:
                    yield f", {skill.name}: {param.name} {error}"


def as_list(plan: Any, longest: int) -> Any:
    """A plan given as tuple, generator or array, as a list; anything else unchanged."""
    if isinstance(plan, str | bytes | dict) or not hasattr(plan, "__iter__"):
        return plan
    return list(islice(plan, longest + 1))


def shown(value: Any) -> str:
    """A value in an error message; not a drawn number, so that many samples can share a message."""
    if isinstance(value, str):
        return repr(str.__str__(value)[:60])
    if isinstance(value, float | np.floating) and isfinite(value):
        return "a number"
    if value is None or isinstance(value, bool | float | np.generic):
        return str(value)[:60]
    if isinstance(value, int):
        return str(value) if value.bit_length() < 200 else "a huge integer"
    return f"of type {type(value).__name__[:60]}"


def did_you_mean(name: Any, known: Collection[str]) -> str:
    """A hint to append to a message if a known name is close."""
    close = get_close_matches(str.__str__(name)[:60], known, n=1) if isinstance(name, str) else []
    return f"; did you mean {close[0]!r}?" if close else ""


def near(name: Any, known: Collection[str]) -> str:
    """A hint to append to a message: the name that was probably meant, and those there are."""
    if hint := did_you_mean(name, known):
        return hint
    return f"; there is {_listed(known)}" if known else ""


def _sequence(args: Any) -> Sequence[Any]:
    if isinstance(args, np.ndarray) and args.ndim == 1:
        return list(args)
    if isinstance(args, list | tuple):
        return args
    raise Unfit(f"are {shown(args)}, expected a list")


def _columns(args: Sequence[Any], skill: Skill) -> list[Any]:
    columns: list[Any] = []
    for value, param in zip(args, skill.params, strict=True):
        if param.type in ("float", "int"):
            columns.append(value)
        elif param.type in ("str", "object"):
            columns.append(param.index[value])
        else:
            columns += _vector(value, param.type)
    return columns


def _vector(value: Any, kind: str) -> list[float]:
    if WIDTH[kind] == len(_POSE) and all(hasattr(value, name) for name in _POSE):
        return [_number(getattr(value, name)) for name in _POSE]
    if hasattr(value, "__iter__") and not isinstance(value, str | bytes | dict | set):
        numbers = [_number(number) for number in islice(value, WIDTH[kind] + 1)]
        if len(numbers) == WIDTH[kind]:
            return numbers
        raise Unfit(f"has {len(numbers)} numbers, expected {WIDTH[kind]}")
    wanted = "3 numbers" if kind == "point" else f"a {kind} (x, y, z, roll, pitch, yaw)"
    raise Unfit(f"is {shown(value)}, expected {wanted}")


def _number(value: Any) -> float:
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.item()
    if isinstance(value, Real | Decimal) and not isinstance(value, bool):
        try:
            return float(value)
        except OverflowError:
            raise Unfit("is a huge integer, expected a finite number") from None
    raise Unfit(f"is {shown(value)}, expected a number")


def _check(value: Any, param: Param) -> None:
    """Raise Unfit, saying all that can be said, if a value does not fit a parameter."""
    if param.type in ("str", "object"):
        if not isinstance(value, str) or value not in param.index:
            raise Unfit(_misnamed(value, param))
        return
    numbers = [_number(value)] if WIDTH[param.type] == 1 else _vector(value, param.type)
    for number in numbers:
        if not isfinite(number):
            raise Unfit(f"is {number}, expected a finite number")
        if param.type == "int" and not number.is_integer():
            raise Unfit("must be a whole number")


def _misnamed(value: Any, param: Param) -> str:
    what = "the name of an object" if param.type == "object" else "one of its choices"
    return f"is {shown(value)}, expected {what}; there is {_listed(param.index) or 'none'}"


def _listed(names: Collection[str]) -> str:
    return ", ".join(islice(names, _NAMES_SHOWN)) + (", …" if len(names) > _NAMES_SHOWN else "")
