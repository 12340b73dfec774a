"""Checks of what is read before anything moves: targets, scenes, states, models, prompts."""

import json
import math
import time
from collections.abc import Iterator
from contextlib import closing
from typing import Any

from proc3s.checks.fault import Fault
from proc3s.checks.subject import SEEDS, Subject
from proc3s.domain.source_text import source_text
from proc3s.domain.world import flaws_of, make_world
from proc3s.errors import Proc3sError, SpecError
from proc3s.planning.options import RunOptions
from proc3s.planning.setup import make_prompter
from proc3s.prompts.conversation import conversation
from proc3s.wording import count

SLOW = 5.0
"""A scene that takes longer is no scene but a search, s."""


def targets(subject: Subject) -> Iterator[Fault]:
    """Everything that the spec names can be imported."""
    seen: set[str] = set()
    for task in subject.spec.tasks.values():
        try:
            subject.domain.require(task)
            task.initial.load()
            for screen in subject.domain.screens:
                screen.load()
        except SpecError as error:
            new = [issue for issue in error.issues if str(issue) not in seen]
            seen |= {str(issue) for issue in new}
            yield from (Fault(f"{i.field}: {i.message}", i.where) for i in new)


def scenes(subject: Subject) -> Iterator[Fault]:
    """Scenes repeat by their seed, differ by it, come in time, and plans can begin from them."""
    for name, task in subject.spec.tasks.items():
        began = time.monotonic()
        drawn = [subject.domain.scene(task, seed) for seed in range(SEEDS)]
        slow = (time.monotonic() - began) / SEEDS
        if slow > SLOW:
            yield Fault(f"a scene of {name} takes {slow:.0f} s", task.initial.target)
        for seed, state in enumerate(drawn):
            for flaw in flaws_of(subject.domain, state):
                yield Fault(f"the scene of {name}, seed {seed}: {flaw}", task.initial.target)
        if drawn != [subject.domain.scene(task, seed) for seed in range(SEEDS)]:
            yield Fault(f"the scene of {name} is another one when it is drawn again", task.initial.target)
        if all(scene == drawn[0] for scene in drawn):
            yield Fault(f"all seeds of {name} give the same scene", task.initial.target, error=False)


def states(subject: Subject) -> Iterator[Fault]:
    """States survive JSON, and print."""
    for name, task in subject.spec.tasks.items():
        for seed in range(SEEDS):
            state = subject.domain.scene(task, seed)
            data = subject.domain.states.dump(state)
            if not _finite(data):
                yield Fault(f"the scene of {name}, seed {seed}, has a number that is not finite")
                break
            if subject.domain.states.parse(json.loads(json.dumps(data))) != state:
                yield Fault(f"the scene of {name}, seed {seed}, is not the same after JSON and back")
                break
            if not source_text(state).strip():
                yield Fault(f"the scene of {name} prints as nothing")
                break


def _finite(value: Any) -> bool:
    if isinstance(value, dict):
        return all(map(_finite, value.values()))
    if isinstance(value, list | tuple):
        return all(map(_finite, value))
    return not isinstance(value, float) or math.isfinite(value)


def models(subject: Subject) -> Iterator[Fault]:
    """The world's models of bodies are exact enough."""
    with closing(make_world(subject.domain)) as world:
        for text, advice in world.coarse().items():
            yield Fault(text, mend=advice, error=False)


def prompts(subject: Subject) -> Iterator[Fault]:
    """The prompt of every task renders for every template of a method."""
    broken: dict[str, list[str]] = {}
    for name in subject.spec.tasks:
        for method in {method.template: method for method in reversed(subject.methods)}.values():
            problem = subject.problem(name, method=method.name)
            options = RunOptions(**{"task": f"{subject.spec.name}/{name}", "method": method.name})
            try:
                messages = conversation(make_prompter(subject.registry, options, problem), problem, [])
            except Proc3sError as error:
                broken.setdefault(str(error), []).append(f"of {name} for {method.name}")
                continue
            if problem.goal not in messages[-1].text:
                yield Fault(f"the prompt of {name} for {method.name} does not end with the instruction")
    for text, where in broken.items():
        more = f" and {count(len(where) - 1, 'other')}" if len(where) > 1 else ""
        yield Fault(f"the prompt {where[0]}{more}: {text}")
