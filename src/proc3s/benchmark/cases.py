"""Benchmark cases: the fixed programs that a domain brings."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from proc3s.domain.world_options import with_world_options
from proc3s.errors import UsageError, did_you_mean
from proc3s.planning.options import key_values
from proc3s.plugins.registry import Registry
from proc3s.specs.domain import DomainSpec
from proc3s.textfiles import read_text

_SCENE = "# scene:"


@dataclass(frozen=True)
class Case:
    """A program for a task, and the options of its scene and of its world."""

    task: str
    name: str
    program: str
    scene: Mapping[str, str] = field(default_factory=dict)
    world: Mapping[str, str] = field(default_factory=dict)

    @property
    def label(self) -> str:
        """`domain/task.name`."""
        return f"{self.task}.{self.name}"


def find_cases(registry: Registry, wanted: Sequence[str] = (), world: Sequence[str] = ()) -> list[Case]:
    """The programs that domains bring, or those of the wanted domains, tasks or `domain/task.name`.

    `world` has options of their worlds as `key=value`. Raises UsageError for a name that has no program,
    or an option that one of the worlds does not have.
    """
    found = [case for spec in registry.all(DomainSpec).values() for case in _cases_of(spec)]
    names = {name for case in found for name in _names(case)}
    for name in wanted:
        if name not in names:
            raise UsageError(f"there is no benchmark program for {name!r}{did_you_mean(name, names)}")
    options = key_values([*world])
    cases = [replace(case, world=options) for case in found if not wanted or set(wanted) & set(_names(case))]
    for domain in dict.fromkeys(case.task.partition("/")[0] for case in cases):
        with_world_options(registry.domain(domain), options)
    return cases


def _names(case: Case) -> tuple[str, str, str]:
    return case.task.partition("/")[0], case.task, case.label


def _cases_of(spec: DomainSpec) -> Iterator[Case]:
    for path in sorted((spec.folder / "bench").glob("*.*.py")) if spec.folder else ():
        task, name = path.stem.split(".", 1)
        if task not in spec.tasks:
            hint = did_you_mean(task, spec.tasks)
            raise UsageError(f"{path}: domain {spec.name} has no task {task!r}{hint}")
        program = read_text(path)
        yield Case(f"{spec.name}/{task}", name, program, _scene(program))


def _scene(program: str) -> dict[str, str]:
    first = program.partition("\n")[0]
    return key_values(first.removeprefix(_SCENE).split()) if first.startswith(_SCENE) else {}
