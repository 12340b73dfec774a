"""Pictures of a run that are drawn when somebody asks."""

import json
from collections.abc import Sequence
from pathlib import Path

import typer

from proc3s.cli.streams import print_document
from proc3s.errors import Proc3sError, UsageError
from proc3s.planning.film import draw_pictures
from proc3s.plugins.registry import Registry, open_registry
from proc3s.runs.pictures import pictures_of
from proc3s.runs.reading import options_of


def print_pictures(run: Path, plugins: Sequence[Path], as_json: bool) -> None:
    """Draw what is missing, with the plugins of the run, and print where all are.

    Raises UsageError if there are none.
    """
    own = [Path(path) for path in options_of(run).get("plugins", ())]
    draw_pictures(run, open_registry([*own, *plugins]))
    found = [str(path) for path in pictures_of(run)]
    if as_json:
        print_document(json.dumps({"pictures": found}))
    elif found:
        typer.echo("\n".join(found))
    else:
        raise UsageError(f"{run} has no pictures: no plan was carried out, or its world draws none")


def draw_or_say(run: Path, registry: Registry) -> None:
    """Draw what is missing; without it a page is as good: what keeps it from being drawn is only said."""
    try:
        draw_pictures(run, registry)
    except Proc3sError as error:
        typer.echo(f"proc3s: some pictures are missing: {error}", err=True)
