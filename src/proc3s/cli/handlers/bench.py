"""A benchmark from the command line: what is wanted, measured one by one, as a table and as files."""

import itertools
import json
from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, TypeAlias

from rich.console import Console

from proc3s.benchmark.cases import Case, find_cases
from proc3s.benchmark.measurement import PLAIN, Measurement, SearchVariant
from proc3s.benchmark.statistics import Row, rows
from proc3s.benchmark.throughput import Bench
from proc3s.cli.console.tables import print_table
from proc3s.cli.streams import print_document
from proc3s.errors import Interrupted, Proc3sError, UsageError
from proc3s.plugins.registry import Registry, open_registry
from proc3s.plugins.versions import versions
from proc3s.runs.folder import new_folder
from proc3s.specs.parts import ExecutorSpec, SolverSpec
from proc3s.suites.lock import alone_in

STAGES = "program + screens + world + other"
SEARCHES = (
    *("program", "way", "solved", "samples", "world", "us/sample", STAGES, "s/solution", "samples/s"),
    *("faster a sample", "fewer samples", "faster a solution", "faster by the clock"),
)
BATCHES = (
    *("program", "way", "us/sample", STAGES, "samples/s", "screens: plans/s", "wrong rejects"),
    *("world: plans/s", "faster"),
)


@dataclass(frozen=True)
class SearchesWanted:
    """What `proc3s bench ccsp` was asked to do; no task or solver stands for all of them."""

    tasks: tuple[str, ...]
    solvers: tuple[str, ...]
    seeds: int
    executor: str
    jobs: int
    throughput: int
    samples: int | None = None
    world_options: Sequence[str] = ()
    plugins: Sequence[Path] = ()


@dataclass
class Results:
    """What was measured up to now: searches, and runs in large batches."""

    searches: list[Measurement]
    throughput: list[Measurement]

    def document(self, wanted: SearchesWanted, error: Proc3sError | None) -> dict[str, Any]:
        """Everything as plain data."""
        return {
            "options": {"suite": "ccsp", **asdict(wanted), "plugins": [str(path) for path in wanted.plugins]},
            "time": datetime.now(UTC).isoformat(timespec="seconds"),
            "versions": versions(),
            "error": str(error) if error else None,
            "searches": [row.model_dump() for row in rows(self.searches)],
            "throughput": [row.model_dump() for row in rows(self.throughput)],
            "measurements": {
                "searches": [asdict(m) for m in self.searches],
                "throughput": [asdict(m) for m in self.throughput],
            },
        }


def run_bench(wanted: SearchesWanted, out: Path | None, as_json: bool) -> None:
    """Measure, print and write. What is done when it is interrupted is kept. Raises UsageError."""
    registry = open_registry(wanted.plugins)
    cases, ways = _chosen(registry, wanted)
    folder, results = made_folder(out, "ccsp"), Results([], [])
    with alone_in(folder):
        stopped = go_through(_measure(registry, cases, ways, wanted, results), as_json)
        write(folder / "results.md", _markdown(results))
        deliver(folder, results.document(wanted, stopped), as_json)
        if not as_json:
            _print(results, folder)
    if stopped is not None:
        raise stopped


def go_through(notes: Generator[str], quiet: bool) -> Proc3sError | None:
    """Print the notes of a measurement as it goes on; gives the error or interruption that ended it."""
    progress = Console(stderr=True, quiet=quiet, highlight=False)
    try:
        with closing(notes):
            for note in notes:
                progress.print(note)
    except KeyboardInterrupt:
        return Interrupted("interrupted; what was measured is kept")
    except Proc3sError as error:
        return error
    return None


def deliver(folder: Path, document: Mapping[str, Any], as_json: bool) -> None:
    """Write the document of a measurement, and print it if that is what it was called for."""
    text = json.dumps(document, indent=2, ensure_ascii=False)
    write(folder / "results.json", text + "\n")
    if as_json:
        print_document(text)


def _searching(registry: Registry) -> list[str]:
    """The solvers that look for an accepted plan."""
    return [name for name, spec in registry.all(SolverSpec).items() if spec.objective == "progress"]


def _chosen(registry: Registry, wanted: SearchesWanted) -> tuple[list[Case], list[SearchVariant]]:
    """The cases and ways that are wanted. Raises UsageError for names that do not exist."""
    registry.get(ExecutorSpec, wanted.executor)
    solvers = [registry.get(SolverSpec, name).name for name in wanted.solvers]
    ways = [
        SearchVariant(solver, solver, wanted.executor, wanted.jobs)
        for solver in dict.fromkeys(solvers or _searching(registry))
    ]
    if wanted.jobs > 1:
        plain = f"{PLAIN.name}, {wanted.jobs} jobs"
        ways.insert(0, SearchVariant(plain, PLAIN.solver, wanted.executor, wanted.jobs, saving=False))
    cases = find_cases(registry, wanted.tasks, wanted.world_options)
    if not cases:
        raise UsageError("no domain brings programs for a benchmark (bench/TASK.NAME.py beside its spec)")
    return cases, ways


def made_folder(out: Path | None, suite: str) -> Path:
    """The folder of the results; a new one below `runs` if none is named. Raises UsageError."""
    if out is None:
        return new_folder(Path("runs"), "bench", suite, 0)
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"the folder {out} cannot be made: {error.strerror}") from error
    return out


def _measure(
    registry: Registry,
    cases: Sequence[Case],
    ways: Sequence[SearchVariant],
    wanted: SearchesWanted,
    results: Results,
) -> Generator[str]:
    """Fill the results; tells what it does next."""
    with Bench(registry, ways, wanted.samples) as bench:
        for case, seed in itertools.product(cases, range(wanted.seeds)):
            yield f"{case.label} seed {seed}"
            results.searches.extend(bench.search(case, seed))
            if wanted.throughput:
                results.throughput.extend(bench.throughput(case, seed, wanted.throughput))


def write(path: Path, text: str) -> None:
    """Write a file of results. Raises UsageError."""
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise UsageError(f"{path} cannot be written: {error.strerror}") from error


def _search_cells(row: Row) -> list[str]:
    ratios = (row.faster_per_sample, row.fewer_samples, row.faster_per_solution, row.faster_by_the_clock)
    return [
        row.case,
        row.way,
        f"{row.solved}/{row.seeds}",
        f"{row.samples:.0f}",
        f"{row.evaluations:.0f}",
        f"{row.us_per_sample['total']:.1f}",
        _stages(row, "{:.1f}"),
        f"{row.s_per_solution['total']:.3g}" if row.s_per_solution else "",
        f"{row.samples_per_second:,.0f}",
        *(str(ratio) if ratio else "" for ratio in ratios),
    ]


def _batch_cells(row: Row) -> list[str]:
    screens = row.us_per_sample["screens"] if row.way != PLAIN.name else 0.0
    world = row.us_per_sample["world"] * row.samples / row.evaluations if row.evaluations else 0.0
    return [
        row.case,
        row.way,
        f"{row.us_per_sample['total']:.1f}",
        _stages(row, "{:.1f}"),
        f"{row.samples_per_second:,.0f}",
        f"{1e6 / screens:,.0f}" if screens else "",
        f"{row.wrong}/{row.audited}" if row.audited else "",
        f"{1e6 / world:,.0f}" if world else "",
        str(row.faster_per_sample or ""),
    ]


def _stages(row: Row, number: str) -> str:
    return " + ".join(number.format(value) for name, value in row.us_per_sample.items() if name != "total")


Lines: TypeAlias = list[list[str]]


def _tables(results: Results) -> Iterator[tuple[str, tuple[str, ...], Lines]]:
    """Title, head and lines."""
    yield "Until a plan is found", SEARCHES, [_search_cells(row) for row in rows(results.searches)]
    if results.throughput:
        lines = [_batch_cells(row) for row in rows(results.throughput)]
        yield "In large batches, whatever is accepted", BATCHES, lines


def _markdown(results: Results) -> str:
    parts = []
    for title, head, cells in _tables(results):
        lines = [f"| {' | '.join(line)} |" for line in (head, ["---"] * len(head), *cells)]
        parts.append(f"## {title}\n\n" + "\n".join(lines) + "\n")
    return "\n".join(parts)


def _print(results: Results, folder: Path) -> None:
    console = Console(highlight=False)
    for title, head, cells in _tables(results):
        console.print(title)
        print_table(console, head, cells, keys=2)
    console.print(f"folder   {folder}", soft_wrap=True)
