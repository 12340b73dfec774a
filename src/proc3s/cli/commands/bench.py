"""`proc3s bench`, and the benchmarks that ask no LLM: `ccsp`, `execution` and `command`."""

from pathlib import Path
from typing import Annotated, TypeAlias

import typer

from proc3s.cli import arguments as a

Many: TypeAlias = list[str] | None


def _seeds(default: str) -> typer.models.OptionInfo:
    option: typer.models.OptionInfo = typer.Option(
        "--seeds",
        metavar="N",
        min=1,
        help=f"scenes of every task: seeds 0 to N-1 (default: {default})",
        rich_help_panel="Episodes",
    )
    return option


def _names(flag: str, help_: str) -> typer.models.OptionInfo:
    option: typer.models.OptionInfo = typer.Option(
        flag, metavar="NAMES", help=help_, rich_help_panel="Episodes"
    )
    return option


Seeds: TypeAlias = Annotated[int | None, _seeds("5")]
Programs: TypeAlias = Annotated[
    Many, _names("--tasks", "domain, domain/task or domain/task.program, with commas (default: all)")
]
Out: TypeAlias = Annotated[
    Path | None, typer.Option("--out", metavar="PATH", help="folder of the results (default: runs/…)")
]


def bench(
    *,
    suite: Annotated[
        str, typer.Argument(metavar="SUITE", help="see `proc3s list suites`; or a YAML file with one")
    ],
    tasks: Annotated[
        Many, _names("--tasks", "domain or domain/task, with commas (default: the suite's)")
    ] = None,
    methods: Annotated[Many, _names("--methods", "with commas (default: the suite's)")] = None,
    preset: Annotated[Many, _names("--preset", "with commas (default: the suite's)")] = None,
    seeds: Annotated[int | None, _seeds("the suite's")] = None,
    given: Annotated[
        a.Given,
        a.fields(
            *("llm", "llm_options", "llm_jobs", "record", "max_cost", "template_dir"),
            *("check_goal", "samples", "jobs", "world_options", "limits", "plugins"),
        ),
    ],
    out: Out = None,
    resume: Annotated[
        Path | None,
        typer.Option("--resume", metavar="DIR", help="go on with a suite that was broken off"),
    ] = None,
    json: a.Json = False,
) -> None:
    """Run a suite, which is tasks by methods, presets and seeds, and make its tables.

    Others ask no LLM and have a --help of their own: `proc3s bench ccsp` measures how fast programs are
    searched, `proc3s bench execution` how often plans reach the goal despite small errors, and
    `proc3s bench command` what whole runs cost.
    """
    from proc3s.cli.handlers.bench_suite import SuiteWanted, run_suite

    wanted = SuiteWanted(
        **given,
        suite=suite,
        tasks=_split("--tasks", tasks),
        methods=_split("--methods", methods),
        presets=_split("--preset", preset),
        seeds=seeds,
        out=out,
        resume=resume,
    )
    run_suite(wanted, json)


def ccsp(
    *,
    tasks: Programs = None,
    solvers: Annotated[
        Many, _names("--solvers", "with commas; see `proc3s list solvers` (default: all)")
    ] = None,
    seeds: Seeds = None,
    given: Annotated[a.Given, a.fields("samples", "executor", "jobs", "world_options", "plugins")],
    throughput: Annotated[
        int,
        typer.Option(
            "--throughput",
            metavar="N",
            min=0,
            help="samples in large batches; 0: none",
            rich_help_panel="Search",
        ),
    ] = 4096,
    out: Out = None,
    json: a.Json = False,
) -> None:
    """Measure how fast fixed programs are searched: every solver against the plain path, paired by seed."""
    from proc3s.cli.handlers.bench import SearchesWanted, run_bench

    jobs = given.pop("jobs", 1)
    given.setdefault("executor", "processes" if jobs > 1 else "serial")
    wanted = SearchesWanted(
        **given,
        tasks=_split("--tasks", tasks),
        solvers=_split("--solvers", solvers),
        seeds=seeds or 5,
        jobs=jobs,
        throughput=throughput,
    )
    run_bench(wanted, out, json)


def command(
    *,
    tasks: Annotated[
        Many, _names("--tasks", "domain or domain/task, with commas (default: all with a bundled answer)")
    ] = None,
    seeds: Seeds = None,
    against: Annotated[
        str | None,
        typer.Option(
            "--against",
            metavar="PYTHON",
            help="Python of another environment with proc3s; every run is made by both, in turns",
            rich_help_panel="Episodes",
        ),
    ] = None,
    given: Annotated[a.Given, a.fields("preset", "improve", "world_options", "plugins")],
    out: Out = None,
    json: a.Json = False,
) -> None:
    """Measure what a whole `proc3s run` with a bundled answer costs, by stage, in CPU and wall seconds."""
    from proc3s.cli.handlers.bench_command import CommandsWanted, run_bench_command

    wanted = CommandsWanted(**given, tasks=_split("--tasks", tasks), seeds=seeds or 5, against=against)
    run_bench_command(wanted, out, json)


def execution(
    *,
    tasks: Programs = None,
    seeds: Seeds = None,
    runs: Annotated[
        Path | None,
        typer.Option(
            "--runs",
            metavar="DIR",
            help="take the accepted plans of these runs, or of a suite's, and search none",
            rich_help_panel="Episodes",
        ),
    ] = None,
    given: Annotated[a.Given, a.fields("samples", "robust", "improve", "world_options", "plugins")],
    engines: Annotated[
        Many,
        typer.Option(
            "--engines",
            metavar="NAMES",
            help="carry every plan out in each, with commas: values of -W execution=…",
            rich_help_panel="World",
        ),
    ] = None,
    error: Annotated[
        Many,
        typer.Option(
            "--error",
            metavar="MM",
            help="everything stands and is put down up to MM (0 to 50) off; several with commas",
            rich_help_panel="World",
        ),
    ] = None,
    times: Annotated[
        int,
        typer.Option(
            "--times",
            metavar="N",
            min=1,
            help="how often every plan is carried out; once where the error is 0",
            rich_help_panel="World",
        ),
    ] = 10,
    out: Out = None,
    json: a.Json = False,
) -> None:
    """Measure how often plans reach the goal when they are carried out with small errors.

    Plans that were improved (--improve, 24 if it is not given; --robust) are compared with the first ones
    that were found. Without --error the world is disturbed as in rehearsals. With it, table and
    hold_rates.svg say how often plans hold with which error, and hold_by_room.svg with which room.
    """
    from proc3s.cli.handlers.bench_execution import FieldTestWanted, run_field_test

    wanted = FieldTestWanted(
        **given,
        tasks=_split("--tasks", tasks),
        seeds=seeds,
        times=times,
        engines=tuple(dict.fromkeys(_split("--engines", engines))),
        error=_numbers("--error", error),
        runs=runs,
    )
    run_field_test(wanted, out, json)


def _numbers(flag: str, given: Many) -> tuple[float, ...]:
    """Numbers with commas between them, each once. Raises UsageError."""
    from proc3s.errors import UsageError

    try:
        return tuple(dict.fromkeys(float(text) for text in _split(flag, given)))
    except ValueError as error:
        raise UsageError(f"{flag} takes numbers with commas between them: {error}") from error


def _split(flag: str, given: Many) -> tuple[str, ...]:
    """Names with commas between them. Raises UsageError if the option was given, and names nothing."""
    from proc3s.errors import UsageError

    names = tuple(name for text in given or () for name in text.split(",") if name)
    if given is not None and not names:
        raise UsageError(f"{flag} is empty; leave it out, or name some")
    return names
