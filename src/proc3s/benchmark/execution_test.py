"""The field test: plans that the world accepted are carried out again and again, with small errors each time.

Every plan is carried out in the execution world with errors of its own, in several engines if these are
wanted, and the judge looks at the outcome. No LLM.
"""

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from proc3s.benchmark.candidates import Candidate
from proc3s.domain.domain import Domain
from proc3s.domain.world import World
from proc3s.domain.world_options import options_of, with_world_options, world_used
from proc3s.errors import UsageError
from proc3s.planning.repetition import repeat, repetitions
from proc3s.plugins.registry import Registry

ENGINE = "execution"
"""The option of a world that names the engine in which accepted plans are carried out."""


@dataclass(frozen=True)
class FieldTest:
    """What became of the plan found for a case and a seed, with so many rehearsals before it was accepted,
    and so many samples to improve it; `room` is what it has then, in expected errors.

    `satisfied` counts the outcomes, of `times`, with which the judge was satisfied; none without a plan.
    `run` is the folder of the run that the plan is from, None for one that was searched now. `engine` is
    None where the world does not say it; `error_mm` is None for disturbances.
    """

    case: str
    run: str | None
    robust: int
    improve: int
    seed: int
    solved: bool
    samples: int
    rehearsals: int
    room: float | None
    engine: str | None
    error_mm: float | None
    times: int
    satisfied: int


@dataclass(frozen=True)
class Conditions:
    """How plans are carried out: how often, in which engines, and how far off things are at most (mm).

    None stands for the engine of the domain, and for disturbances.
    """

    times: int
    engines: Sequence[str | None] = (None,)
    errors_mm: Sequence[float | None] = (None,)

    def fit(self, registry: Registry, task: str) -> bool:
        """Whether a task has a judge, and a world that knows such errors."""
        domain, spec = registry.task(task)
        worlds = [target.load() for target in (domain.spec.world, domain.spec.execution or domain.spec.world)]
        if None in self.errors_mm and any(world.disturb is World.disturb for world in worlds):
            return False
        return bool(spec.judge) and (not any(self.errors_mm) or worlds[-1].misplace is not World.misplace)

    def require(self, domains: Sequence[Domain], world: Mapping[str, str]) -> None:
        """Raises UsageError or SpecError where a world has not these options, or not these engines."""
        for domain, engine in itertools.product(domains, self.engines):
            if engine and ENGINE not in options_of(domain).model_fields:
                raise UsageError(f"--engines: the world of {domain.spec.name} has no engines to choose from")
            with_world_options(domain, {**world, **_chosen(engine)})


def field_tests(registry: Registry, candidate: Candidate, conditions: Conditions) -> Iterator[FieldTest]:
    """Carry the plan of a candidate out in each engine, with each error, so many times."""
    for engine, error_mm in itertools.product(conditions.engines, conditions.errors_mm):
        times, satisfied = _carried_out(registry, candidate, conditions.times, engine, error_mm)
        yield FieldTest(
            case=candidate.case,
            run=str(candidate.run) if candidate.run else None,
            robust=candidate.options.robust or 0,
            improve=candidate.options.improve or 0,
            seed=candidate.options.seed,
            solved=candidate.known is not None,
            samples=candidate.samples,
            rehearsals=candidate.rehearsals,
            room=candidate.room,
            engine=_used(registry, candidate, engine),
            error_mm=error_mm,
            times=times,
            satisfied=satisfied,
        )


def _carried_out(
    registry: Registry, candidate: Candidate, times: int, engine: str | None, error_mm: float | None
) -> tuple[int, int]:
    """How often a plan was carried out, and how often the judge was satisfied."""
    known = candidate.known
    if known is None:
        return 0, 0
    problem = known.problem(registry, _chosen(engine))
    satisfied = sum(one.reached is True for one in repeat(problem, known.plan, times, error_mm))
    return repetitions(times, error_mm), satisfied


def _used(registry: Registry, candidate: Candidate, engine: str | None) -> str | None:
    """The engine by its name, as the world says it."""
    domain, _ = registry.task(candidate.options.task)
    options = {**candidate.options.world_options, **_chosen(engine)}
    return world_used(with_world_options(domain, options)).get(ENGINE)


def _chosen(engine: str | None) -> dict[str, str]:
    return {ENGINE: engine} if engine else {}
