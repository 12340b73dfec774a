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
    call, short = (_call(skill), _call(skill, left_out=1)) if skill else ("", "")
    if answer == "plan":
        yield (
            "syntax",
            _broken(SketchSyntaxError, "SyntaxError: '[' was never closed", 1, f"gen_plan = [{call}"),
        )
        if skill and skill.params:
            text = _miscounted(skill)
            yield "arguments", _broken(SketchContractError, text, 1, f"gen_plan = [{short}]")
        return
    sampler = next((s for s in problem.domain.samplers if s.gives in ("float", "choice")), None)
    head, domain = "def gen_plan(initial):", ""
    if answer == "sketch" and sampler:
        head = "def gen_plan(initial, x):"
        domain = f'\n\n\ndef gen_domain(initial):\n    return {{"x": {_made(sampler)}}}'
    good = f"    return [{call}]"
    start = f'{head}\n    start = {{}}["start"]\n{good}{domain}'
    yield "exception", _broken(SketchRuntimeError, "KeyError: 'start'", 2, start, in_samples=True)
    endless = f"one call of gen_plan took longer than {Limits().call:g} s"
    endless += ", in all of 3 samples" if domain else ""
    yield "timeout", _broken(SketchTimeout, endless, 2, f"{head}\n    while True: start = 0\n{good}{domain}")
    unclosed = f"{head.removesuffix(':')}\n{good}{domain}"
    yield "syntax", _broken(SketchSyntaxError, "SyntaxError: expected ':'", 1, unclosed)
    if skill and skill.params:
        yield (
            "arguments",
            _broken(SketchContractError, _miscounted(skill), 2, f"{head}\n    return [{short}]{domain}"),
        )
    if domain and sampler:
        text = "gen_domain returned a list, expected a dict of parameter names to samplers"
        listed = f"{head}\n{good}\n\n\ndef gen_domain(initial):\n    return [{_made(sampler)}]"
        yield "gen-domain", _broken(SketchContractError, text, 5, listed)


def _broken(
    kind: type[SketchError], text: str, line: int, source: str, in_samples: bool = False
) -> BrokenProgram:
    error = kind(text, line, source.split("\n")[line - 1].strip())
    return BrokenProgram(f"{source}\n", error, in_samples)


def _miscounted(skill: Signature) -> str:
    names = ", ".join(param.name for param in skill.params)
    count = len(skill.params)
    return f"step 0: {skill.skill} takes {count} values ({names}), got {count - 1}"


def _call(skill: Signature, left_out: int = 0) -> str:
    """An action of a skill with constant arguments, less the last ones."""
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
