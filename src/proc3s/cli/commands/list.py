"""`proc3s list` and `proc3s show`."""

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
    name: Annotated[
        str,
        typer.Argument(metavar="NAME", help="a domain, a task (domain/task), a method, a solver, an LLM, …"),
    ],
    plugin: a.Plugins = None,
    json: a.Json = False,
) -> None:
    """Show one of them: what it is, its parameters and options."""
    from proc3s.cli.handlers.list import print_spec

    print_spec(name, plugin or [], json)
