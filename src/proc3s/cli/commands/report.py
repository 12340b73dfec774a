"""`proc3s report`."""

from pathlib import Path
from typing import Annotated

import typer

from proc3s.cli import arguments as a


def report(
    run: a.Run = None,
    open_: Annotated[bool, typer.Option("--open", help="show the page in your browser")] = False,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="PATH", help="file of the page (default: RUN/report.html)")
    ] = None,
    plugin: a.Plugins = None,
) -> None:
    """Write a run as one HTML page: prompts, answers, programs, samples, failures, pictures, timings."""
    from proc3s.cli.handlers.pictures import draw_or_say
    from proc3s.cli.handlers.runs import chosen_run
    from proc3s.plugins.registry import folders_of, open_registry
    from proc3s.reporting.history import read_story
    from proc3s.reporting.page import write

    folder = chosen_run(run)
    path = out or folder / "report.html"
    registry = open_registry(plugin or [])
    draw_or_say(folder, registry)
    write(read_story(folder), folders_of(registry), path)
    typer.echo(path)
    if open_:
        typer.launch(path.resolve().as_uri())
