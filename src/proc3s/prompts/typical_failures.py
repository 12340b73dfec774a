"""Typical failures by name: feedback prompts can be read before a program of a model has failed."""

import re
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

from proc3s.domain.margins import Violation, sentence
from proc3s.errors import UsageError, did_you_mean
from proc3s.feedback.diagnosis import diagnose
from proc3s.feedback.report import Diagnosis
from proc3s.prompts.broken_programs import BrokenProgram, broken_programs
from proc3s.prompts.conversation import Exchange
from proc3s.prompts.extract import extract
from proc3s.sandbox.errors import SketchContractError
from proc3s.search.evaluator import ALIKE
from proc3s.search.problem import Problem
from proc3s.search.rollout import judge
from proc3s.search.trial import Trial
from proc3s.specs.base import placeholders
from proc3s.specs.domain import ConstraintSpec
from proc3s.specs.parts import MethodSpec
from proc3s.textfiles import read_text

_STEP = 1
"""The step that violates a constraint; one more misses the goal."""
_SAMPLES = 100
_FRONT = re.compile(r"\A---\n.*?\n---\n", re.DOTALL)
_NO_PROGRAM = "First it must be clear where everything stands. Then the program can be written."
_PLACEHOLDERS = {
    "sketch": "def gen_plan(initial, ...):\n    ...\n\n\ndef gen_domain(initial):\n    ...\n",
    "program": "def gen_plan(initial):\n    ...\n",
    "plan": "gen_plan = [...]\n",
}
Failures = Mapping[str, Callable[[], Exchange]]


def typical_failures(problem: Problem, method: MethodSpec) -> Failures:
    """What makes an answer that fails so, and what the LLM is told of it, by the name of the failure.

    Each constraint of the domain, `goal` where a judge decides, and mistakes of programs. A plan that fails
    is that of the bundled answer, or where there is none, of a program that stands for one.
    """
    made: dict[str, Callable[[], Exchange]] = {"no-program": _no_program}
    for name, broken in broken_programs(problem, method.answer):
        made[name] = partial(_of_program, problem, broken)
    for spec in problem.domain.spec.constraints.values():
        made[spec.name] = partial(_of_constraint, problem, method, spec)
    if problem.check_goal and problem.task.judge and problem.goal == problem.task.instruction:
        made["goal"] = partial(_of_goal, problem, method)
    return made


def typical_failure(problem: Problem, method: MethodSpec, name: str) -> Exchange:
    """The one of that name. Raises UsageError with the names that there are."""
    made = typical_failures(problem, method)
    if name not in made:
        known = ", ".join(sorted(made))
        hint = did_you_mean(name, made)
        raise UsageError(
            f"{problem.name} has no typical failure {name!r} with the method {method.name}{hint}"
            + (f"\n  there is {known}" if known not in hint else "")
        )
    return made[name]()


def _of_constraint(problem: Problem, method: MethodSpec, spec: ConstraintSpec) -> Exchange:
    details = {name: f"({name})" for name in placeholders(spec.says)} | spec.example
    skill = next(iter(problem.domain.spec.skills), "")
    margin = -max(0.01, 10 * spec.tolerance)
    violation = Violation(spec.name, _STEP, skill, margin, sentence(spec, details))
    return Exchange(_answer(problem, method), _violated(problem, method, violation))


def _of_goal(problem: Problem, method: MethodSpec) -> Exchange:
    """What the judges say of the untouched scene."""
    _, reason = judge(problem, problem.initial, ())
    violation = Violation("goal", _STEP + 1, "goal", -1.0, reason)
    return Exchange(_answer(problem, method), _violated(problem, method, violation))


def _violated(problem: Problem, method: MethodSpec, violation: Violation) -> Diagnosis:
    """The diagnosis of a round in which all samples fail so."""
    trial = Trial(plan=(), violations=(violation,), reached=violation.step)
    return diagnose([trial] * (_SAMPLES if method.samples == "budget" else 1), problem=problem)


def _of_program(problem: Problem, broken: BrokenProgram) -> Exchange:
    answer = f"```python\n{broken.source}```\n"
    if not broken.in_samples:
        return Exchange(answer, diagnose((), broken.error, problem))
    return Exchange(answer, diagnose([Trial(error=broken.error)] * ALIKE, problem=problem, alike=True))


def _no_program() -> Exchange:
    try:
        extract(_NO_PROGRAM)
    except SketchContractError as error:
        return Exchange(_NO_PROGRAM, diagnose((), error))
    raise AssertionError("a text without a program has one")


def _answer(problem: Problem, method: MethodSpec) -> str:
    """The bundled answer to the task, else a program that stands for one."""
    stem = f"{problem.task.name}.{method.template}"
    folder = (problem.domain.spec.folder or Path()) / "answers"
    for path in (folder / f"{stem}.seed{problem.seed}.md", folder / f"{stem}.md"):
        if path.is_file() and problem.goal == problem.task.instruction:
            return _FRONT.sub("", read_text(path))
    return f"```python\n{_PLACEHOLDERS[method.answer]}```\n"
