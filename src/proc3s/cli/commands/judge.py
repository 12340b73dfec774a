"""`proc3s judge`."""

from pathlib import Path
from typing import Annotated

import typer


def judge(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="folder of a suite's results")],
    everything: Annotated[
        bool, typer.Option("--all", help="also what the judge and you agree on, and what you judged before")
    ] = False,
) -> None:
    """Step through the outcomes of a suite and record what you say of each, beside the machine's verdict."""
    from proc3s.cli.handlers.judge import step_through

    step_through(folder, everything)
