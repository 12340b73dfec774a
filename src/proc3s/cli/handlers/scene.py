"""The picture of a task's scene."""

import json
from collections.abc import Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

import typer

from proc3s.cli.failures import warn_of_failures
from proc3s.cli.streams import print_document
from proc3s.domain.world import draws, make_world
from proc3s.errors import UsageError, blame
from proc3s.planning.options import run_options
from proc3s.planning.setup import make_problem
from proc3s.plugins.registry import open_registry
from proc3s.search.problem import Problem


def draw_scene(
    name: str, given: Mapping[str, Any], plugins: Sequence[Path], out: Path | None, as_json: bool
) -> None:
    """Draw the scene and print the file's path. Raises UsageError for a world that draws nothing."""
    if "/" not in name:
        raise UsageError(f"--picture draws the scene of a task; name one, e.g. {name}/…: `proc3s list tasks`")
    registry = open_registry(plugins)
    options = run_options(task=name, **given)
    problem = make_problem(registry, options, goal_needed=False)
    path = out or Path(f"{name.replace('/', '-')}-seed{options.seed}.png")
    _draw(problem, path)
    warn_of_failures(registry)
    if as_json:
        print_document(json.dumps({"picture": str(path)}))
    else:
        typer.echo(path)


def _draw(problem: Problem, path: Path) -> None:
    with closing(make_world(problem.domain)) as world, blame("world"):
        if draws(world):
            world.reset(problem.initial)
            world.render_marked((), path, ())
            if path.is_file():
                return
    raise UsageError(f"the world of {problem.domain.spec.name} draws no pictures: it has no `render`")
