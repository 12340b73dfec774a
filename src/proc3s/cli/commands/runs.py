"""`proc3s runs`."""

from pathlib import Path
from typing import Annotated

import typer

from proc3s.cli import arguments as a


def runs(
    folder: Annotated[
        Path,
        typer.Argument(metavar="DIR", help="folder of runs or a suite (default: runs)", show_default=False),
    ] = Path("runs"),
    limit: Annotated[int, typer.Option("--limit", metavar="N", min=0, help="at most so many; 0: all")] = 10,
    json: a.Json = False,
) -> None:
    """List runs, the newest first: outcome, folder, task, method, LLM, samples, time."""
    from proc3s.cli.handlers.runs import print_runs

    print_runs(folder, limit, json)
