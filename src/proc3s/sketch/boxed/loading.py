"""Loads a program and checks what can be checked before sampling."""

import ast
import random
from collections.abc import Callable, Sequence
from itertools import islice
from types import TracebackType
from typing import Any, cast

import numpy as np

from .encoding import STAND_IN, Encoder, as_list, did_you_mean, shown, skills_from
from .inspection import Lines, Parameter, Problem, attach_samplers, read_parameters, takes_state
from .namespace import new_module, noting_lines, program_names
from .wire import FILENAME, MOST_PROBLEMS

Row = Sequence[float]


class LoadError(Exception):
    """Loading failed at a stage: `prelude`, `syntax` or `runtime`; the cause is the exception."""

    def __init__(self, stage: str) -> None:
        self.stage = stage


class Program:
    """A loaded program. `plan(sample, row)` is what it answers for one row of parameters."""

    def __init__(self, request: dict[str, Any], importable: tuple[str, ...]) -> None:
        self.answer: str = request["answer"]
        self.seed: int = request["seed"]
        self.encoder = Encoder(skills_from(request["signatures"]), request["actions"])
        self._random = "rand" in request["source"]
        self._call: Callable[[Row], Any]
        self.problems: list[Problem] = []
        self.parameters: list[Parameter] = []
        prelude = self._prelude(request)
        self._lines = Lines(self._parse(request["source"]))
        self._names = new_module("program", program_names(prelude, importable))
        self._action = prelude["Action"]
        self._reseed(0)
        with noting_lines(self._action, FILENAME, spread=self.answer == "plan") as self._made:
            self._execute(request["source"])
        self._define(request["samplers"])

    def plan(self, sample: int, row: Row) -> Any:
        """The plan for one row: a list if it is one at all. Raises what the program raises."""
        if self._random:
            self._reseed(sample)
        plan = self._call(row)
        return plan if type(plan) is list else as_list(plan, self.encoder.longest)

    def probe(self, row: list[float | None]) -> list[Problem]:
        """What one call shows to be wrong with the actions; None in the row stands for a missing sampler."""
        if not self.complete:
            return []
        stand_in = [STAND_IN if value is None else value for value in row]
        try:
            with noting_lines(self._action, FILENAME, spread=False) as made:
                plan = self.plan(0, stand_in)
            found = list(islice(self.encoder.problems(plan), MOST_PROBLEMS))
        except BaseException:  # the samples will tell; it is no breach of the contract
            return []
        lines = self._made | made
        return [(text, lines.get(id(action)) or self._lines.of("gen_plan")) for text, action in found]

    @property
    def complete(self) -> bool:
        """Whether there is a gen_plan that can be asked."""
        gen_plan = self._names.get("gen_plan")
        return gen_plan is not None and callable(gen_plan) is (self.answer != "plan")

    def _prelude(self, request: dict[str, Any]) -> dict[str, Any]:
        try:
            names = new_module("prelude", {})
            exec(compile(request["prelude"], "<prelude>", "exec"), names)  # noqa: S102
            state = compile(f"lambda: ({request['initial']}\n)", "<state>", "eval")
            self._new_state = cast(Callable[[], Any], eval(state, names))  # noqa: S307
            self._new_state()
        except Exception as error:
            raise LoadError("prelude") from error
        return names

    def _parse(self, source: str) -> ast.Module:
        try:
            return ast.parse(source, FILENAME)
        except (SyntaxError, ValueError, RecursionError) as error:
            raise LoadError("syntax") from error

    def _execute(self, source: str) -> None:
        try:
            code = compile(source, FILENAME, "exec")
        except (SyntaxError, ValueError, RecursionError) as error:
            raise LoadError("syntax") from error
        try:
            exec(code, self._names)  # noqa: S102
        except BaseException as error:
            raise LoadError("runtime") from error

    def _define(self, samplers: dict[str, Any]) -> None:
        gen_plan: Any = self._names.get("gen_plan")
        if self.answer == "plan":
            plan = as_list(gen_plan, self.encoder.longest)
            self._call = lambda row: plan
            if gen_plan is None or callable(gen_plan):
                self._problem("gen_plan must be a list of actions: gen_plan = [Action(...), ...]", "gen_plan")
            return
        if self._is_function("gen_plan"):
            self.parameters = read_parameters(self._names["gen_plan"], self._lines, self.problems)
        if self.answer == "sketch":
            self._read_domain(samplers)
        elif required := [p for p in self.parameters if not p.optional]:
            names = ", ".join(p.name for p in required)
            self._problem(f"gen_plan must take the state and nothing else, not {names}", "gen_plan")
        if self.answer == "program":
            self.parameters = []
        self._call = _caller(gen_plan, self._new_state, self.parameters)

    def _read_domain(self, samplers: dict[str, Any]) -> None:
        if not self._is_function("gen_domain"):
            return
        gen_domain = self._names["gen_domain"]
        if not takes_state(gen_domain):
            self._problem("gen_domain must take the state as its only parameter", "gen_domain")
            return
        try:
            domain = gen_domain(self._new_state())
        except BaseException as error:
            raise LoadError("runtime") from error
        self.parameters = attach_samplers(domain, self.parameters, samplers, self._lines, self.problems)

    def _is_function(self, name: str) -> bool:
        value = self._names.get(name)
        if value is None:
            functions = [n for n, v in self._names.items() if getattr(v, "__module__", "") == "program"]
            self._problem(f"the program does not define {name}{did_you_mean(name, functions)}", name)
        elif not callable(value):
            self._problem(f"{name} is {shown(value)}, expected a function", name)
        return callable(value)

    def _problem(self, text: str, name: str) -> None:
        self.problems.append((text, self._lines.of(name)))

    def _reseed(self, sample: int) -> None:
        number = (self.seed + sample) % 2**32
        random.seed(number)
        np.random.seed(number)


def _caller(
    gen_plan: Callable[..., Any], new_state: Callable[[], Any], parameters: list[Parameter]
) -> Callable[[Row], Any]:
    """gen_plan as a function of a row: indices become choices, and some parameters cross by keyword."""
    choices = [(column, p.choices) for column, p in enumerate(parameters) if p.choices]
    names = [p.name for p in parameters if p.by_keyword]
    positional = len(parameters) - len(names)

    def call(row: Row) -> Any:
        args = list(row)
        for column, values in choices:
            args[column] = values[int(args[column])]
        return gen_plan(new_state(), *args[:positional], **dict(zip(names, args[positional:], strict=True)))

    return call if choices or names else lambda row: gen_plan(new_state(), *row)


def describe(error: BaseException, kind: str) -> dict[str, Any]:
    """An exception of the program as data: kind, text, innermost line inside the program."""
    text = error.msg if isinstance(error, SyntaxError) else _text(error)
    name = type(error).__name__
    return {"kind": kind, "message": f"{name}: {text}" if text else name, "line": _line(error)}


def _text(error: BaseException) -> str:
    try:
        return str.__str__(str(error)[:1000])
    except BaseException:
        return "(its message cannot be shown)"


def _line(error: BaseException) -> int | None:
    line = error.lineno if isinstance(error, SyntaxError) and error.filename == FILENAME else None
    traceback: TracebackType | None = error.__traceback__
    while traceback is not None:
        if traceback.tb_frame.f_code.co_filename == FILENAME:
            line = traceback.tb_lineno
        traceback = traceback.tb_next
    return line
