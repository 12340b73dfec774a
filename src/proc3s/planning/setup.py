"""Options of a run as plain data, and the wiring of the chosen plugins into a `Setup`."""

import dataclasses
import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from proc3s import specs
from proc3s.domain.samplers import Space
from proc3s.domain.world import World
from proc3s.domain.world_options import with_world_options
from proc3s.errors import Issue, SpecError, UsageError, blame, did_you_mean
from proc3s.llm.types import Message
from proc3s.planning.limits import make_limits
from proc3s.planning.options import DEFAULT_SOLVER, RunOptions
from proc3s.planning.parts import Setup
from proc3s.planning.ways_on import goal_missing
from proc3s.plugins.part_options import part_options
from proc3s.plugins.registry import Registry, folders_of
from proc3s.prompts.conversation import Exchange, conversation
from proc3s.prompts.prompter import Prompter
from proc3s.sandbox.errors import SketchError
from proc3s.search.executor import Executor
from proc3s.search.problem import Problem
from proc3s.search.solver import Solver
from proc3s.search.start import MakeSolver
from proc3s.specs.given import importable
from proc3s.specs.yaml_files import validate
from proc3s.specs.yaml_reader import scalar


def select_method(registry: Registry, options: RunOptions) -> specs.MethodSpec:
    """The method with what the command line changes in it."""
    method = registry.get(specs.MethodSpec, options.method)
    changes: dict[str, Any] = dict(options.method_options)
    if options.feedback is not None:
        if "rounds" in options.method_options:
            raise UsageError("--feedback and -M rounds=… say the same; leave one of them out")
        changes["rounds"] = options.feedback
    return validate(specs.MethodSpec, {**method.model_dump(), **changes}, f"method {method.name}")


def make_problem(registry: Registry, options: RunOptions, goal_needed: bool = True) -> Problem:
    """The problem of a task and a seed, before there is a program.

    Raises UsageError if the task has no instruction of its own and `goal` gives none.
    """
    domain, task = registry.task(options.task)
    domain = with_world_options(domain, options.world_options)
    if options.goal is not None and not options.goal.strip():
        raise UsageError("--goal is empty; leave it out, or say what is to be done")
    goal = options.goal or task.instruction
    if goal is None and goal_needed:
        raise goal_missing(registry, options)
    preset = registry.get(specs.PresetSpec, options.preset)
    budget = {**domain.spec.budget, **task.budget}
    if options.samples is None and preset.budget not in budget:
        raise UsageError(f"{options.task} has no budget {preset.budget!r}; give --samples")
    state = domain.scene(task, options.seed, {k: scalar(v) for k, v in options.domain_options.items()})
    return Problem(
        domain=domain,
        task=task,
        scene=json.dumps(domain.states.dump(state)),
        goal=goal or "",
        seed=options.seed,
        samples=options.samples or budget[preset.budget],
        check_goal=preset.check_goal if options.check_goal is None else options.check_goal,
        robust=options.robust or 0,
        screens="none" if options.no_screens else preset.screens,
    )


def make_prompter(registry: Registry, options: RunOptions, problem: Problem) -> Prompter:
    """The prompter of the chosen method; folders in the order user, domain, plugins."""
    method = select_method(registry, options)
    if options.template_dir is not None and not options.template_dir.is_dir():
        raise UsageError(
            f"there is no template folder {options.template_dir}; `proc3s new templates` begins one"
        )
    own = [options.template_dir] if options.template_dir else []
    return Prompter(
        method=method,
        preset=registry.get(specs.PresetSpec, options.preset),
        folders=(*own, *template_folders(registry, problem.domain.spec)),
        context=registry.plugins.prompt_context(problem, method),
    )


def template_folders(registry: Registry, domain: specs.DomainSpec) -> tuple[Path, ...]:
    """Folders of templates for prompts of a domain: its own, if it has one, before those of plugins."""
    own = domain.folder / "templates" if domain.folder else None
    return (*([own] if own and own.is_dir() else []), *folders_of(registry))


def first_messages(
    registry: Registry, options: RunOptions, history: Iterable[Exchange] = ()
) -> tuple[Message, ...]:
    """The messages that a run would ask an LLM first, or after a history; that is read after the task."""
    problem = make_problem(registry, options)
    exchanges = tuple(history)
    return conversation(make_prompter(registry, options, problem), problem, exchanges)


def make_executor(registry: Registry, name: str, jobs: int) -> Executor:
    """The executor with so many jobs. Raises UsageError if it has no use for them."""
    spec = registry.get(specs.ExecutorSpec, name)
    if spec.most_jobs is not None and jobs > spec.most_jobs:
        raise UsageError(
            f"the executor {name} takes at most --jobs {spec.most_jobs}, not {jobs}; leave one of the two out"
        )
    make = spec.load()
    with blame(f"executor {name}"):
        executor: Executor = make(jobs=jobs)
    if missing := [method for method in ("map", "close") if not callable(getattr(executor, method, None))]:
        raise SpecError([Issue(spec.target, f"executor {name}", f"has no method {missing[0]!r}")])
    return executor


def solver_maker(
    registry: Registry, name: str, objective: str, options: Mapping[str, str] | None = None
) -> MakeSolver:
    """Makes a solver of that name. Raises UsageError if it does not look for what is wanted."""
    known = registry.all(specs.SolverSpec)
    fit = [each.name for each in known.values() if each.objective == objective]
    flag = "--solver" if objective == "progress" else "--improver"
    if name not in known:
        raise UsageError(f"{flag}: there is no solver {name!r}{did_you_mean(name, fit)}")
    spec = known[name]
    if spec.objective != objective:
        raise UsageError(f"{flag}: {name} looks for {spec.objective}; take one of {', '.join(fit)}")
    given = part_options(spec, options or {})
    make = spec.load()

    def make_solver(space: Space, budget: int, rng: np.random.Generator) -> Solver:
        with blame(f"solver {name}", SketchError):
            made: Solver = make(space, budget, rng, given)
        return made

    return make_solver


def make_setup(
    registry: Registry, options: RunOptions, problem: Problem | None = None, goal_needed: bool = True
) -> Setup:
    """The parts of the second stage: problem (unless it is given), solver, executor, method and preset."""
    problem = problem or make_problem(registry, options, goal_needed)
    method = select_method(registry, options)
    preset = registry.get(specs.PresetSpec, options.preset)
    name = options.solver or method.solver or preset.solver or DEFAULT_SOLVER
    make_solver = solver_maker(registry, name, "progress", options.solver_options)
    improver = options.improver or preset.improver
    make_improver = solver_maker(registry, improver, "room")
    executor = make_executor(registry, options.executor, options.jobs)
    problem.domain.require(problem.task)
    if options.jobs > 1:
        _refuse_unimportable(problem)
    limits, clock_limits = make_limits(options.limits)
    disturbed = problem.domain.spec.world.load().disturb is not World.disturb
    if problem.robust and not disturbed:
        raise UsageError(f"--robust: nothing disturbs the world of {problem.domain.spec.name}")

    return Setup(
        problem=dataclasses.replace(problem, step_limit=clock_limits.step),
        method=method,
        preset=preset,
        solver=name,
        make_solver=make_solver,
        improver=improver,
        make_improver=make_improver,
        executor=executor,
        limits=limits,
        clock_limits=clock_limits,
        locked=not options.unsafe_exec,
        audit=options.audit,
        improve=preset.improve if options.improve is None else options.improve,
        rehearsals=problem.robust or (preset.rehearsals if disturbed else 0),
    )


def _refuse_unimportable(problem: Problem) -> None:
    """Raises UsageError for a skill, constraint or judge that worker processes could not import."""
    for field, target in problem.domain.targets(problem.task):
        if not importable(target.target):
            raise UsageError(
                f"{field}: a function of a script or notebook cannot be imported by worker processes; put it "
                "into a module, or use jobs=1"
            )
