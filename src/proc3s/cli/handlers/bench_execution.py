"""The field test from the command line, as a table and as files."""

import json
from collections.abc import Sequence
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from proc3s.benchmark.cases import Case, find_cases
from proc3s.benchmark.execution_test import FieldTest, field_tests, judged
from proc3s.cli.handlers.bench import Wanted, made_folder, write
from proc3s.cli.streams import print_document
from proc3s.errors import Interrupted, Proc3sError
from proc3s.plugins.registry import Registry, open_registry
from proc3s.plugins.versions import versions
from proc3s.suites.lock import alone_in

HEAD = ("program", "rehearsals", "solved", "samples", "satisfied", "share")


def run_field_test(wanted: Wanted, out: Path | None, as_json: bool) -> None:
    """Test, print and write. What is done when it is interrupted is kept. Raises UsageError."""
    registry = open_registry(wanted.plugins)
    cases = judged(find_cases(registry, wanted.tasks), registry)
    folder = made_folder(out, wanted.suite)
    with alone_in(folder):
        _run_in(folder, registry, cases, wanted, as_json)


def _run_in(folder: Path, registry: Registry, cases: Sequence[Case], wanted: Wanted, as_json: bool) -> None:
    done: list[FieldTest] = []
    stopped: Proc3sError | None = None
    progress = Console(stderr=True, quiet=as_json, highlight=False)
    try:
        for case in cases:
            for seed in range(wanted.seeds):
                progress.print(f"{case.label} seed {seed}")
                robust = tuple(dict.fromkeys((0, wanted.robust)))
                for test in field_tests(registry, case, seed, robust, wanted.times, wanted.samples):
                    done.append(test)
    except KeyboardInterrupt:
        stopped = Interrupted("interrupted; what was measured is kept")
    except Proc3sError as error:
        stopped = error
    document = _document(wanted, done, stopped)
    write(folder / "results.json", json.dumps(document, indent=2, ensure_ascii=False) + "\n")
    if as_json:
        print_document(json.dumps(document, indent=2, ensure_ascii=False))
    else:
        _print(done, folder)
    if stopped is not None:
        raise stopped


def _document(wanted: Wanted, done: Sequence[FieldTest], error: Proc3sError | None) -> dict[str, Any]:
    return {
        "options": {**asdict(wanted), "plugins": [str(path) for path in wanted.plugins]},
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
    table = Table(*HEAD, box=None, pad_edge=False)
    for *cells, share in _rows(done):
        table.add_row(*map(str, cells), "" if share is None else f"{share:.1%}")
    console.print(table)
    console.print(f"folder   {folder}", soft_wrap=True)
