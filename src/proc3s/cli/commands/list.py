"""`proc3s list` and `proc3s show`."""

from pathlib import Path
from typing import Annotated

import typer

from proc3s.cli import arguments as a


def list_(
    kind: Annotated[
        str | None, typer.Argument(metavar="KIND", help="domains, tasks, methods, solvers, … (default: all)")
    ] = None,
    plugin: a.Plugins = None,
    json: a.Json = False,
) -> None:
    """List what the plugins bring, by kind."""
    from proc3s.cli.handlers.list import print_list

    print_list(kind, plugin or [], json)


def show(
    *,
    name: Annotated[
        str,
        typer.Argument(metavar="NAME", help="a domain, a task (domain/task), a method, a solver, an LLM, …"),
    ],
    picture: Annotated[bool, typer.Option("--picture", help="draw the scene of a task as PNG")] = False,
    given: Annotated[a.Given, a.fields("seed", "domain_options", "world_options")],
    out: Annotated[
        Path | None, typer.Option("--out", metavar="PATH", help="its file (default: TASK-seedN.png)")
    ] = None,
    plugin: a.Plugins = None,
    json: a.Json = False,
) -> None:
    """Show one of them: what it is, its parameters and options; or how the scene of a task looks."""
    from proc3s.cli.handlers.list import print_spec
    from proc3s.cli.handlers.scene import draw_scene
    from proc3s.errors import UsageError

    if picture:
        draw_scene(name, given, plugin or [], out, json)
    elif given or out:
        raise UsageError("--seed, -D, -W and --out go with --picture")
    else:
        print_spec(name, plugin or [], json)
