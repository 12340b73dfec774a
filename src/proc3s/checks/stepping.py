"""Checks of what moves: skills, steps, snapshots, margins and screens."""

import dataclasses
import inspect
import math
import time
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from proc3s.checks.fault import Fault, NotCheckedError
from proc3s.checks.subject import NONE, BundledAnswer, Subject, same
from proc3s.domain.margins import Violation
from proc3s.domain.plan_batch import PlanBatch
from proc3s.domain.values import Plan
from proc3s.domain.world import Transition, make_world
from proc3s.sandbox import SketchError
from proc3s.search.executor import Executor
from proc3s.search.rollout import carry_out
from proc3s.search.trial import Trial
from proc3s.specs.domain import ScreenSpec
from proc3s.specs.parts import ExecutorSpec

FEW = 3
"""Plans of every program that are carried out step by step."""


def skills(subject: Subject) -> Iterator[Fault]:
    """Every skill is used by some plan."""
    used = {action.skill for _, plan in subject.plans(8) for action in plan}
    unused = {name: spec for name, spec in subject.spec.skills.items() if name not in used}
    if unused:
        subject.require_all_plans()
    for name, spec in unused.items():
        yield Fault(f"no bundled program uses the skill {name}", spec.target, error=False)


def refusals(subject: Subject) -> Iterator[Fault]:
    """Programs that name no skill, or give it other arguments, are refused."""
    if not subject.answers:
        raise NotCheckedError(NONE)
    if not subject.spec.skills:
        yield Fault("the domain has no skill", error=False)
        return
    answer = subject.answers[0]
    skill = next(iter(subject.spec.skills.values()))
    bad = {
        "an unknown skill": 'Action("no_such_skill", [])',
        "too many arguments": f"Action({skill.name!r}, {[0] * (len(skill.params) + 1)!r})",
        "arguments that are no numbers or names": f"Action({skill.name!r}, {[{}] * len(skill.params)!r})",
    }
    for what, action in bad.items():
        source = f"def gen_plan(initial):\n    return [{action}]\n"
        try:
            with subject.sketch(answer, source) as sketch:
                batch = sketch.plans(np.zeros((1, 0)), first=0)
        except SketchError:
            continue
        if not batch.errors:
            yield Fault(f"{what} passes: {action}", skill.target)


def deterministic(subject: Subject) -> Iterator[Fault]:
    """A plan gets the same trial in a used world, a fresh one, and in several workers."""
    used: list[str] = []
    apart: list[str] = []
    for answer, plans in _by_answer(subject):
        alone = [_fresh(subject, answer, plan) for plan in plans]
        if not same(alone, _used(subject, answer, plans)):
            used.append(answer.name)
        elif not same([trial for trial, _ in alone], _elsewhere(subject, answer, plans)):
            apart.append(answer.name)
    if used:
        text = f"plans of {', '.join(used)} end otherwise in a world that was used before"
        yield Fault(text, _world(subject))
    elif apart:
        yield Fault(f"plans of {', '.join(apart)} get other verdicts from two workers", _world(subject))


def _by_answer(subject: Subject) -> Iterator[tuple[BundledAnswer, list[Plan]]]:
    """A few plans for every task and example, of one program each."""
    subject.require_plans()
    first = {answer.problem.task.name: (answer, batch) for answer, batch in reversed(subject.batches)}
    for answer, batch in first.values():
        good = [i for i in range(len(batch)) if i not in batch.errors][:FEW]
        yield answer, [batch.plan(i) for i in good]


def _used(subject: Subject, answer: BundledAnswer, plans: Sequence[Plan]) -> list[tuple[Trial, Any]]:
    """The trials in one world, after others."""
    world = make_world(subject.domain)
    try:
        for plan in reversed(plans):
            carry_out(world, answer.problem, plan)
        return [carry_out(world, answer.problem, plan) for plan in plans]
    finally:
        world.close()


def _fresh(subject: Subject, answer: BundledAnswer, plan: Plan) -> tuple[Trial, Any]:
    world = make_world(subject.domain)
    try:
        return carry_out(world, answer.problem, plan)
    finally:
        world.close()


def _elsewhere(subject: Subject, answer: BundledAnswer, plans: Sequence[Plan]) -> list[Trial]:
    """The trials of two workers, or of what there is."""
    known = subject.registry.all(ExecutorSpec)
    several = known.get("processes") or next(iter(known.values()))
    executor: Executor = several.load()(jobs=2)
    try:
        plain = dataclasses.replace(answer.problem, screens="none", check_goal=False)
        return [dataclasses.replace(t, index=0) for t in executor.map(plain, plans)]
    finally:
        executor.close()


def _world(subject: Subject) -> str:
    return subject.spec.world.target


def snapshots(subject: Subject) -> Iterator[Fault]:
    """Going on from a snapshot equals going through in one go, whatever happened in between."""
    world = make_world(subject.domain)
    try:
        for answer, plans in _by_answer(subject):
            for plan in plans:
                yield from _from_every_step(world, answer, plan, _world(subject))
    finally:
        world.close()


def _from_every_step(world: Any, answer: BundledAnswer, plan: Plan, where: str) -> Iterator[Fault]:
    world.reset(answer.problem.initial)
    whole: list[Transition[Any]] = []
    kept = []
    for action in plan:
        kept.append(world.snapshot)
        whole.append(world.step(action))
    for step, snapshot in reversed(list(enumerate(kept))):
        world.resume(snapshot)
        if not same(world.step(plan[step]), whole[step]):
            yield Fault(
                f"step {step} ({plan[step].skill}) of a plan of {answer.name} is another one "
                "from its snapshot",
                where,
            )
            return


def margins(subject: Subject) -> Iterator[Fault]:
    """Margins are finite, and every constraint applies to some step."""
    seen: set[str] = set()
    applied: set[str] = set()
    for margin in _margins(subject):
        for name, value in margin.items():
            applied.add(name)
            if not math.isfinite(value) and name not in seen:
                seen.add(name)
                yield Fault(f"the margin of {name} is {value}", subject.spec.constraints[name].target)
    idle = {name: spec for name, spec in subject.spec.constraints.items() if name not in applied}
    if idle:
        subject.require_all_plans()
    for name, spec in idle.items():
        yield Fault(f"{name} applies to no step of a bundled plan", spec.target, error=False)


def _margins(subject: Subject) -> Iterator[Mapping[str, float]]:
    """The margins of every step of some plans."""
    world = make_world(subject.domain)
    try:
        for answer, plan in subject.plans(FEW):
            yield from carry_out(world, answer.problem, plan)[0].margins
    finally:
        world.close()


def screens(subject: Subject) -> Iterator[Fault]:
    """Screens reject only what the world rejects, whatever is in the batch; exact ones say the same."""
    end = subject.deadline()
    if subject.domain.screens:
        subject.require_plans()
    wrong: set[str] = set()
    for answer, batch in subject.batches:
        for spec in subject.domain.screens:
            if spec.name in wrong or spec.stateful or time.monotonic() >= end:
                continue
            for fault in _one_screen(subject, answer, batch, spec, end):
                wrong.add(spec.name)
                yield fault


def _one_screen(
    subject: Subject, answer: BundledAnswer, batch: PlanBatch, spec: ScreenSpec, end: float
) -> Iterator[Fault]:
    together = verdicts(subject, spec, answer, batch)
    good = [i for i in range(len(batch)) if i not in batch.errors]
    for i in good[:8]:
        if not same(verdicts(subject, spec, answer, batch.select(np.array([i]))), [together[i]]):
            text = f"{spec.name} says of a plan of {answer.name} by itself something else than in a batch"
            yield Fault(text, spec.target)
            return
    world = make_world(subject.domain)
    try:
        for i in good:
            said = together[i]
            if said is not None and time.monotonic() < end:
                trial, _ = carry_out(world, answer.problem, batch.plan(i))
                if (wrong := _wrong(spec, said, trial)) is not None:
                    yield Fault(f"{wrong} (a plan of {answer.name})", spec.target)
                    return
    finally:
        world.close()


def _wrong(spec: ScreenSpec, said: Violation, trial: Trial) -> str | None:
    """What is wrong with the verdict of a screen, beside that of the world."""
    if trial.accepted:
        return f"{spec.name} rejects what the world accepts: {said.text}"
    found = trial.violations[0]
    alike = dataclasses.replace(said, margin=found.margin) == found
    if spec.exact and not (alike and math.isclose(said.margin, found.margin, rel_tol=1e-9, abs_tol=1e-9)):
        return f"{spec.name} is declared exact, but says {said}, and the world {found}"
    return None


def verdicts(
    subject: Subject, spec: ScreenSpec, answer: BundledAnswer, batch: PlanBatch
) -> list[Violation | None]:
    """What a vectorised screen says of a batch."""
    screen = spec.load()
    more = {"domain": subject.domain} if "domain" in inspect.signature(screen).parameters else {}
    return list(screen(answer.problem.initial, batch, **more, **spec.args))
