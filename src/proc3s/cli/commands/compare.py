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

    from proc3s.cli.streams import print_document
    from proc3s.suites.comparison import comparison, outcomes
    from proc3s.suites.results import read_results

    both = read_results(first), read_results(second)
    differences, ended = comparison(*both), outcomes(*both)
    if json:
        told = {
            table.title.lower(): [dict(zip(table.head, line, strict=True)) for line in table.lines]
            for table in (differences, ended)
        }
        print_document(json_.dumps({**told, "note": differences.note}, indent=2, ensure_ascii=False))
        return
    out = Console(highlight=False, width=max(120, Console().width))
    for table in (differences, ended):
        shown = Table(*table.head, box=None, pad_edge=False)
        for line in table.lines:
            shown.add_row(*map(escape, line))
        out.print(shown)
        out.print(table.note, style="dim")
