"""The field test from the command line, as a table and as files."""

import itertools
from collections.abc import Generator, Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from rich.console import Console

from proc3s.benchmark.cases import Case, find_cases
from proc3s.benchmark.execution_test import FieldTest, field_tests, judged
from proc3s.cli.console.tables import print_table
from proc3s.cli.handlers.bench import deliver, go_through, made_folder
from proc3s.errors import Proc3sError
from proc3s.plugins.registry import Registry, open_registry
from proc3s.plugins.versions import versions
from proc3s.suites.lock import alone_in

HEAD = ("program", "rehearsals", "solved", "samples", "satisfied", "share")


@dataclass(frozen=True)
class FieldTestWanted:
    """What `proc3s bench execution` was asked to do; no task stands for all of them."""

    tasks: tuple[str, ...]
    seeds: int
    times: int
    samples: int | None = None
    robust: int = 2
    world_options: Sequence[str] = ()
    plugins: Sequence[Path] = ()


def run_field_test(wanted: FieldTestWanted, out: Path | None, as_json: bool) -> None:
    """Test, print and write. What is done when it is interrupted is kept. Raises UsageError."""
    registry = open_registry(wanted.plugins)
    cases = judged(find_cases(registry, wanted.tasks, wanted.world_options), registry)
    folder, done = made_folder(out, "execution"), list[FieldTest]()
    with alone_in(folder):
        stopped = go_through(_test(registry, cases, wanted, done), as_json)
        deliver(folder, _document(wanted, done, stopped), as_json)
        if not as_json:
            _print(done, folder)
    if stopped is not None:
        raise stopped


def _test(
    registry: Registry, cases: Sequence[Case], wanted: FieldTestWanted, done: list[FieldTest]
) -> Generator[str]:
    """Fill the tests that are done; tells what it does next."""
    robust = tuple(dict.fromkeys((0, wanted.robust)))
    for case, seed in itertools.product(cases, range(wanted.seeds)):
        yield f"{case.label} seed {seed}"
        done.extend(field_tests(registry, case, seed, robust, wanted.times, wanted.samples))


def _document(
    wanted: FieldTestWanted, done: Sequence[FieldTest], error: Proc3sError | None
) -> dict[str, Any]:
    return {
        "options": {
            "suite": "execution",
            **asdict(wanted),
            "plugins": [str(path) for path in wanted.plugins],
        },
        "time": datetime.now(UTC).isoformat(timespec="seconds"),
        "versions": versions(),
        "error": str(error) if error else None,
        "rows": [dict(zip(HEAD, row, strict=True)) for row in _rows(done)],
        "tests": [asdict(test) for test in done],
    }


def _rows(done: Sequence[FieldTest]) -> list[tuple[Any, ...]]:
    """One row for every case and number of rehearsals, and one for all cases together."""
    keys = dict.fromkeys((test.case, test.robust) for test in done)
    rows = [
        _row(case, robust, [t for t in done if (t.case, t.robust) == (case, robust)]) for case, robust in keys
    ]
    for robust in dict.fromkeys(test.robust for test in done):
        rows.append(_row("all", robust, [test for test in done if test.robust == robust]))
    return rows


def _row(case: str, robust: int, tests: Sequence[FieldTest]) -> tuple[Any, ...]:
    times, satisfied = sum(test.times for test in tests), sum(test.satisfied for test in tests)
    solved, samples = sum(test.solved for test in tests), sum(test.samples for test in tests)
    share = round(satisfied / times, 4) if times else None
    return case, robust, f"{solved}/{len(tests)}", samples, f"{satisfied}/{times}", share


def _print(done: Sequence[FieldTest], folder: Path) -> None:
    console = Console(highlight=False)
    console.print("Plans carried out with small errors")
    lines = [[*map(str, cells), "" if share is None else f"{share:.1%}"] for *cells, share in _rows(done)]
    print_table(console, HEAD, lines, keys=2)
    console.print(f"folder   {folder}", soft_wrap=True)
