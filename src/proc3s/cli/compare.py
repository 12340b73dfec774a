"""`proc3s compare`."""

from pathlib import Path
from typing import Annotated

import typer

from proc3s.cli import arguments as a


def compare(
    first: Annotated[Path, typer.Argument(metavar="A", help="folder of a suite's results")],
    second: Annotated[Path, typer.Argument(metavar="B", help="folder of another's")],
    json: a.Json = False,
) -> None:
    """Compare the results of two suites, paired by task, method and seed: B less A, with intervals."""
    import json as json_

    from rich.console import Console
    from rich.markup import escape
    from rich.table import Table

    from proc3s.suites.comparison import comparison
    from proc3s.suites.results import read_results

    table = comparison(read_results(first), read_results(second))
    if json:
        lines = [dict(zip(table.head, line, strict=True)) for line in table.lines]
        typer.echo(json_.dumps({"differences": lines, "note": table.note}, indent=2, ensure_ascii=False))
        return
    shown = Table(*table.head, box=None, pad_edge=False)
    for line in table.lines:
        shown.add_row(*map(escape, line))
    out = Console(highlight=False, width=max(120, Console().width))
    out.print(shown)
    out.print(table.note, style="dim")
