"""`proc3s replay`."""

from pathlib import Path
from typing import Annotated

import typer

from proc3s.cli import arguments as a


def replay(
    *,
    run: Annotated[Path, typer.Argument(metavar="RUN", help="run folder")],
    given: Annotated[a.Given, a.fields("solver", "samples", "executor", "solver_options")],
    out: a.Out = None,
    json: a.Json = False,
) -> None:
    """Solve the last program of a run again, without an LLM. With the same options: the identical plan."""
    from proc3s.cli.handlers.run import replay_run

    replay_run(run, given, out, json)
