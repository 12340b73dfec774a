"""The set-up code of a domain: constants, state classes, samplers and `Action`, as Python.

The prompt shows exactly the text that the program's box runs first.
"""

import ast
import inspect
import textwrap
from collections.abc import Iterator

from proc3s.domain.domain import Domain
from proc3s.errors import Issue, SpecError
from proc3s.specs.base import Target
from proc3s.specs.domain import FieldSpec, SamplerSpec, TypeSpec
from proc3s.specs.types import split_type

_HEADER = """\
import math
import random
from dataclasses import dataclass, field
from typing import Any

import numpy as np
"""

_ACTION = '''\
@dataclass
class Action:
    """One step of a plan: the name of a skill and its parameters in order."""

    name: str
    params: list = field(default_factory=list)
'''


def setup_code(domain: Domain, samplers: bool = True) -> str:
    """Python source, the same for every scene of the domain; `samplers` includes their classes."""
    blocks = [_HEADER, "\n".join(_constants(domain))]
    blocks += [_state_class(name, domain.spec.types[name]) for name in domain.states.types]
    blocks += [_sampler_class(spec) for spec in domain.samplers] if samplers else []
    return "\n\n".join(block for block in [*blocks, _ACTION] if block)


def _constants(domain: Domain) -> Iterator[str]:
    for name, constant in domain.spec.constants.items():
        yield f"{name} = {constant.value!r}" + (f"  # {constant.says}" if constant.says else "")
    if domain.spec.constants:
        yield ""


def _class(name: str, summary: str, lines: list[str]) -> str:
    body = "".join(f"    {line}\n" for line in lines) or "    pass\n"
    return f'@dataclass\nclass {name}:\n    """{summary}"""\n\n{body}'


def _state_class(name: str, spec: TypeSpec) -> str:
    text = _class(name, spec.summary, [_field(n, f) for n, f in spec.fields.items()])
    return f"{text}\n{_methods(spec.methods)}" if spec.methods else text


def _methods(target: str) -> str:
    """What a class and those it derives from define, still indented."""
    classes = [c for c in Target(target=target).load().__mro__ if c is not object]
    return "\n".join(_defined(c, target) for c in reversed(classes))


def _defined(cls: type, target: str) -> str:
    """The source of a class without its head."""
    source = inspect.getsource(cls)
    body = ast.parse(source).body[0]
    assert isinstance(body, ast.ClassDef)
    first = min(node.lineno - len(node.decorator_list) for node in _functions(body, target))
    lines = source.rstrip("\n").split("\n")  # as Python counts them
    return textwrap.indent(textwrap.dedent("\n".join(lines[first - 1 :])), "    ") + "\n"


def _functions(body: ast.ClassDef, target: str) -> list[ast.FunctionDef]:
    found = [node for node in body.body if isinstance(node, ast.FunctionDef)]
    if not found:
        raise SpecError([Issue(target, "methods", "defines no method")])
    return found


def _field(name: str, spec: FieldSpec) -> str:
    container, inner = split_type(spec.type)
    annotation = {"": inner, "list": f"list[{inner}]", "dict": f"dict[str, {inner}]"}[container]
    default = "" if spec.required else f" = {spec.default!r}"
    if isinstance(spec.default, list | dict):
        plain = type(spec.default).__name__
        factory = f"lambda: {spec.default!r}" if spec.default else plain
        default = f" = field(default_factory={factory})"
    comment = ", ".join(part for part in (spec.says, spec.unit) if part)
    return f"{name}: {annotation}{default}" + (f"  # {comment}" if comment else "")


def _sampler_class(spec: SamplerSpec) -> str:
    return _class(spec.name, spec.summary, [f"{n}: {t}" for n, t in spec.params.items()])
