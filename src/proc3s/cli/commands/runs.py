"""`proc3s runs`."""

from pathlib import Path
from typing import Annotated

import typer

from proc3s.cli import arguments as a


def runs(
    folder: Annotated[
        Path, typer.Argument(metavar="DIR", help="folder of run folders, or of a suite", show_default="runs")
    ] = Path("runs"),
    limit: Annotated[int, typer.Option("--limit", min=0, help="at most so many; 0: all")] = 10,
    json: a.Json = False,
) -> None:
    """List runs, the newest first: outcome, folder, task, method, LLM, samples, time."""
    from proc3s.cli.handlers.runs import print_runs

    print_runs(folder, limit, json)
