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

    from proc3s.cli.console.tables import print_table
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
    out = Console(highlight=False)
    for table in (differences, ended):
        print_table(out, table.head, table.lines)
        out.print(table.note, style="dim", markup=False)
