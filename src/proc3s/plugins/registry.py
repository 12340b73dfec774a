"""The registry: every spec that plugins brought, by kind and name."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from proc3s import specs
from proc3s.errors import Issue, SpecError, UsageError, did_you_mean
from proc3s.plugins.manager import PluginManager
from proc3s.specs.base import Spec
from proc3s.specs.domain import DomainSpec, TaskSpec
from proc3s.specs.parts import TemplatesSpec
from proc3s.specs.suite import SuiteSpec

if TYPE_CHECKING:
    from proc3s.domain.domain import Domain

S = TypeVar("S", bound=Spec)


KINDS: Mapping[str, type[Spec]] = {
    cls.kind: cls
    for cls in (
        specs.DomainSpec,
        specs.SkillSpec,
        specs.SamplerSpec,
        specs.ConstraintSpec,
        specs.MethodSpec,
        specs.PresetSpec,
        specs.SolverSpec,
        specs.LLMSpec,
        specs.ExecutorSpec,
        specs.TemplatesSpec,
        SuiteSpec,
    )
}


_TOGETHER: Mapping[type[Spec], str] = {specs.PresetSpec: "methods", SuiteSpec: "methods"}
"""Kinds that the hook of another kind brings."""


class Registry:
    """Looks specs up by kind and name; unknown names get "did you mean"."""

    def __init__(self, plugins: PluginManager) -> None:
        self.plugins = plugins

    def all(self, cls: type[S]) -> dict[str, S]:
        """Every spec of a kind by name."""
        brought = self.plugins.specs(_TOGETHER.get(cls, cls.kind))
        # every registered kind has a name
        return {str(getattr(spec, "name")): spec for _, spec in brought if isinstance(spec, cls)}  # noqa: B009

    def get(self, cls: type[S], name: str) -> S:
        """The spec of that name. Raises UsageError with the names that exist."""
        known = self.all(cls)
        if name not in known:
            what = f"{cls.kind.removesuffix('s')} {name!r}"
            raise UsageError(f"there is no {what}{did_you_mean(name, known)}{self._failed()}")
        return known[name]

    def _failed(self) -> str:
        """Names the broken plugins, which may be why a name is missing."""
        return "".join(
            f"\nplugin {s.name} ({s.source}) did not load: {s.error}" for s in self.plugins.failures
        )

    def domain(self, name: str) -> "Domain":
        """A domain with everything that plugins attach to it."""
        from proc3s.domain.domain import Domain  # with NumPy, which a list of names does not need

        spec = self.get(DomainSpec, name)
        samplers = self.all(specs.SamplerSpec)
        if missing := [n for n in spec.samplers if n not in samplers]:
            raise UsageError(
                f"domain {name}: there is no sampler {missing[0]!r}{did_you_mean(missing[0], samplers)}"
            )
        wanted = {**{n: samplers[n] for n in spec.samplers}, **self._attached(specs.SamplerSpec, spec)}
        merged = spec.model_copy(
            update={
                "skills": {**spec.skills, **self._attached(specs.SkillSpec, spec)},
                "constraints": {**spec.constraints, **self._attached(specs.ConstraintSpec, spec)},
            }
        )
        self._check_use(spec, merged, wanted)
        for sampler in wanted.values():
            _check_made(spec, sampler)
        return Domain(merged, tuple(wanted.values()))

    def _attached(self, cls: type[S], domain: DomainSpec) -> dict[str, S]:
        """Specs of a kind that name this domain, or that it uses. Raises SpecError if it has its own."""
        found = {
            name: spec
            for name, spec in self.all(cls).items()
            if {domain.name, "*"} & set(getattr(spec, "domains", ())) or name in domain.use
        }
        if taken := sorted(found.keys() & {*domain.skills, *domain.constraints}):
            message = f"a plugin brings {taken[0]!r}, and the domain has one of its own; rename one of them"
            raise SpecError([Issue(f"domain {domain.name}", cls.kind, message)])
        return found

    def _check_use(self, spec: DomainSpec, merged: DomainSpec, samplers: Mapping[str, Spec]) -> None:
        known = {*merged.skills, *merged.constraints, *samplers}
        for name in spec.use:
            if name not in known:
                offered = {
                    *self.all(specs.SkillSpec),
                    *self.all(specs.ConstraintSpec),
                    *self.all(specs.SamplerSpec),
                }
                raise UsageError(
                    f"domain {spec.name} uses {name!r}, which no plugin brings{did_you_mean(name, offered)}"
                )

    def task(self, name: str) -> "tuple[Domain, TaskSpec]":
        """`domain/task` -> both. Raises UsageError with what exists."""
        domain_name, slash, task_name = name.partition("/")
        if not slash:
            tasks = [f"{d.name}/{t}" for d in self.all(DomainSpec).values() for t in d.tasks]
            raise UsageError(f"a task is named domain/task, not {name!r}{did_you_mean(name, tasks)}")
        domain = self.domain(domain_name)
        if task_name not in domain.spec.tasks:
            known = did_you_mean(task_name, domain.spec.tasks)
            raise UsageError(f"domain {domain_name} has no task {task_name!r}{known}")
        return domain, domain.spec.tasks[task_name]


def _check_made(domain: DomainSpec, sampler: specs.SamplerSpec) -> None:
    """A sampler makes a number, a choice, or a type that the domain has and that is made of numbers.

    Raises SpecError.
    """
    if sampler.gives in ("float", "choice"):
        return
    made = domain.types.get(sampler.gives)
    if made is None or any(field.type != "float" for field in made.fields.values()):
        lack = "does not have" if made is None else "has, but not of floats alone"
        message = f"{sampler.name} makes a {sampler.gives}, a type that the domain {lack}"
        raise SpecError([Issue(f"domain {domain.name}", "samplers", message)])


def open_registry(files: Sequence[Path] = (), given: Sequence[object] = ()) -> Registry:
    """The registry of all installed plugins, the given loose files, and plugins that are objects."""
    return Registry(PluginManager(files, given))


def folders_of(registry: Registry) -> tuple[Path, ...]:
    """Template folders, of the plugin that loaded last first."""
    return tuple(spec.folder for spec in reversed(registry.all(TemplatesSpec).values()))
