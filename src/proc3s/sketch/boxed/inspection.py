"""Reads what a program defines: parameters of `gen_plan`, samplers of `gen_domain`, and on which lines."""

import ast
import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from math import isfinite
from numbers import Real
from typing import Any

import numpy as np

from .encoding import Unfit, near, shown
from .wire import MOST_PARAMETERS

_MOST_VALUES = 1000
_LONGEST_TEXT = 200
_VARIADIC: dict[Any, str] = {inspect.Parameter.VAR_POSITIONAL: "*", inspect.Parameter.VAR_KEYWORD: "**"}

Problem = tuple[str, int | None]
"""A message and the line it is about."""


@dataclass
class Parameter:
    """A parameter of gen_plan, with the name and arguments of its sampler once it is known."""

    name: str
    line: int | None
    optional: bool
    by_keyword: bool
    sampler: str | None = None
    args: dict[str, Any] = field(default_factory=dict)
    choices: list[Any] | None = None


class Lines:
    """Where a program defines what, from its syntax tree; the last definition counts."""

    def __init__(self, tree: ast.Module) -> None:
        self._functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}
        self._assigned = {
            target.id: node.lineno
            for node in tree.body
            if isinstance(node, ast.Assign | ast.AnnAssign)
            for target in (node.targets if isinstance(node, ast.Assign) else [node.target])
            if isinstance(target, ast.Name)
        }
        self._keys = dict(_keys(self._functions.get("gen_domain")))

    def of(self, name: str) -> int | None:
        """The line of a function or of an assignment to a global name."""
        return self._functions[name].lineno if name in self._functions else self._assigned.get(name)

    def of_parameter(self, name: str) -> int | None:
        """The line of a parameter of gen_plan."""
        if "gen_plan" not in self._functions:
            return None
        args = self._functions["gen_plan"].args
        every = [*args.posonlyargs, *args.args, *args.kwonlyargs, *filter(None, (args.vararg, args.kwarg))]
        return next((arg.lineno for arg in every if arg.arg == name), None)

    def of_key(self, name: Any) -> int | None:
        """The line on which gen_domain gives a parameter its sampler."""
        return self._keys.get(name, self.of("gen_domain"))


def _keys(function: ast.FunctionDef | None) -> Iterator[tuple[str, int]]:
    for node in ast.walk(function) if function else ():
        if isinstance(node, ast.Dict):
            found: list[ast.expr | None] = list(node.keys)
        elif isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store):
            found = [node.slice]
        else:
            found = []
            if isinstance(node, ast.keyword) and node.arg:
                yield node.arg, node.value.lineno
        for key in found:
            if isinstance(key, ast.Constant) and isinstance(key.value, str):
                yield key.value, key.lineno


def read_parameters(gen_plan: Callable[..., Any], lines: Lines, problems: list[Problem]) -> list[Parameter]:
    """The parameters after the state."""
    parameters = list(inspect.signature(gen_plan).parameters.values())
    for parameter in parameters:
        if parameter.kind in _VARIADIC:
            star = _VARIADIC[parameter.kind]
            text = f"gen_plan must name its parameters, {star}{parameter.name} is not allowed"
            problems.append((text, lines.of_parameter(parameter.name)))
    named = [p for p in parameters if p.kind not in _VARIADIC]
    if not named:
        problems.append(("gen_plan must take the state as its first parameter", lines.of("gen_plan")))
    if len(named) - 1 > MOST_PARAMETERS:
        text = f"gen_plan has {len(named) - 1} parameters, at most {MOST_PARAMETERS} are possible"
        problems.append((text, lines.of("gen_plan")))
    return [
        Parameter(
            name=p.name,
            line=lines.of_parameter(p.name),
            optional=p.default is not p.empty,
            by_keyword=p.kind is p.KEYWORD_ONLY,
        )
        for p in named[1 : MOST_PARAMETERS + 1]
    ]


def takes_state(gen_domain: Callable[..., Any]) -> bool:
    """Whether gen_domain can be called with the state alone."""
    try:
        inspect.signature(gen_domain).bind(None)
    except TypeError:
        return False
    return True


def attach_samplers(
    domain: Any,
    parameters: list[Parameter],
    samplers: Mapping[str, Mapping[str, Any]],
    lines: Lines,
    problems: list[Problem],
) -> list[Parameter]:
    """Give each parameter the sampler that gen_domain returned for it; defaults drop out."""
    if not isinstance(domain, dict):
        text = f"gen_domain returned {_described(domain)}, expected a dict of parameter names to samplers"
        problems.append((text, lines.of("gen_domain")))
        return parameters
    names = [parameter.name for parameter in parameters]
    for key in domain:
        if key not in names:
            text = f"gen_domain names {shown(key)}, which is no parameter of gen_plan{near(key, names)}"
            problems.append((text, lines.of_key(key)))
    for parameter in parameters:
        _attach(domain, parameter, samplers, lines, problems)
    return _without_defaults(parameters, domain)


def _without_defaults(parameters: list[Parameter], domain: dict[Any, Any]) -> list[Parameter]:
    kept, gap = [], False
    for parameter in parameters:
        if parameter.name in domain or not parameter.optional:
            # what follows a gap cannot cross by position
            parameter.by_keyword |= gap
            kept.append(parameter)
        else:
            gap = True
    return kept


def _attach(
    domain: dict[Any, Any],
    parameter: Parameter,
    samplers: Mapping[str, Mapping[str, Any]],
    lines: Lines,
    problems: list[Problem],
) -> None:
    if parameter.name in domain:
        parameter.line = lines.of_key(parameter.name)
        try:
            _read_sampler(domain[parameter.name], parameter, samplers)
        except Unfit as error:
            problems.append((f"gen_domain: {parameter.name} {error}", parameter.line))
    elif not parameter.optional:
        problems.append(
            (f"parameter {parameter.name!r} of gen_plan has no sampler in gen_domain", parameter.line)
        )


def _read_sampler(value: Any, parameter: Parameter, samplers: Mapping[str, Mapping[str, Any]]) -> None:
    # by name, since programs like to repeat the class definitions that the prompt showed them
    name = next((c.__name__ for c in type(value).__mro__ if c.__name__ in samplers), None)
    if name is None:
        what = f"the class {value.__name__} itself" if isinstance(value, type) else _described(value)
        raise Unfit(f"is {what}, expected a sampler ({', '.join(samplers)})")
    args: dict[str, Any] = {}
    for key, kind in samplers[name]["params"].items():
        args[key] = (_values if kind == "list" else _bound)(getattr(value, key, None), key)
    parameter.sampler, parameter.args = name, args
    if samplers[name]["gives"] == "choice":
        parameter.choices = next(iter(args.values()))


def _bound(value: Any, key: str) -> float:
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.item()
    if not isinstance(value, Real) or isinstance(value, bool):
        raise Unfit(f"has {key} {_described(value)}, expected a number")
    try:
        number = float(value)
    except OverflowError:
        number = float("inf")
    if not isfinite(number):
        raise Unfit(f"has {key} {number}, expected a finite number")
    return number


def _values(values: Any, key: str) -> list[Any]:
    if isinstance(values, str | bytes | dict) or not hasattr(values, "__iter__"):
        raise Unfit(f"has {key} {_described(values)}, expected a list")
    listed = list(values) if hasattr(values, "__len__") and len(values) <= _MOST_VALUES else None
    if listed is None:
        raise Unfit(f"has more than {_MOST_VALUES} {key}")
    return [_value(value, key) for value in listed]


def _value(value: Any, key: str) -> Any:
    if isinstance(value, np.generic):
        value = value.item()
    if type(value) is str and len(value) > _LONGEST_TEXT:
        raise Unfit(
            f"has a text of {len(value)} characters among its {key}, at most {_LONGEST_TEXT} are possible"
        )
    if type(value) is float and not isfinite(value):
        raise Unfit(f"has {value} among its {key}, expected finite numbers")
    if type(value) is int and value.bit_length() > 63:
        raise Unfit(f"has a huge integer among its {key}")
    if type(value) not in (str, int, float, bool):
        raise Unfit(f"has {_described(value)} among its {key}, expected numbers, strings or True/False")
    return value


def _described(value: Any) -> str:
    return (
        f"{shown(value)}" if isinstance(value, str | int | float) or value is None else _article(type(value))
    )


def _article(kind: type) -> str:
    name = kind.__name__[:60]
    return f"{'an' if name[:1].lower() in 'aeiou' else 'a'} {name}"
