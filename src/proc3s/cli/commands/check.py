"""`proc3s check`."""

from typing import Annotated

import typer

from proc3s.cli import arguments as a


def check(
    *,
    domain: Annotated[
        str,
        typer.Argument(
            metavar="DOMAIN", help="name of an installed domain, a domain.yaml, or a folder with one"
        ),
    ],
    seconds: Annotated[
        float,
        typer.Option(
            "--seconds", metavar="N", min=0, help="time for finding plans that a screen rejects wrongly"
        ),
    ] = 20.0,
    given: Annotated[a.Given, a.fields("world_options")],
    plugin: a.Plugins = None,
    json: a.Json = False,
) -> None:
    """Examine a domain: does it do what solvers, workers and models rely on? Exit code 2 on errors."""
    from proc3s.cli.handlers.check import examine_domain

    raise typer.Exit(examine_domain(domain, seconds, given, tuple(plugin or ()), json))
