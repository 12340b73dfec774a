"""The costs of whole commands from the command line, as a table and as files."""

import itertools
import shutil
import sys
from collections.abc import Generator, Sequence
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from rich.console import Console

from proc3s.benchmark.command_cost import (
    CommandCost,
    CommandRow,
    command_cost,
    command_rows,
    tasks_with_answers,
)
from proc3s.cli.console.tables import print_table
from proc3s.cli.handlers.bench import deliver, go_through, made_folder
from proc3s.errors import Proc3sError, UsageError
from proc3s.plugins.registry import open_registry
from proc3s.plugins.versions import versions
from proc3s.suites.lock import alone_in


@dataclass(frozen=True)
class CommandsWanted:
    """What `proc3s bench command` was asked to do; no task stands for all with a bundled answer."""

    tasks: tuple[str, ...]
    seeds: int
    against: str | None = None
    """The path of the other Python."""
    preset: str | None = None
    improve: int | None = None
    world_options: Sequence[str] = ()
    plugins: Sequence[Path] = ()

    @property
    def pythons(self) -> list[str]:
        """The other one first, if there is one."""
        return [*([self.against] if self.against else []), sys.executable]

    @property
    def arguments(self) -> list[str]:
        """What every run is told besides its task and seed."""
        preset = ["--preset", self.preset] if self.preset else []
        given = [("--improve", str(self.improve))] if self.improve is not None else []
        given += [("-W", option) for option in self.world_options]
        given += [("--plugin", str(path.absolute())) for path in self.plugins]
        return [*preset, *itertools.chain.from_iterable(given)]


def run_bench_command(wanted: CommandsWanted, out: Path | None, as_json: bool) -> None:
    """Measure, print and write. What is done when it is interrupted is kept. Raises UsageError."""
    if wanted.against:
        wanted = replace(wanted, against=_python(wanted.against))
    tasks = tasks_with_answers(open_registry(wanted.plugins), wanted.tasks)
    folder, costs = made_folder(out, "command"), list[CommandCost]()
    with alone_in(folder):
        stopped = go_through(_measure(tasks, wanted, costs), as_json)
        rows = command_rows(costs)
        deliver(folder, _document(wanted, costs, rows, stopped), as_json)
        if not as_json:
            _print(rows, folder, wanted)
    if stopped is not None:
        raise stopped


def _python(given: str) -> str:
    """The path of a Python that is given by its name or path. Raises UsageError if it cannot be run."""
    found = shutil.which(given)
    if found is None:
        raise UsageError(f"--against: there is no Python {given} that can be run")
    return str(Path(found).absolute())


def _measure(tasks: Sequence[str], wanted: CommandsWanted, costs: list[CommandCost]) -> Generator[str]:
    """Fill the costs; tells what it does next. The first of two takes turns."""
    for task, seed in itertools.product(tasks, range(wanted.seeds)):
        yield f"{task} seed {seed}"
        turns = wanted.pythons[:: -1 if seed % 2 else 1]
        costs += [command_cost(python, task, seed, wanted.arguments) for python in turns]


def _document(
    wanted: CommandsWanted,
    costs: Sequence[CommandCost],
    rows: Sequence[CommandRow],
    error: Proc3sError | None,
) -> dict[str, Any]:
    return {
        "options": {
            "suite": "command",
            **asdict(wanted),
            "plugins": [str(path) for path in wanted.plugins],
        },
        "time": datetime.now(UTC).isoformat(timespec="seconds"),
        "versions": versions(),
        "error": str(error) if error else None,
        "rows": [{**asdict(row), "cheaper": row.cheaper and row.cheaper.model_dump()} for row in rows],
        "runs": [{**asdict(cost), "total": cost.total} for cost in costs],
    }


def _print(rows: Sequence[CommandRow], folder: Path, wanted: CommandsWanted) -> None:
    console = Console(highlight=False)
    if rows:
        console.print("Whole runs, medians over seeds: CPU seconds by stage, and wall seconds")
        head = ("task", "python", "solved", *rows[0].cpu, "CPU", "wall", "cheaper")
        lines = [_cells(row, wanted) for row in rows]
        if not wanted.against:
            head, lines = (*head[:1], *head[2:-1]), [[*line[:1], *line[2:-1]] for line in lines]
        print_table(console, head, lines, keys=2 if wanted.against else 1)
    console.print(f"folder   {folder}", soft_wrap=True)


def _cells(row: CommandRow, wanted: CommandsWanted) -> list[str]:
    return [
        row.task,
        "other" if row.python == wanted.against else "this",
        f"{row.solved}/{row.seeds}",
        *(f"{seconds:.2f}" for seconds in row.cpu.values()),
        f"{row.total:.2f}",
        f"{row.wall:.2f}",
        str(row.cheaper) if row.cheaper and row.python != wanted.against else "",
    ]
