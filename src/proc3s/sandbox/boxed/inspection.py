"""Reads what a program defines: the parameters of `gen_plan` and the samplers of `gen_domain`."""

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from decimal import Decimal
from fractions import Fraction
from itertools import islice
from math import isfinite
from numbers import Real
from typing import Any, cast

import numpy as np

from .encoding import Unfit, did_you_mean, near, shown
from .lines import Lines, as_python_reads
from .wire import LONGEST_NAME, MOST_PARAMETERS, MOST_PROBLEMS, MOST_VALUES

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
    made: str | None = None
    """The class that the numbers of the sampler become."""


class Inspector:
    """Reads functions of one program and collects what is wrong with them in `problems`."""

    def __init__(self, lines: Lines, samplers: Mapping[str, Mapping[str, Any]]) -> None:
        self.lines = lines
        self.samplers = samplers
        self.problems: list[Problem] = []

    def function(self, name: str, names: Mapping[str, Any]) -> Callable[..., Any] | None:
        """The program's function of that name, if there is one."""
        value = names.get(name)
        if callable(value):
            return cast(Callable[..., Any], value)
        if value is None:
            own = [n for n, v in names.items() if getattr(v, "__module__", "") == "program"]
            self.add(f"the program does not define {name}{did_you_mean(name, own)}", name)
        else:
            self.add(f"{name} is {shown(value)}, expected a function", name)
        return None

    def add(self, text: str, name: str) -> None:
        """Note a problem with a global name."""
        self.problems.append((text, self.lines.of(name)))

    def parameters(self, gen_plan: Callable[..., Any]) -> list[Parameter]:
        """The parameters of gen_plan after the state."""
        every = list(inspect.signature(gen_plan).parameters.values())
        for p in every:
            if p.kind in _VARIADIC:
                text = f"gen_plan must name its parameters, {_VARIADIC[p.kind]}{p.name} is not allowed"
                self.problems.append((text, self.lines.of_parameter(p.name)))
            elif len(p.name) > LONGEST_NAME:
                text = f"gen_plan has a parameter name of more than {LONGEST_NAME} characters"
                self.problems.append((text, self.lines.of_parameter(p.name)))
        named = [p for p in every if p.kind not in _VARIADIC and len(p.name) <= LONGEST_NAME]
        if not named:
            self.add("gen_plan must take the state as its first parameter", "gen_plan")
        if len(named) - 1 > MOST_PARAMETERS:
            text = f"gen_plan has {len(named) - 1} parameters, at most {MOST_PARAMETERS} are possible"
            self.add(text, "gen_plan")
        return [
            Parameter(
                p.name, self.lines.of_parameter(p.name), p.default is not p.empty, p.kind is p.KEYWORD_ONLY
            )
            for p in named[1 : MOST_PARAMETERS + 1]
        ]

    def takes_state(self, gen_domain: Callable[..., Any]) -> bool:
        """Whether gen_domain can be called with the state alone."""
        try:
            inspect.signature(gen_domain).bind(None)
        except TypeError:
            self.add("gen_domain must take the state as its only parameter", "gen_domain")
            return False
        return True

    def with_samplers(self, parameters: list[Parameter], domain: Any) -> list[Parameter]:
        """The parameters with what gen_domain returned for them, less those left to their default."""
        if not isinstance(domain, dict):
            text = f"gen_domain returned {_described(domain)}, expected a dict of parameter names to samplers"
            self.add(text, "gen_domain")
            return parameters
        domain = {as_python_reads(key): value for key, value in domain.items()}
        names = [parameter.name for parameter in parameters]
        for key in domain:
            if len(self.problems) >= MOST_PROBLEMS:
                break
            if key not in names:
                text = f"gen_domain names {shown(key)}, which is no parameter of gen_plan{near(key, names)}"
                self.problems.append((text, self.lines.of_key(key)))
        for parameter in parameters:
            self._attach(parameter, domain)
        return _without_defaults(parameters, domain)

    def _attach(self, parameter: Parameter, domain: dict[Any, Any]) -> None:
        if parameter.name in domain:
            parameter.line = self.lines.of_key(parameter.name)
            try:
                _read_sampler(domain[parameter.name], parameter, self.samplers)
            except Unfit as error:
                self.problems.append((f"gen_domain: {parameter.name} {error}", parameter.line))
        elif not parameter.optional:
            text = f"parameter {parameter.name!r} of gen_plan has no sampler in gen_domain"
            self.problems.append((text, parameter.line))


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
    gives = samplers[name]["gives"]
    if gives == "choice":
        parameter.choices = next(iter(args.values()))
    elif gives != "float":
        parameter.made = gives


def _bound(value: Any, key: str) -> float:
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.item()
    if not isinstance(value, Real | Decimal) or isinstance(value, bool):
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
    listed = list(islice(values, MOST_VALUES + 1))
    if len(listed) > MOST_VALUES:
        raise Unfit(f"has more than {MOST_VALUES} {key}")
    return [_value(value, key) for value in listed]


def _value(value: Any, key: str) -> Any:
    if isinstance(value, np.generic):
        value = value.item()
    elif isinstance(value, Fraction | Decimal):
        value = float(value)
    if type(value) is str and len(value) > _LONGEST_TEXT:
        raise Unfit(f"has a text of more than {_LONGEST_TEXT} characters among its {key}")
    if type(value) is float and not isfinite(value):
        raise Unfit(f"has {value} among its {key}, expected finite numbers")
    if type(value) is int and value.bit_length() > 63:
        raise Unfit(f"has a huge integer among its {key}")
    if type(value) not in (str, int, float, bool):
        raise Unfit(f"has {_described(value)} among its {key}, expected numbers, strings or True/False")
    return value


def _described(value: Any) -> str:
    if value is None or isinstance(value, str | int | float):
        return shown(value)
    name = type(value).__name__[:60]
    return f"{'an' if name[:1].lower() in 'aeiou' else 'a'} {name}"
