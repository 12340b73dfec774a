"""The field test from the command line, as a table, a chart and files."""

import itertools
from collections.abc import Callable, Generator, Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

from rich.console import Console

from proc3s.benchmark.candidates import Candidate, each_once, saved, searched
from proc3s.benchmark.cases import Case, find_cases
from proc3s.benchmark.execution_test import Conditions, FieldTest, field_tests
from proc3s.cli.console.tables import print_table
from proc3s.cli.failures import say
from proc3s.cli.handlers.bench import deliver, go_through, made_folder, write
from proc3s.cli.handlers.runs import run_folders
from proc3s.errors import Proc3sError, UsageError
from proc3s.planning.options import key_values
from proc3s.planning.repetition import require_error
from proc3s.plugins.registry import Registry, open_registry
from proc3s.plugins.versions import versions
from proc3s.runs.reading import LOG
from proc3s.suites.hold_rates import HoldRate, chart, hold_rates
from proc3s.suites.lock import alone_in
from proc3s.suites.room_rates import RoomRate, room_chart, room_rates
from proc3s.wording import count

CHART, ROOM_CHART = "hold_rates.svg", "hold_by_room.svg"
SEEDS, IMPROVE = 5, 24
"""Of fixed programs, where the command line says nothing."""
Work: TypeAlias = Sequence[Callable[[], Candidate]]
"""What finds the plans to be tested, one by one."""
T = TypeVar("T", Case, Candidate)


@dataclass(frozen=True)
class FieldTestWanted:
    """What `proc3s bench execution` was asked to do; no task stands for all of them.

    Without `engines` that of the domain, without `error` (mm) disturbances, without `runs` fixed programs.
    """

    tasks: tuple[str, ...]
    times: int
    seeds: int | None = None
    samples: int | None = None
    robust: int | None = None
    improve: int | None = None
    engines: tuple[str, ...] = ()
    error: tuple[float, ...] = ()
    runs: Path | None = None
    world_options: Sequence[str] = ()
    plugins: Sequence[Path] = ()

    @property
    def conditions(self) -> Conditions:
        """How plans are carried out."""
        return Conditions(self.times, self.engines or (None,), self.error or (None,))

    @property
    def compares(self) -> bool:
        """Whether engines, errors or runs were asked for; the table then says more."""
        return bool(self.engines or self.error or self.runs)


def run_field_test(wanted: FieldTestWanted, out: Path | None, as_json: bool) -> None:
    """Test, print and write. What is done when it is interrupted is kept. Raises UsageError."""
    for error in wanted.error:
        require_error(error)
    registry = open_registry(wanted.plugins)
    work = _plans(registry, wanted, wanted.runs) if wanted.runs else _searches(registry, wanted)
    folder, done = made_folder(out, "execution"), list[FieldTest]()
    with alone_in(folder):
        stopped = go_through(_test(registry, work, wanted.conditions, done), as_json)
        rates, rooms = hold_rates(done), room_rates(done)
        for name, drawn in ((CHART, chart(rates)), (ROOM_CHART, room_chart(rooms))):
            if drawn:
                write(folder / name, drawn)
        deliver(folder, _document(wanted, done, rates, rooms, stopped), as_json)
        if not as_json:
            _print(rates, rooms, folder, wanted.compares)
    if stopped is not None:
        raise stopped


def _searches(registry: Registry, wanted: FieldTestWanted) -> Work:
    """Searches of fixed programs for the first plan, and for one that is improved, and rehearsed if wanted.

    Raises UsageError if none can be tested.
    """
    cases = find_cases(registry, wanted.tasks, wanted.world_options)
    fit = _fit(registry, wanted, cases)
    if not fit:
        errors = "such errors" if wanted.error else "disturbances"
        raise UsageError(f"none of these programs has a task with a judge and a world with {errors}")
    safer = (
        wanted.robust or 0,
        IMPROVE if wanted.improve is None else wanted.improve,
    )
    seeds = range(SEEDS if wanted.seeds is None else wanted.seeds)
    return [
        partial(searched, registry, case, seed, rehearsals, wanted.samples, improve)
        for case, seed, (rehearsals, improve) in itertools.product(fit, seeds, dict.fromkeys([(0, 0), safer]))
    ]


def _plans(registry: Registry, wanted: FieldTestWanted, folder: Path) -> Work:
    """The plans of runs. Raises UsageError if none can be tested, or for an option of searches."""
    searching = {"--seeds": wanted.seeds, "--samples": wanted.samples, "--robust": wanted.robust}
    searching |= {"--improve": wanted.improve}
    for flag, value in searching.items():
        if value is not None:
            raise UsageError(f"--runs takes plans that are there, and searches none; leave {flag} out")
    runs = _runs_in(folder)
    world = key_values([*wanted.world_options])
    fit = _fit(registry, wanted, [*saved(registry, runs, wanted.tasks, world)])
    if not fit:
        needs = "an accepted plan, a task with a judge, and a world with such errors"
        raise UsageError(f"{folder} has {count(len(runs), 'run')}, but none with {needs}")
    if (left := len(runs) - len(fit)) and not wanted.tasks:
        say([f"{left} of {len(runs)} runs are left out: no accepted plan, no judge, or no such errors"])
    once = each_once(fit)
    if more := len(fit) - len(once):
        say([f"{count(more, 'run')} more with the plan of another one: each plan counts once"])
    return [partial(_there, one) for one in once]


def _runs_in(folder: Path) -> list[Path]:
    """The runs in a folder, or itself if it is one. Raises UsageError if there is none."""
    if not folder.is_dir():
        raise UsageError(f"there is no folder {folder}")
    runs = [folder] if (folder / LOG).is_file() else run_folders(folder)
    if not runs:
        raise UsageError(f"there is no run in {folder}")
    return runs


def _there(candidate: Candidate) -> Candidate:
    return candidate


def _fit(registry: Registry, wanted: FieldTestWanted, some: Sequence[T]) -> list[T]:
    """Those whose task can be tested. Raises UsageError for an option that their world does not have."""
    fit = [one for one in some if wanted.conditions.fit(registry, one.task)]
    names = dict.fromkeys(one.task.partition("/")[0] for one in (some if wanted.tasks else fit))
    domains = [registry.domain(name) for name in names]
    wanted.conditions.require(domains, key_values([*wanted.world_options]))
    return fit


def _test(registry: Registry, work: Work, conditions: Conditions, done: list[FieldTest]) -> Generator[str]:
    """Fill the tests that are done; tells of each."""
    of = len(work) * len(conditions.engines) * len(conditions.errors_mm)
    for find in work:
        for test in field_tests(registry, find(), conditions):
            done.append(test)
            yield f"[{len(done)}/{of}] {_told(test)}"


def _told(test: FieldTest) -> str:
    """A test in a line."""
    way = "improved" if test.improve else count(test.robust, "rehearsal") if test.robust else ""
    room = "" if test.room is None else f"room {test.room:.1f}"
    error = "" if test.error_mm is None else f"{test.error_mm:g} mm"
    outcome = f"{test.satisfied} of {test.times} hold" if test.solved else "no plan"
    parts = (test.run or f"{test.case} seed {test.seed}", way, room, test.engine, error)
    return f"{', '.join(part for part in parts if part)}: {outcome}"


def _document(
    wanted: FieldTestWanted,
    done: Sequence[FieldTest],
    rates: Sequence[HoldRate],
    rooms: Sequence[RoomRate],
    error: Proc3sError | None,
) -> dict[str, Any]:
    return {
        "options": {
            "suite": "execution",
            **asdict(wanted),
            "runs": str(wanted.runs) if wanted.runs else None,
            "plugins": [str(path) for path in wanted.plugins],
        },
        "time": datetime.now(UTC).isoformat(timespec="seconds"),
        "versions": versions(),
        "error": str(error) if error else None,
        "rows": [_row(rate) for rate in rates],
        "rooms": [{"room": rate.room, **_row(rate), **_halves(rate)} for rate in rooms],
        "tests": [asdict(test) for test in done],
    }


def _row(one: HoldRate) -> dict[str, Any]:
    return {
        "program": one.program,
        "rehearsals": one.rehearsals,
        "improve": one.improve,
        "engine": one.engine,
        "error_mm": one.error_mm,
        "solved": f"{one.plans}/{len(one.tests)}",
        "samples": one.samples,
        "satisfied": f"{one.held}/{one.times}",
        "share": round(one.rate.value, 4) if one.rate else None,
        "low": round(one.rate.low, 4) if one.rate else None,
        "high": round(one.rate.high, 4) if one.rate else None,
    }


def _halves(one: RoomRate) -> dict[str, str]:
    """How many hold of the even seeds, and of the odd ones."""
    even, odd = one.of_seeds(odd=False), one.of_seeds(odd=True)
    return {
        f"{name} seeds": f"{half.held}/{half.times}" if half.times else ""
        for name, half in (("even", even), ("odd", odd))
    }


def _print(rates: Sequence[HoldRate], rooms: Sequence[RoomRate], folder: Path, compares: bool) -> None:
    console = Console(highlight=False)
    if rates:
        console.print("Plans carried out with small errors")
        print_table(console, *_compared(rates) if compares else _plain(rates), keys=5 if compares else 2)
    if rooms:
        console.print("By room")
        halves = ("even seeds", "odd seeds")
        rows = [[one.room, *_held(one), *_halves(one).values()] for one in rooms]
        print_table(console, ("room", *_HELD, *halves), rows, keys=3)
    console.print(f"folder   {folder}", soft_wrap=True)


def _plain(rates: Sequence[HoldRate]) -> tuple[Sequence[str], list[list[str]]]:
    """What was searched, and how often its plans hold."""
    head = ("program", "rehearsals", "improve", "solved", "samples", "satisfied", "share")
    rows = [[str(cell) for name, cell in _row(one).items() if name in head[:-1]] for one in rates]
    return head, [
        [*row, f"{one.rate.value:.1%}" if one.rate else ""] for row, one in zip(rows, rates, strict=True)
    ]


_HELD = ("engine", "mm", "plans", "held", "%", "95 % interval")


def _compared(rates: Sequence[HoldRate]) -> tuple[Sequence[str], list[list[str]]]:
    """How often plans hold in each engine with each error."""
    head = ("program", "robust", "improve", *_HELD)
    return head, [[one.program, str(one.rehearsals), str(one.improve), *_held(one)] for one in rates]


def _held(one: HoldRate) -> list[str]:
    """Engine, error, and how often plans hold."""
    return [
        one.engine or "",
        "" if one.error_mm is None else f"{one.error_mm:g}",
        *(str(one.plans), f"{one.held}/{one.times}"),
        f"{100 * one.rate.value:.0f}" if one.rate else "",
        f"{100 * one.rate.low:.0f} to {100 * one.rate.high:.0f}" if one.rate else "",
    ]
