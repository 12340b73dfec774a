"""A domain at work: its spec with what plugins attach, and its targets, imported when first used."""

import inspect
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, get_type_hints

import numpy as np
from pydantic import TypeAdapter, ValidationError

from proc3s.domain.plan_batch import Parameter, Signature
from proc3s.domain.state import State, StateModel
from proc3s.errors import Issue, SpecError, UsageError, blame, did_you_mean, not_wanted
from proc3s.specs.base import Target
from proc3s.specs.domain import DomainSpec, ParamSpec, SamplerSpec, ScreenSpec, TaskSpec
from proc3s.specs.fitting import misfits, unfit_constraint
from proc3s.specs.yaml_reader import Document


@dataclass(frozen=True)
class Domain:
    """Plain data (it pickles); what it imports is cached where it is used."""

    spec: DomainSpec
    samplers: tuple[SamplerSpec, ...]

    def __reduce__(self) -> tuple[type["Domain"], tuple[DomainSpec, tuple[SamplerSpec, ...]]]:
        return Domain, (self.spec, self.samplers)

    @cached_property
    def states(self) -> StateModel:
        """The state classes."""
        return StateModel(self.spec.types, self.spec.state)

    @cached_property
    def _skills(self) -> dict[str, Callable[..., Any]]:
        return {name: spec.load() for name, spec in self.spec.skills.items()}

    def skill(self, name: str) -> Callable[..., Any]:
        """The function `f(world, *args) -> telemetry` of a skill."""
        return self._skills[name]

    @cached_property
    def margins(self) -> dict[str, Callable[..., Any]]:
        """The margin function of every constraint, in the order in which they are checked."""
        return {name: spec.load() for name, spec in self.spec.constraints.items()}

    @cached_property
    def screens(self) -> tuple[ScreenSpec, ...]:
        """The domain's own screens, then those that come with its world."""
        return (*self.spec.screens, *getattr(self.spec.world.load(), "screens", ()))

    def targets(self, task: TaskSpec) -> Iterator[tuple[str, Target]]:
        """Every target that a run of a task needs, and the field that names it."""
        spec = self.spec
        yield "world", spec.world
        if spec.execution:
            yield "execution", spec.execution
        for kind, parts in (("skills", spec.skills), ("constraints", spec.constraints)):
            yield from ((f"{kind}.{name}", part) for name, part in parts.items())
        yield from ((f"samplers.{sampler.name}", sampler) for sampler in self.samplers)
        yield from ((f"tasks.{task.name}.judge.{i}", judge) for i, judge in enumerate(task.judge))

    def require(self, task: TaskSpec) -> None:
        """Import all targets that a run of a task needs. Raises SpecError with all unfit ones."""
        spec = self.spec
        worlds = {"world": spec.world, **({"execution": spec.execution} if spec.execution else {})}
        found: dict[str, Iterable[tuple[str, str]]] = {n: misfits(w, 1) for n, w in worlds.items()}
        found |= {f"skills.{s.name}": misfits(s, 1 + len(s.params), {}) for s in spec.skills.values()}
        found |= {f"samplers.{s.name}": misfits(s, 0, s.params) for s in self.samplers}
        found |= {f"constraints.{c.name}": unfit_constraint(c) for c in spec.constraints.values()}
        found |= {f"tasks.{task.name}.initial": misfits(task.initial, 1)}
        found |= {f"tasks.{task.name}.judge.{i}": misfits(judge, 2) for i, judge in enumerate(task.judge)}
        wrong = [(f"{part}.{field}", text) for part, faults in found.items() for field, text in faults]
        if wrong:
            raise SpecError([Issue(self._where(field), field, text) for field, text in wrong])

    def _where(self, field: str) -> str:
        """`file:line` of a dotted path if the domain's file has it."""
        file = self.spec.folder / "domain.yaml" if self.spec.folder else Path()
        lines = Document(file).lines if file.is_file() else {}
        loc = tuple(int(part) if part.isdigit() else part for part in field.split("."))
        return f"{file}:{lines[loc]}" if loc in lines else f"domain {self.spec.name}"

    def scene(self, task: TaskSpec, seed: int, options: dict[str, Any] | None = None) -> State:
        """The initial state of a task for a seed; `options` replace arguments of its scene generator.

        Raises UsageError for options the generator does not take, SpecError for a scene that does not
        fit the state type.
        """
        rng = np.random.default_rng(seed)
        make = task.initial.load()
        args = {**task.initial.args, **_scene_options(task.name, make, options or {})}
        with blame(f"scene of {task.name}"):
            try:
                data = make(rng, **args)
            except ValueError as error:
                raise UsageError(f"the scene of {task.name}: {error}") from error
        if not isinstance(data, Mapping | State):
            raise not_wanted(
                f"scene of {task.name} ({task.initial.target})",
                data,
                f"a dict of the fields of a {self.spec.state}",
            )
        where = f"scene of {task.name} ({task.initial.target})"
        try:
            state = self.states.parse(data)
        except ValidationError as error:
            raise SpecError(
                [Issue(where, ".".join(map(str, d["loc"])), d["msg"]) for d in error.errors()]
            ) from error
        if issues := list(self._misnamed(state, where)):
            raise SpecError(issues)
        return state

    def _misnamed(self, state: State, where: str) -> Iterator[Issue]:
        """Objects of a state that a program could not name, or not without naming another one."""
        names = self.object_names(state)
        for k, name in enumerate(names):
            if not isinstance(name, str) or not name.strip():
                yield Issue(where, f"{self.spec.objects}.{k}", f"{name!r} is no name of an object")
            elif (first := names.index(name)) < k:
                text = f"{name!r} is the name of {self.spec.objects}.{first}, too"
                yield Issue(where, f"{self.spec.objects}.{k}", text)

    def object_names(self, state: State) -> tuple[str, ...]:
        """Names of the objects of a state, in its order."""
        things = getattr(state, self.spec.objects) if self.spec.objects else ()
        return tuple(things) if isinstance(things, dict) else tuple(thing.name for thing in things)

    def signatures(self, state: State) -> tuple[Signature, ...]:
        """The skills as a program that starts in `state` may call them."""
        names = self.object_names(state)
        return tuple(
            Signature(s.name, tuple(_parameter(n, p, names) for n, p in s.params.items()))
            for s in self.spec.skills.values()
        )


def _scene_options(task: str, make: Callable[..., Any], options: Mapping[str, Any]) -> dict[str, Any]:
    """Options as the types that the scene generator declares. Raises UsageError."""
    known = list(inspect.signature(make).parameters)[1:]
    hints = get_type_hints(make)
    checked = {}
    for name, value in options.items():
        if name not in known:
            hint = did_you_mean(name, known)
            raise UsageError(f"the scene of {task} has no option {name!r}{hint}")
        try:
            checked[name] = TypeAdapter(hints.get(name, Any)).validate_python(value)
        except ValidationError as error:
            raise UsageError(
                f"the scene of {task}: {name}: {error.errors()[0]['msg']}, not {value!r}"
            ) from error
    return checked


def _parameter(name: str, spec: ParamSpec, objects: tuple[str, ...]) -> Parameter:
    choices = objects if spec.type == "object" else spec.choices
    return Parameter(name, spec.type, spec.min, spec.max, spec.noise, spec.turn_noise, choices)
