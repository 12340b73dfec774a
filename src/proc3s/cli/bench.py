"""`proc3s bench`."""

from pathlib import Path
from typing import Annotated

import typer

from proc3s.cli import arguments as a

Many = list[str] | None


def bench(
    suite: Annotated[
        str,
        typer.Argument(
            metavar="SUITE",
            help="`ccsp`: search fixed programs; `execution`: carry out what is found. No LLM",
        ),
    ],
    tasks: Annotated[
        Many, typer.Option("--tasks", help="domain, domain/task or domain/task.program, with commas  [all]")
    ] = None,
    solvers: Annotated[
        Many, typer.Option("--solvers", help="with commas; see `proc3s list solvers`  [all]")
    ] = None,
    seeds: Annotated[int, typer.Option("--seeds", min=1, help="scenes of every task: seeds 0 to N-1")] = 5,
    executor: a.ExecutorName = None,
    jobs: a.Jobs = None,
    samples: Annotated[
        int | None, typer.Option("--samples", min=1, help="limit of a search  [the task's budget]")
    ] = None,
    throughput: Annotated[
        int, typer.Option("--throughput", min=0, help="samples of the run in large batches; 0: none")
    ] = 4096,
    robust: Annotated[
        int, typer.Option("--robust", min=0, help="execution: rehearsals, compared with none")
    ] = 2,
    times: Annotated[
        int, typer.Option("--times", min=1, help="execution: how often every plan is carried out")
    ] = 10,
    out: Annotated[Path | None, typer.Option("--out", help="folder of the results  [runs/bench-…]")] = None,
    plugin: a.Plugins = None,
    json: a.Json = False,
) -> None:
    """Measure how fast programs are searched, every solver against the plain path, paired by seed; or how
    often the plans that are found lead to the goal when they are carried out with small errors."""
    from proc3s.cli.benching import SUITES, Wanted, run_bench
    from proc3s.cli.field_testing import run_field_test
    from proc3s.errors import UsageError, did_you_mean

    wanted = Wanted(
        suite=suite,
        tasks=_split(tasks),
        solvers=_split(solvers),
        seeds=seeds,
        executor=executor or ("processes" if (jobs or 1) > 1 else "serial"),
        jobs=jobs or 1,
        samples=samples,
        throughput=throughput,
        robust=robust,
        times=times,
        plugins=tuple(plugin or ()),
    )
    if suite not in SUITES:
        raise UsageError(f"there is no benchmark {suite!r}{did_you_mean(suite, SUITES)}")
    {"ccsp": run_bench, "execution": run_field_test}[suite](wanted, out, json)


def _split(given: Many) -> tuple[str, ...]:
    return tuple(name for text in given or () for name in text.split(",") if name)
