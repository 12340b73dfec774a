"""Which runs there are, and which one is meant where none is named."""

import json
from collections.abc import Iterator, Sequence
from datetime import datetime
from pathlib import Path
from textwrap import shorten

import typer
from rich.console import Console
from rich.table import Table
from rich.text import Text

from proc3s.cli.streams import print_document
from proc3s.errors import UsageError
from proc3s.runs.listing import ListedRun, listed
from proc3s.runs.newest import RUNS, itself, newest_run, runs_of
from proc3s.runs.reading import LOG
from proc3s.suites import runner
from proc3s.suites.store import FILE
from proc3s.wording import count

_LONGEST = 120
"""Characters of an error; `proc3s explain` tells it in full."""
_COLORS = {"solved": "green", "unsolved": "red", "error": "red", "at work": "cyan"}


def chosen_run(run: Path | None) -> Path:
    """The run that a command is about: a folder, one of `runs` by its name, or the newest, which is said."""
    if run is None:
        newest = newest_run()
        typer.echo(f"proc3s: the newest run, {newest}", err=True)
        return newest
    named = RUNS / run
    return itself(named if not run.exists() and (named / LOG).is_file() else run)


def run_folders(folder: Path) -> list[Path]:
    """The run folders in a folder of runs, or of a suite, the one that began last first."""
    return runs_of(folder / runner.RUNS if (folder / FILE).is_file() else folder)


def print_runs(folder: Path, limit: int, as_json: bool) -> None:
    """Print a line or two about each run. Raises UsageError if the folder holds none."""
    paths, suites = run_folders(folder), sorted(path.parent for path in folder.glob(f"*/{FILE}"))
    if not paths and not suites and not as_json:
        raise UsageError(f"there is no run in {folder}; try `proc3s run drawing/star`")
    shown = [listed(path) for path in paths[: limit or None]]
    if as_json:
        print_document(json.dumps([run.model_dump() for run in shown], indent=2, ensure_ascii=False))
        return
    _print(shown)
    if more := len(paths) - len(shown):
        typer.echo(f"{count(more, 'older run')} not shown: --limit 0 shows all")
    for suite in suites:
        typer.echo(f"suite: {suite} (`proc3s runs {suite}` lists its runs)")


def _print(runs: Sequence[ListedRun]) -> None:
    """Each with its folder in full, however long that is, and the rest below."""
    table = Table(box=None, show_header=False, pad_edge=False)
    for run in runs:
        table.add_row(Text(run.outcome, _COLORS.get(run.outcome, "yellow")), Text(run.folder, no_wrap=True))
        table.add_row("", Text(", ".join(_details(run)), "dim"))
    longest = max((len(run.folder) for run in runs), default=0)
    Console(highlight=False, width=max(Console().width, longest + 12)).print(table)


def _details(run: ListedRun) -> Iterator[str]:
    if run.began:
        yield f"{datetime.fromisoformat(run.began).astimezone():%Y-%m-%d %H:%M}"
    yield from (text for text in (run.task, run.method) if text)
    if run.task:
        yield run.llm or "no LLM"
    if run.samples is not None:
        yield count(run.samples, "sample")
    if run.goal_reached is False:
        yield "goal missed"
    if run.error:
        yield shorten(run.error, _LONGEST, placeholder=" …")
