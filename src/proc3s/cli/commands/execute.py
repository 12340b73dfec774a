"""`proc3s execute`."""

from typing import Annotated

import typer

from proc3s.cli import arguments as a


def execute(
    *,
    run: a.Run = None,
    error: Annotated[
        float,
        typer.Option(
            "--error",
            metavar="MM",
            help="everything stands and is put down up to MM (0 to 50) off, and turned by up to MM/2 degrees",
            rich_help_panel="World",
            show_default=False,
        ),
    ] = 0.0,
    times: Annotated[
        int | None,
        typer.Option(
            "--times",
            metavar="N",
            min=1,
            help="each time with other errors (default: 10; 1 without --error)",
            rich_help_panel="World",
        ),
    ] = None,
    given: Annotated[a.Given, a.fields("world_options", "plugins")],
    json: a.Json = False,
) -> None:
    """Carry the plan of a run out again, without an LLM: with small errors, or in another world.

    The exit code is 0 if it reached the goal every time. Errors are drawn from fixed seeds, so the same
    command gives the same outcomes. The run folder stays as it is.
    """
    from proc3s.cli.handlers.execute import execute_run
    from proc3s.cli.handlers.runs import chosen_run

    execute_run(chosen_run(run), given, error, times, json)
