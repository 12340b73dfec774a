"""Checks of goals: judges, and the programs that are bundled."""

import shlex
from collections.abc import Iterator, Sequence
from dataclasses import replace

from proc3s.checks.fault import Fault
from proc3s.checks.subject import SEEDS, BundledAnswer, Subject
from proc3s.domain.values import Plan
from proc3s.errors import OutOfTime
from proc3s.planning.attempts import Attempt
from proc3s.planning.execution import execute
from proc3s.planning.options import RunOptions
from proc3s.planning.proposals import given_program
from proc3s.planning.rounds import run_round
from proc3s.planning.setup import make_problem, make_setup
from proc3s.planning.ways_on import command, near
from proc3s.runs.events import Event
from proc3s.search.problem import Problem
from proc3s.search.rollout import judge
from proc3s.specs.domain import ExampleSpec
from proc3s.wording import count

SECONDS = 60
"""Wall-clock seconds for the search of a bundled program."""


def judges(subject: Subject) -> Iterator[Fault]:
    """The judge of a task is not satisfied by the untouched scene."""
    for name, task in subject.spec.tasks.items():
        if not task.judge:
            yield Fault(
                f"the task {name} has no judge",
                why="its runs end without a verdict on the goal",
                mend="give it a judge, unless people are to say what is right",
                error=False,
            )
            continue
        for seed in range(SEEDS):
            problem = subject.problem(name, seed)
            score, reason = judge(problem, problem.initial, ())
            if score is not None and score.reached:
                yield Fault(
                    f"the scene of {name}, seed {seed}, fulfils it already: {reason}", task.judge[0].target
                )
                break


def programs(subject: Subject) -> Iterator[Fault]:
    """Of every task that has bundled programs of a kind, and of every example, one leads to its goal."""
    if not subject.answers:
        yield Fault(
            "no program is bundled: there is nothing to run without a model, and little to check",
            mend="write `answers/TASK.proc3s.md`, and `examples/NAME.sketch.md`",
            error=False,
        )
    groups: dict[tuple[str, str], list[BundledAnswer]] = {}
    for answer in subject.answers:
        groups.setdefault((answer.problem.task.name, answer.kind), []).append(answer)
    missed: dict[tuple[str, str], list[BundledAnswer]] = {}
    for (_, kind), some in groups.items():
        tried = _until_one_leads(subject, some[::-1])  # later rounds first
        if "" not in tried:
            missed.setdefault((kind, tried[0]), []).append(some[-1])
    for (kind, why), answers in missed.items():
        tasks = ", ".join(answer.problem.task.name for answer in answers)
        undecided = why.startswith(UNDECIDED)
        # there are methods whose plans are carried out unchecked, too
        yield Fault(
            f"{why} of {tasks}" if undecided else f"no bundled {kind} leads to the goal of {tasks}: {why}",
            str(answers[0].path),
            _command(subject, answers[0]),
            error=kind == "sketch" and not undecided,
        )


def _until_one_leads(subject: Subject, answers: Sequence[BundledAnswer]) -> list[str]:
    """What each misses, up to the one that misses nothing."""
    tried: list[str] = []
    for answer in answers:
        tried.append(_missed(subject, answer))
        if not tried[-1]:
            break
    return tried


UNDECIDED = "not decided"


def _command(subject: Subject, answer: BundledAnswer) -> str:
    """How to see for oneself what becomes of a program, where there is a command for that."""
    if isinstance(answer.problem.task, ExampleSpec):
        return ""
    options = _options(subject, answer).model_copy(update={"limits": {}, "feedback": None})
    file = shlex.quote(str(near(answer.path)))
    return f"correct the program; this runs it: {command('solve', options)} --sketch {file}"


def _options(subject: Subject, answer: BundledAnswer) -> RunOptions:
    """Those of a run that searches the numbers of a program."""
    return RunOptions.model_validate(
        {
            "task": f"{subject.spec.name}/{answer.problem.task.name}",
            "method": answer.method.name,
            "seed": answer.problem.seed,
            "plugins": subject.registry.plugins.files,
            "feedback": 0,
            "improve": 0,
            "limits": {"round": str(SECONDS)},
        }
    )


def _missed(subject: Subject, answer: BundledAnswer) -> str:
    """Why a run of a program would not lead to its goal; nothing if it does."""
    options = _options(subject, answer)
    if isinstance(answer.problem.task, ExampleSpec):
        options = options.model_copy(update={"task": f"{subject.spec.name}/{next(iter(subject.spec.tasks))}"})
    plain = make_problem(subject.registry, options, goal_needed=False)
    problem = replace(
        plain,
        task=answer.problem.task,
        scene=answer.problem.scene,
        goal=answer.problem.task.instruction or "",
    )
    setup = make_setup(subject.registry, options, problem)
    try:
        attempt = run_round(setup, given_program(answer.source)(0, ()), _nobody).attempts[0]
        return _told(problem, attempt, attempt.fallback if setup.method.samples == "none" else None)
    finally:
        setup.executor.close()


def _nobody(event: Event) -> None:
    """Nobody listens."""


def _told(problem: Problem, attempt: Attempt, unchecked: Plan | None) -> str:
    """Why an attempt missed the goal; nothing if it did not. Raises what broke it off.

    `unchecked` is the plan of a method that carries plans out without a search.
    """
    drawn = f"{count(attempt.samples, 'sample')} of seed {problem.seed}"
    plan = attempt.solution.plan if attempt.solution else unchecked
    if isinstance(attempt.broken_off, OutOfTime):
        return f"{UNDECIDED} in {SECONDS} s, after {drawn}: whether a bundled program leads to the goal"
    if attempt.broken_off:
        raise attempt.broken_off
    if plan is None:
        causes = (*attempt.diagnosis.program_errors, *attempt.diagnosis.failures)
        text = causes[0].text if causes else "it makes no plan"
        return f"{text} (the commonest failure, after {drawn})" if attempt.samples else text
    execution = execute(problem, plan, "solution", (0, 0), None, _nobody)
    if unchecked and execution.violations:
        return f"its plan breaks a rule: {execution.violations[0].text}"
    if execution.score is None or execution.score.reached:
        return ""
    return f"{execution.reason} (its plan after {drawn})"
