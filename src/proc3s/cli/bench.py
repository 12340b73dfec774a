"""`proc3s bench`."""

from pathlib import Path
from typing import Annotated

import typer

from proc3s.cli import arguments as a

Many = list[str] | None


def bench(
    suite: Annotated[str, typer.Argument(metavar="SUITE", help="`ccsp`: search fixed programs, no LLM")],
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
    out: Annotated[Path | None, typer.Option("--out", help="folder of the results  [runs/bench-…]")] = None,
    plugin: a.Plugins = None,
    json: a.Json = False,
) -> None:
    """Measure how fast programs are searched: every solver against the plain path, paired by seed."""
    from proc3s.cli.benching import Wanted, run_bench

    wanted = Wanted(
        suite=suite,
        tasks=_split(tasks),
        solvers=_split(solvers),
        seeds=seeds,
        executor=executor or ("processes" if (jobs or 1) > 1 else "serial"),
        jobs=jobs or 1,
        samples=samples,
        throughput=throughput,
        plugins=tuple(plugin or ()),
    )
    run_bench(wanted, out, json)


def _split(given: Many) -> tuple[str, ...]:
    return tuple(name for text in given or () for name in text.split(",") if name)
