"""Checks of goals: judges, and the programs that are bundled."""

import dataclasses
from collections.abc import Iterator

import numpy as np

from proc3s.checks.fault import Fault
from proc3s.checks.subject import SEEDS, BundledAnswer, Subject, explain
from proc3s.domain.world import make_world
from proc3s.sandbox import SketchError
from proc3s.search.problem import Problem
from proc3s.search.rollout import carry_out, judge

MOST = 1000
"""Samples of a bundled program until a plan must be accepted."""
BATCH = 50


def judges(subject: Subject) -> Iterator[Fault]:
    """The judge of a task is not satisfied by the untouched scene."""
    for name, task in subject.spec.tasks.items():
        if not task.judge:
            yield Fault(f"the task {name} has no judge", error=False)
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
    for (task, kind), some in groups.items():
        tried = [_outcome(subject, answer) for answer in reversed(some)]  # later rounds first
        if None not in tried:
            # there are methods whose plans are carried out unchecked, too
            text = f"no bundled {kind} leads to the goal of {task}: {tried[0]}"
            yield Fault(text, str(some[-1].path), error=kind == "sketch")


def _outcome(subject: Subject, answer: BundledAnswer) -> str | None:
    """Why a program does not lead to its goal; None if it does."""
    try:
        with subject.sketch(answer) as sketch:
            rng, world = np.random.default_rng(0), make_world(subject.domain)
            said = "it makes no plan"
            try:
                for _ in range(MOST // BATCH if sketch.space.dim else 1):
                    u = rng.random((BATCH if sketch.space.dim else 1, sketch.space.dim))
                    batch = sketch.plans(u, first=0)
                    for i in (i for i in range(len(batch)) if i not in batch.errors):
                        plan = batch.plan(i)
                        trial, final = carry_out(world, answer.problem, plan)
                        if not trial.accepted:
                            said = trial.violations[0].text
                            continue
                        score, said = judge(_judged(answer), final, plan)
                        if score is None or score.reached:
                            return None
            finally:
                world.close()
            return said
    except SketchError as error:
        return explain(error)


def _judged(answer: BundledAnswer) -> Problem:
    """The problem with its own instruction, so that its judge looks."""
    return dataclasses.replace(answer.problem, goal=answer.problem.task.instruction or "")
