"""Programs that fail in typical ways in any domain, and what is said of them."""

from collections.abc import Iterator
from dataclasses import dataclass

from proc3s.domain.plan_batch import Parameter, Signature
from proc3s.sandbox.errors import (
    SketchContractError,
    SketchError,
    SketchRuntimeError,
    SketchSyntaxError,
    SketchTimeout,
)
from proc3s.sandbox.limits import Limits
from proc3s.search.problem import Problem
from proc3s.specs.domain import SamplerSpec


@dataclass(frozen=True)
class BrokenProgram:
    """A program and its error; `in_samples` says that it loads and every sample raises the error."""

    source: str
    error: SketchError
    in_samples: bool = False


def broken_programs(problem: Problem, answer: str) -> Iterator[tuple[str, BrokenProgram]]:
    """(name, program) for a kind of answer: `sketch`, `program` or `plan`."""
    skill = next(iter(problem.domain.signatures(problem.initial)), None)
    if answer == "plan":
        yield from _plans(skill)
        return
    numbers = (sampler for sampler in problem.domain.samplers if sampler.gives in ("float", "choice"))
    sampler = next(numbers, None) if answer == "sketch" else None
    yield from _functions(skill, _made(sampler) if sampler else "")


def _plans(skill: Signature | None) -> Iterator[tuple[str, BrokenProgram]]:
    open_list = f"gen_plan = [{_call(skill)}"
    yield "syntax", _broken(SketchSyntaxError, "SyntaxError: '[' was never closed", 1, open_list)
    if skill and skill.params:
        short = f"gen_plan = [{_call(skill, left_out=1)}]"
        yield "arguments", _broken(SketchContractError, _miscounted(skill), 1, short)


def _functions(skill: Signature | None, sampler: str) -> Iterator[tuple[str, BrokenProgram]]:
    """`gen_plan`, and with a sampler `gen_domain`; each has one mistake."""
    head = f"def gen_plan(initial{', x' if sampler else ''})"
    body = f"    return [{_call(skill)}]"
    domain = f'\n\n\ndef gen_domain(initial):\n    return {{"x": {sampler}}}' if sampler else ""
    text, source = "KeyError: 'start'", f'{head}:\n    start = {{}}["start"]\n{body}{domain}'
    yield "exception", _broken(SketchRuntimeError, text, 2, source, in_samples=True)
    text = f"one call of gen_plan took longer than {Limits().call:g} s"
    text += ", in all of 3 samples" if sampler else ""
    source = f"{head}:\n    while True: start = 0\n{body}{domain}"
    yield "timeout", _broken(SketchTimeout, text, 2, source)
    yield "syntax", _broken(SketchSyntaxError, "SyntaxError: expected ':'", 1, f"{head}\n{body}{domain}")
    if skill and skill.params:
        source = f"{head}:\n    return [{_call(skill, left_out=1)}]{domain}"
        yield "arguments", _broken(SketchContractError, _miscounted(skill), 2, source)
    if sampler:
        text = "gen_domain returned a list, expected a dict of parameter names to samplers"
        source = f"{head}:\n{body}\n\n\ndef gen_domain(initial):\n    return [{sampler}]"
        yield "gen-domain", _broken(SketchContractError, text, 5, source)


def _broken(
    kind: type[SketchError], text: str, line: int, source: str, in_samples: bool = False
) -> BrokenProgram:
    error = kind(text, line, source.split("\n")[line - 1].strip())
    return BrokenProgram(f"{source}\n", error, in_samples)


def _miscounted(skill: Signature) -> str:
    names = ", ".join(param.name for param in skill.params)
    count = len(skill.params)
    return f"step 0: {skill.skill} takes {count} values ({names}), got {count - 1}"


def _call(skill: Signature | None, left_out: int = 0) -> str:
    """An action of a skill with constant arguments, less the last ones; "" without a skill."""
    if skill is None:
        return ""
    values = ", ".join(map(_value, skill.params[: len(skill.params) - left_out]))
    return f'Action("{skill.skill}", [{values}])'


def _value(param: Parameter) -> str:
    if param.type in ("str", "object"):
        return repr(next(iter(param.choices), "nothing"))
    middle = min(max(0.0, param.low), param.high)
    several = {"point": [0.0] * 3, "pose": [0.0] * 6, "grasp": [0.0] * 6}
    return str(several.get(param.type, int(middle) if param.type == "int" else middle))


def _made(sampler: SamplerSpec) -> str:
    """A call of a sampler with numbers of its own."""
    values = (
        "[0.0, 1.0]" if kind == "list" else f"{at}.0" for at, kind in enumerate(sampler.params.values())
    )
    return f"{sampler.name}({', '.join(values)})"
