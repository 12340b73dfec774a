"""Loads a program and checks what can be checked before sampling."""

import ast
import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import is_dataclass
from itertools import islice
from types import TracebackType
from typing import Any, cast

import numpy as np

from .encoding import STAND_IN, Encoder, as_list, skills_from
from .inspection import Inspector, Parameter, Problem
from .lines import Lines, as_python_reads
from .namespace import new_module, noting_lines, program_names
from .stubs import Ticks
from .wire import FILENAME, MOST_PROBLEMS

Row = Sequence[float]


class LoadError(Exception):
    """Loading failed at a stage: `prelude`, `syntax` or `runtime`; the cause is the exception."""

    def __init__(self, stage: str) -> None:
        self.stage = stage


class LoadedProgram:
    """A loaded program. `plan(sample, row)` is what it answers for one row of parameters."""

    def __init__(self, request: dict[str, Any], importable: tuple[str, ...]) -> None:
        self.answer: str = request["answer"]
        self.seed: int = request["seed"]
        self.encoder = Encoder(skills_from(request["signatures"]), request["actions"])
        self._random = "rand" in as_python_reads(request["source"])
        self._ticks = Ticks()
        self._call: Callable[[Row], Any] | None = None
        self.parameters: list[Parameter] = []
        prelude = self._prelude_names = self._prelude(request)
        self._inspector = Inspector(Lines(self._parse(request["source"])), request["samplers"])
        self._names = new_module(
            "program", program_names(prelude, importable, request["friendly"], self._ticks)
        )
        self._action = prelude["Action"]
        self._reseed(0)
        with noting_lines(self._action, FILENAME, spread=self.answer == "plan") as self._made:
            self._execute(request["source"])
        self._define()

    @property
    def width(self) -> int:
        """How many numbers a row has."""
        made = (self._prelude_names[p.made].__match_args__ for p in self.parameters if p.made)
        return len(self.parameters) + sum(len(fields) - 1 for fields in made)

    @property
    def problems(self) -> list[Problem]:
        """What was found to be wrong while loading."""
        return self._inspector.problems

    def plan(self, sample: int, row: Row) -> Any:
        """The plan for one row: a list if it is one at all. Raises what the program raises."""
        if self._random:
            self._reseed(sample)
        self._ticks.readings = 0
        assert self._call is not None
        plan = self._call(row)
        return plan if type(plan) is list else as_list(plan, self.encoder.longest)

    def probe(self, sample: int, row: list[float | None]) -> list[Problem]:
        """What one call shows to be wrong with the actions; None in the row stands for a missing sampler."""
        if self._call is None:
            return []
        stand_in = [STAND_IN if value is None else value for value in row]
        try:
            with noting_lines(self._action, FILENAME, spread=False) as made:
                plan = self.plan(sample, stand_in)
            found = list(islice(self.encoder.problems(plan), MOST_PROBLEMS))
        except BaseException:  # the samples will tell; it is no breach of the contract
            return []
        lines = self._made | made
        return [
            (text, lines.get(id(action)) or self._inspector.lines.of("gen_plan")) for text, action in found
        ]

    def _prelude(self, request: dict[str, Any]) -> dict[str, Any]:
        try:
            names = new_module("prelude", {})
            exec(compile(request["prelude"], "<prelude>", "exec"), names)  # noqa: S102
            state = ast.parse(f"lambda: ({request['initial']}\n)", "<state>", "eval")
            code = compile(_Positional(names).visit(state), "<state>", "eval")
            self._new_state = cast(Callable[[], Any], eval(code, names))  # noqa: S307
            self._new_state()
        except Exception as error:
            raise LoadError("prelude") from error
        return names

    def _parse(self, source: str) -> ast.Module:
        try:
            return ast.parse(source, FILENAME)
        except MemoryError:  # so the parser says that its stack is full
            raise LoadError("syntax") from SyntaxError("the program is nested too deeply")
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

    def _define(self) -> None:
        if self.answer == "plan":
            self._define_constant(self._names.get("gen_plan"))
            return
        gen_plan = self._inspector.function("gen_plan", self._names)
        if gen_plan is not None:
            self.parameters = self._inspector.parameters(gen_plan)
        if self.answer == "sketch":
            self._read_domain()
        else:
            required = [p.name for p in self.parameters if not p.optional]
            self.parameters = []
            if required:
                text = f"gen_plan must take the state and nothing else, not {', '.join(required)}"
                self._inspector.add(text, "gen_plan")
        if gen_plan is not None:
            self._call = _caller(gen_plan, self._new_state, self.parameters, self._prelude_names)

    def _define_constant(self, gen_plan: Any) -> None:
        if gen_plan is None or callable(gen_plan):
            text = "gen_plan must be a list of actions: gen_plan = [Action(...), ...]"
            self._inspector.add(text, "gen_plan")
            return
        plan = as_list(gen_plan, self.encoder.longest)
        self._call = lambda row: plan

    def _read_domain(self) -> None:
        gen_domain = self._inspector.function("gen_domain", self._names)
        if gen_domain is not None and self._inspector.takes_state(gen_domain):
            try:
                domain = gen_domain(self._new_state())
            except BaseException as error:
                raise LoadError("runtime") from error
            self.parameters = self._inspector.with_samplers(self.parameters, domain)

    def _reseed(self, sample: int) -> None:
        number = (self.seed + sample) % 2**32
        random.seed(number)
        np.random.seed(number)


class _Positional(ast.NodeTransformer):
    """Fields of dataclasses by position: the state is built for every sample, and so twice as fast."""

    def __init__(self, names: Mapping[str, Any]) -> None:
        self._names = names

    def visit_Call(self, node: ast.Call) -> ast.Call:
        self.generic_visit(node)
        made = self._names.get(node.func.id) if isinstance(node.func, ast.Name) else None
        given = tuple(keyword.arg for keyword in node.keywords)
        fields = getattr(made, "__match_args__", ()) if is_dataclass(made) else ()
        if given == fields[: len(given)] and not node.args:
            return ast.copy_location(ast.Call(node.func, [k.value for k in node.keywords], []), node)
        return node


def _caller(
    gen_plan: Callable[..., Any],
    new_state: Callable[[], Any],
    parameters: list[Parameter],
    classes: Mapping[str, Any],
) -> Callable[[Row], Any]:
    """gen_plan as a function of a row: indices become choices, several numbers an object of a class, and
    some parameters cross by keyword."""
    choices = [(at, p.choices) for at, p in enumerate(parameters) if p.choices]
    # from the last on, so that those before keep their places
    made = [(at, classes[p.made]) for at, p in reversed([*enumerate(parameters)]) if p.made]
    names = [p.name for p in parameters if p.by_keyword]
    positional = len(parameters) - len(names)
    widths = [len(classes[p.made].__match_args__) if p.made else 1 for p in parameters]
    starts = [sum(widths[:at]) for at in range(len(widths))]

    def call(row: Row) -> Any:
        args = list(row)
        for at, make in made:
            start, stop = starts[at], starts[at] + widths[at]
            args[start:stop] = [make(*args[start:stop])]
        for at, values in choices:
            args[at] = values[int(args[at])]
        return gen_plan(new_state(), *args[:positional], **dict(zip(names, args[positional:], strict=True)))

    return call if choices or names or made else lambda row: gen_plan(new_state(), *row)


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
