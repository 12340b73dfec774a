"""Pictures of a plan that was carried out, when somebody looks: by its film, or carried out again."""

import json
import shutil
from collections.abc import Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

from proc3s.domain.domain import Domain
from proc3s.domain.state import State
from proc3s.domain.values import Action, Plan
from proc3s.domain.world import World, draws, make_world
from proc3s.errors import blame
from proc3s.planning.options import RunOptions
from proc3s.planning.setup import make_problem
from proc3s.plugins.registry import Registry
from proc3s.runs.pictures import FILM, OUTCOME, read_film, step_picture
from proc3s.runs.reading import events_of, options_of
from proc3s.search.problem import Problem
from proc3s.search.rollout import carry_out
from proc3s.specs.yaml_files import validate

Frames = Sequence[Any]


def films(domain: Domain) -> bool:
    """Whether the world in which plans of a domain are carried out keeps films."""
    make = (domain.spec.execution or domain.spec.world).load()
    return getattr(make, "film", World.film) is not World.film


def keep_film(frames: Frames, run: Path) -> None:
    """Write a film into a run folder."""
    (run / FILM).write_text(json.dumps(list(frames), allow_nan=False), encoding="utf-8")


def draw_steps(world: World[Any], initial: State, plan: Plan, frames: Frames, run: Path) -> None:
    """Draw the steps of a plan whose outcome is drawn, as far as a film has them and no picture is there."""
    if len(frames) != len(plan) + 1:
        return
    outcome, last = run / OUTCOME, run / step_picture(len(plan))
    if outcome.is_file() and not last.is_file():
        shutil.copyfile(outcome, last)  # the same, and quicker
    paths = {run / step_picture(done): frame for done, frame in enumerate(frames)}
    _draw(world, initial, {path: frame for path, frame in paths.items() if not path.is_file()})


def draw_pictures(run: Path, registry: Registry, steps: bool = True) -> None:
    """Draw what is missing of the pictures of a run's plan: its outcome and, with `steps`, one of each step.

    A run that has a picture and no film has all that its world draws. Raises UsageError or SpecError where
    the domain, or the simulator that the plan was carried out in, is not installed.
    """
    executed, frames = events_of(run, "plan_executed"), read_film(run)
    if not executed or ((run / OUTCOME).is_file() and not (steps and frames)):
        return
    plan = tuple(Action.from_json(action) for action in executed[-1]["plan"])
    options = validate(RunOptions, dict(options_of(run)), str(run))
    problem = make_problem(registry, options, goal_needed=False)
    spec = problem.domain.spec
    with closing(make_world(problem.domain, spec.execution or spec.world)) as world:
        if not frames:
            _draw_again(world, problem, plan, run)
            return
        if not (run / OUTCOME).is_file():
            _draw(world, problem.initial, {run / OUTCOME: frames[-1]})
        if steps:
            draw_steps(world, problem.initial, plan, frames, run)


def _draw(world: World[Any], initial: State, frames: Mapping[Path, Any]) -> None:
    if frames:
        with blame("world"):
            world.render_film(initial, frames)


def _draw_again(world: World[Any], problem: Problem, plan: Plan, run: Path) -> None:
    """Carry a plan out again, which ends as it did, and draw that; a world that draws nothing is spared."""
    if draws(world):
        with blame("world"):
            carry_out(world, problem, plan, stop=False)
            world.render(plan, run / OUTCOME)
