"""A suite from the command line: begun or gone on with, watched, and made into tables."""

import json
import shutil
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import typer

from proc3s.cli.console.suite import SuiteConsole
from proc3s.cli.handlers.bench import made_folder
from proc3s.cli.streams import print_document
from proc3s.errors import Interrupted, Proc3sError, UsageError, did_you_mean
from proc3s.llm.budget import Budget
from proc3s.llm.config import choose_llm
from proc3s.llm.errors import BudgetSpent
from proc3s.planning.expense import in_words
from proc3s.planning.film import films
from proc3s.planning.limits import clock_only, make_limits
from proc3s.planning.options import key_values
from proc3s.plugins.registry import Registry, open_registry
from proc3s.plugins.versions import versions
from proc3s.specs.suite import Cell, SuiteSpec, load_suite
from proc3s.suites.changes import changes
from proc3s.suites.export import FIGURES, document, write_files
from proc3s.suites.lock import alone_in
from proc3s.suites.outcomes import Unfinished, as_error, reasons
from proc3s.suites.page import report_of
from proc3s.suites.preflight import check_order
from proc3s.suites.results import read_results
from proc3s.suites.runner import ALIKE, RUNS, Order, Runner, remaining
from proc3s.suites.store import Store
from proc3s.wording import count

OTHERS = ("ccsp", "execution", "command")
"""Benchmarks that are no suites; each is a command of its own."""


@dataclass(frozen=True)
class SuiteWanted:
    """What `proc3s bench SUITE` was asked to do; what is empty or None is left to the suite."""

    suite: str
    tasks: tuple[str, ...] = ()
    methods: tuple[str, ...] = ()
    presets: tuple[str, ...] = ()
    seeds: int | None = None
    samples: int | None = None
    llm: str | None = None
    llm_options: Sequence[str] = ()
    llm_jobs: int | None = None
    world_options: Sequence[str] = ()
    jobs: int = 1
    max_cost: float | None = None
    check_goal: bool | None = None
    limits: Sequence[str] = ()
    record: Path | None = None
    template_dir: Path | None = None
    plugins: Sequence[Path] = ()
    out: Path | None = None
    resume: Path | None = None


def run_suite(wanted: SuiteWanted, as_json: bool) -> None:
    """Run what is not finished, and write the tables; those of a suite that is broken off, too.

    Raises UsageError, and the error that left an episode unfinished.
    """
    if wanted.out and wanted.resume:
        raise UsageError(f"--out changes nothing: --resume goes on in {wanted.resume}; leave one of them out")
    registry = open_registry(wanted.plugins)
    spec = _spec(registry, wanted)
    order = _order(registry, wanted, spec)
    cells = _to_do(spec, wanted.resume)
    if (most := check_order(registry, order, cells)) and not as_json:
        limits = in_words(most, Budget(max_cost=order.max_cost or None))
        typer.echo(f"proc3s: {order.llm} for {count(len(cells), 'episode')}: {limits}", err=True)
    folder = wanted.resume or made_folder(wanted.out, spec.name)
    with alone_in(folder):
        _carry_out(registry, order, Store(folder, make=wanted.resume is None), wanted, as_json)


def _to_do(spec: SuiteSpec, resumed: Path | None) -> list[Cell]:
    """The episodes that will be begun."""
    return remaining(spec, Store(resumed)) if resumed else list(spec.cells())


def _carry_out(registry: Registry, order: Order, store: Store, wanted: SuiteWanted, as_json: bool) -> None:
    spec, folder = order.spec, store.folder
    if wanted.resume is None:
        _begin(store, order)
    else:
        _go_on(registry, store, order)
    todo = remaining(spec, store)
    unfinished: list[Unfinished] = []
    stopped: Proc3sError | None = None
    runner = Runner(order, store)
    console = SuiteConsole(spec, store.episodes(), quiet=as_json)
    try:
        with console:
            for outcome in runner.outcomes(todo):
                console.add(outcome, runner.spent)
                report_of(folder / RUNS / outcome.cell.folder, registry)  # now, so that the end is quick
                unfinished += [outcome] if isinstance(outcome, Unfinished) else []
    except KeyboardInterrupt:
        stopped = Interrupted("interrupted; what is finished is kept")
    results = read_results(folder)
    tables = write_files(results, folder, registry)
    if as_json:
        print_document(json.dumps(document(results, tables), indent=2, ensure_ascii=False))
    else:
        console.result(tables, folder)
    if left := len(remaining(spec, store)):
        raise _reason(stopped, unfinished, left, runner.hopeless, folder)


def _spec(registry: Registry, wanted: SuiteWanted) -> SuiteSpec:
    """The suite, cut down to what is wanted. Raises UsageError for names that do not exist."""
    path = Path(wanted.suite)
    if path.suffix in (".yaml", ".yml"):
        if not path.is_file():
            raise UsageError(f"there is no suite {path}")
        spec = load_suite(path)
    elif wanted.suite in (suites := registry.all(SuiteSpec)):
        spec = suites[wanted.suite]
    else:
        if wanted.suite in OTHERS:
            raise UsageError(f"`proc3s bench {wanted.suite}` comes first, its options after that")
        known = [*OTHERS, *suites]
        raise UsageError(f"there is no benchmark {wanted.suite!r}{did_you_mean(wanted.suite, known)}")
    tasks = tuple(t for t in spec.tasks if _named(t, wanted.tasks)) if wanted.tasks else spec.tasks
    for name in wanted.tasks:
        if not any(_named(task, (name,)) for task in spec.tasks):
            raise UsageError(f"the suite {spec.name} has no task {name!r}{did_you_mean(name, spec.tasks)}")
    given = {
        "tasks": tasks,
        "methods": wanted.methods or spec.methods,
        "presets": wanted.presets or spec.presets,
        "seeds": wanted.seeds or spec.seeds,
        "samples": wanted.samples or spec.samples,
    }
    return spec.model_copy(update=given)


def _named(task: str, names: tuple[str, ...]) -> bool:
    """Whether a task, or its domain, is among the names."""
    return task in names or task.partition("/")[0] in names


def _order(registry: Registry, wanted: SuiteWanted, spec: SuiteSpec) -> Order:
    """What is run and how. Raises UsageError for a task, method or preset that is not there."""
    from proc3s.specs.parts import MethodSpec, PresetSpec

    for method in spec.methods:
        registry.get(MethodSpec, method)
    for preset in spec.presets:
        registry.get(PresetSpec, preset)
    judged = {task: bool(registry.task(task)[1].judge) for task in spec.tasks}
    limits = key_values(list(wanted.limits))
    make_limits(limits)
    chosen = choose_llm(wanted.llm, key_values(list(wanted.llm_options)))
    return Order(
        spec=spec,
        llm=chosen.name,
        llm_options=tuple(f"{key}={value}" for key, value in chosen.options.items()),
        arguments=(*_arguments(wanted), *_limits(limits)),
        again=tuple(_limits(clock_only(limits))),
        llm_jobs=wanted.llm_jobs,
        jobs=wanted.jobs,
        max_cost=wanted.max_cost,
        template_dir=wanted.template_dir,
        judged=judged,
        filmed=frozenset(task for task in spec.tasks if films(registry.task(task)[0])),
        world_options=key_values(list(wanted.world_options)),
    )


def _arguments(wanted: SuiteWanted) -> Iterator[str]:
    if wanted.check_goal is not None:
        yield "--check-goal" if wanted.check_goal else "--no-check-goal"
    if wanted.record is not None:
        yield from ("--record", str(wanted.record.absolute()))
    if wanted.template_dir is not None:
        yield from ("--template-dir", str(wanted.template_dir.absolute()))
    for pair in dict.fromkeys(wanted.world_options):
        yield from ("-W", pair)
    for path in wanted.plugins:
        yield from ("--plugin", str(path.absolute()))


def _limits(given: Mapping[str, str]) -> Iterator[str]:
    for name, value in given.items():
        yield from ("--limit", f"{name}={value}")


def _facts(order: Order) -> dict[str, Any]:
    """What makes an episode what it is, beside its place in the matrix."""
    return {
        "spec": order.spec.model_dump(mode="json"),
        "llm": order.llm,
        "llm_options": list(order.llm_options),
        "arguments": list(order.arguments),
        "versions": versions(),
    }


def _begin(store: Store, order: Order) -> None:
    if store.facts():
        raise UsageError(f"{store.folder} has results already; go on with them by --resume {store.folder}")
    if figures := order.spec.figures_file:
        shutil.copyfile(figures, store.folder / FIGURES)
    store.note({**_facts(order), "began": datetime.now(UTC).isoformat(timespec="seconds")})


def _go_on(registry: Registry, store: Store, order: Order) -> None:
    """Say what has changed since the suite began, and go on as things are now."""
    for sentence in changes(registry, store.facts(), _facts(order), store.episodes()):
        typer.echo(f"proc3s: {sentence}", err=True)
    store.note(_facts(order))


def _reason(
    stopped: Proc3sError | None, unfinished: list[Unfinished], left: int, hopeless: bool, folder: Path
) -> Proc3sError:
    """The error that a suite of which `left` episodes are not finished ends with."""
    verb = "is" if left == 1 else "are"
    more = f"{count(left, 'episode')} {verb} not finished; go on with --resume {folder}"
    if stopped is not None:
        return Interrupted(f"{stopped}; {more}")
    if not unfinished:
        return BudgetSpent(f"--max-cost is spent; {more}")
    why = [f"  {reason}" for reason in reasons(unfinished)]
    if hopeless and left > len(unfinished):
        why.append(f"  the latest {ALIKE} ended with the same error, so no more were begun")
    return as_error(unfinished, "\n".join([more, *why]))
