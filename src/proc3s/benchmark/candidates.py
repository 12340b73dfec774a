"""Plans for a field test: found for the fixed programs as by preset `best`, or those of runs."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from proc3s.benchmark.cases import Case
from proc3s.errors import UsageError, did_you_mean
from proc3s.planning.grounding import open_sketch
from proc3s.planning.improving import improved
from proc3s.planning.known_plan import KnownPlan, plan_of
from proc3s.planning.options import DEFAULT_PRESET, RunOptions
from proc3s.planning.parts import Setup
from proc3s.planning.setup import make_setup
from proc3s.plugins.registry import Registry
from proc3s.search.clock import Deadline
from proc3s.search.evaluator import Evaluator
from proc3s.search.start import start_search
from proc3s.search.trial import Trial
from proc3s.specs.parts import PresetSpec


@dataclass(frozen=True)
class Candidate:
    """A plan to test, or None where none was found; its options and run, and what was spent on it."""

    case: str
    options: RunOptions
    known: KnownPlan | None
    samples: int = 0
    rehearsals: int = 0
    room: float | None = None
    """In expected errors; None where nothing limits the plan, or nobody knows."""
    run: Path | None = None

    @property
    def task(self) -> str:
        """`domain/task`."""
        return self.options.task

    @property
    def names(self) -> tuple[str, str, str]:
        """Its domain, its task, and the case."""
        return self.task.partition("/")[0], self.task, self.case


def searched(
    registry: Registry, case: Case, seed: int, robust: int, samples: int | None, improve: int = 0
) -> Candidate:
    """Search a plan for a case and a seed that passes so many rehearsals, and improve it so much."""
    given = {"task": case.task, "seed": seed, "robust": robust, "samples": samples, "improve": improve}
    options = RunOptions.model_validate({**given, "domain_options": case.scene, "world_options": case.world})
    setup = make_setup(registry, options, goal_needed=False)
    try:
        evaluator, solution, more = _search(setup, case.program)
    finally:
        setup.executor.close()
    known = KnownPlan(options, solution.plan) if solution and solution.plan is not None else None
    room = solution.room.value if solution and solution.room else None
    return Candidate(case.label, options, known, evaluator.samples, evaluator.rehearsals + more, room)


def _search(setup: Setup, program: str) -> tuple[Evaluator, Trial | None, int]:
    """The evaluator of a search, what it found, improved, and the rehearsals of that."""
    problem = setup.problem
    with open_sketch(setup, program) as opened:
        evaluator = Evaluator(problem, opened.sketch, setup.executor)
        search = start_search(evaluator, setup.make_solver, problem.samples)
        search.advance(problem.samples)
        if search.broken_off is not None:
            raise search.broken_off
        if search.solution is None:
            return evaluator, None, 0
        endless = Deadline("", None)
        better = improved(setup, opened.sketch, search.solution, (0, 0), lambda trial: None, endless)
        if better is None:
            return evaluator, search.solution, 0
        if better.broken_off is not None:
            raise better.broken_off
        return evaluator, better.best, better.rehearsals


def saved(
    registry: Registry, runs: Sequence[Path], wanted: Sequence[str], world: Mapping[str, str]
) -> Iterator[Candidate]:
    """The plans of runs that the world accepted; `world` replaces options of the worlds of the runs.

    `wanted` names domains, tasks or `domain/task.method`; none stands for all. Raises UsageError for a name
    that no such plan has.
    """
    found = [candidate for run in runs if (candidate := _saved(registry, run, world))]
    names = {name for candidate in found for name in candidate.names}
    for name in wanted:
        if name not in names:
            raise UsageError(f"these runs have no accepted plan for {name!r}{did_you_mean(name, names)}")
    yield from (one for one in found if not wanted or set(wanted) & set(one.names))


def each_once(some: Sequence[Candidate]) -> list[Candidate]:
    """Those whose plan for their scene is not that of an earlier one, too."""
    plans = {
        (one.case, one.known.begun.get("scene"), str(one.known.plan)): one
        for one in reversed(some)
        if one.known
    }
    return [*reversed(plans.values())]


def _saved(registry: Registry, run: Path, world: Mapping[str, str]) -> Candidate | None:
    """The plan of a run; None where none was accepted, its goal is its own, or its log is damaged."""
    try:
        known = plan_of(run)
    except UsageError:
        return None
    options = known.options
    if not known.accepted or options.goal is not None:
        return None
    improve = registry.get(PresetSpec, options.preset).improve if options.improve is None else options.improve
    changes = {"world_options": {**options.world_options, **world}, "improve": improve}
    options = options.model_copy(update=changes)
    name = options.method if options.preset == DEFAULT_PRESET else f"{options.method}.{options.preset}"
    known = replace(known, options=options)
    return Candidate(f"{options.task}.{name}", options, known, room=known.room, run=run)
