"""Options of a run as plain data, and the wiring of the chosen plugins into a `Setup`."""

import dataclasses
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import BaseModel, Field

from proc3s import specs
from proc3s.budget import Budget
from proc3s.domain import Domain
from proc3s.errors import UsageError, blame
from proc3s.executors import Executor
from proc3s.grounding import Setup
from proc3s.limits import make_limits
from proc3s.problem import Problem
from proc3s.prompts import Prompter
from proc3s.registry import Registry
from proc3s.samplers import Space
from proc3s.sketch.errors import SketchError
from proc3s.solving import Solver
from proc3s.specfile import validate
from proc3s.world import World
from proc3s.yamlfile import scalar

DEFAULT_SOLVER = "rejection"
DEFAULT_PRESET = "best"


class RunOptions(specs.Spec):
    """What a run was asked to do; with the same options it does the same again."""

    task: str
    llm: str | None = None
    method: str = "proc3s"
    solver: str | None = None
    preset: str = DEFAULT_PRESET
    executor: str = "serial"
    seed: int = Field(0, ge=0)
    goal: str | None = None
    samples: int | None = Field(None, ge=1)
    feedback: int | None = Field(None, ge=0)
    template_dir: Path | None = None
    plugins: tuple[Path, ...] = ()
    domain_options: dict[str, str] = Field(default_factory=dict)
    method_options: dict[str, str] = Field(default_factory=dict)
    solver_options: dict[str, str] = Field(default_factory=dict)
    llm_options: dict[str, str] = Field(default_factory=dict)
    limits: dict[str, str] = Field(default_factory=dict)
    unsafe_exec: bool = False
    jobs: int = Field(1, ge=1)
    no_screens: bool = False
    audit: int = Field(0, ge=0)
    robust: int = Field(0, ge=0)
    check_goal: bool | None = None
    candidates: int = Field(1, ge=1)
    llm_jobs: int | None = Field(None, ge=1)
    record: Path | None = None
    budget: Budget = Budget()


def key_values(pairs: list[str]) -> dict[str, str]:
    """`["count=7"]` -> {"count": "7"}. Raises UsageError for a pair without `=`."""
    for pair in pairs:
        if "=" not in pair:
            raise UsageError(f"an option is given as key=value, not {pair!r}")
    values = dict(pair.split("=", 1) for pair in pairs)
    for name in values:
        if len({pair for pair in pairs if pair.split("=", 1)[0] == name}) > 1:
            raise UsageError(f"the option {name!r} is given several times, with different values")
    return values


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
    if options.goal is not None and not options.goal.strip():
        raise UsageError("--goal is empty; leave it out, or say what is to be done")
    goal = options.goal or task.instruction
    if goal is None and goal_needed:
        raise UsageError(f'{options.task} has no instruction of its own; give one with --goal "…"')
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
        robust=options.robust,
        screens="none" if options.no_screens else preset.screens,
    )


def make_prompter(registry: Registry, options: RunOptions, problem: Problem) -> Prompter:
    """The prompter of the chosen method; folders in the order user, domain, plugins."""
    method = select_method(registry, options)
    if options.template_dir is not None and not options.template_dir.is_dir():
        raise UsageError(f"there is no template folder {options.template_dir}")
    own = [options.template_dir] if options.template_dir else []
    return Prompter(
        method=method,
        preset=registry.get(specs.PresetSpec, options.preset),
        folders=(*own, *_template_folders(registry, problem.domain)),
        context=registry.plugins.prompt_context(problem, method),
    )


def _template_folders(registry: Registry, domain: Domain) -> list[Path]:
    registered = [spec.folder for spec in registry.all(specs.TemplatesSpec).values()]
    own = domain.spec.folder / "templates" if domain.spec.folder else None
    return [*([own] if own and own.is_dir() else []), *reversed(registered)]


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
    return executor


def make_setup(registry: Registry, options: RunOptions, problem: Problem) -> Setup:
    """The parts of the second stage: solver, executor, method and preset."""
    method = select_method(registry, options)
    preset = registry.get(specs.PresetSpec, options.preset)
    name = options.solver or method.solver or preset.solver or DEFAULT_SOLVER
    solver = registry.get(specs.SolverSpec, name)
    solver_options = part_options(solver, options.solver_options)
    make = solver.load()
    executor = make_executor(registry, options.executor, options.jobs)
    problem.domain.require(problem.task)
    limits, clock_limits = make_limits(options.limits)
    if problem.robust and problem.domain.spec.world.load().disturb is World.disturb:
        raise UsageError(f"--robust: nothing disturbs the world of {problem.domain.spec.name}")

    def make_solver(space: Space, budget: int, rng: np.random.Generator) -> Solver:
        with blame(f"solver {name}", SketchError):
            made: Solver = make(space, budget, rng, solver_options)
        return made

    return Setup(
        problem=dataclasses.replace(problem, step_limit=clock_limits.step),
        method=method,
        preset=preset,
        solver=name,
        make_solver=make_solver,
        executor=executor,
        limits=limits,
        clock_limits=clock_limits,
        locked=not options.unsafe_exec,
        audit=options.audit,
    )


def options_model(spec: specs.SolverSpec | specs.LLMSpec) -> type[BaseModel] | None:
    """The pydantic model of the options of a solver or backend. Raises SpecError if it cannot be imported."""
    if spec.options is None:
        return None
    found: type[BaseModel] = specs.Target(target=spec.options).load()
    return found


def part_options(spec: specs.SolverSpec | specs.LLMSpec, given: Mapping[str, str]) -> BaseModel | None:
    """The options of a solver or backend, validated by its own model. Raises SpecError or UsageError."""
    where = f"{spec.kind.removesuffix('s')} {spec.name}"
    model = options_model(spec)
    if model is None:
        if given:
            raise UsageError(f"{where} takes no option {next(iter(given))!r}")
        return None
    with blame(where):  # validators of its own may raise anything
        return validate(model, given, where)
