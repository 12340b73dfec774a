"""`proc3s bench`."""

from pathlib import Path
from typing import Annotated

import typer

from proc3s.cli import arguments as a

Many = list[str] | None


def bench(
    *,
    suite: Annotated[
        str,
        typer.Argument(
            metavar="SUITE",
            help="a suite of runs (see `proc3s list suites`, or a YAML file); or, without an LLM, `ccsp`: "
            "search fixed programs, `execution`: carry out what is found",
        ),
    ],
    tasks: Annotated[
        Many,
        typer.Option(
            "--tasks", help="domain, domain/task or (ccsp, execution) domain/task.program, with commas  [all]"
        ),
    ] = None,
    methods: Annotated[
        Many, typer.Option("--methods", help="suites: with commas  [those of the suite]")
    ] = None,
    preset: Annotated[
        Many, typer.Option("--preset", help="suites: with commas  [those of the suite]")
    ] = None,
    solvers: Annotated[
        Many, typer.Option("--solvers", help="with commas; see `proc3s list solvers`  [all]")
    ] = None,
    seeds: Annotated[
        int | None,
        typer.Option("--seeds", min=1, help="scenes of every task: seeds 0 to N-1  [the suite's, or 5]"),
    ] = None,
    asking: Annotated[a.Given, a.fields("llm", "llm_options", "llm_jobs", "record", "check_goal", "limits")],
    max_cost: Annotated[
        float | None, typer.Option("--max-cost", min=0, help="US dollars that all live answers may cost")
    ] = None,
    resume: Annotated[
        Path | None,
        typer.Option("--resume", metavar="DIR", help="go on with a suite that was broken off"),
    ] = None,
    given: Annotated[a.Given, a.fields("executor", "jobs", "plugins")],
    samples: Annotated[
        int | None, typer.Option("--samples", min=1, help="limit of a search  [the task's budget]")
    ] = None,
    throughput: Annotated[
        int | None,
        typer.Option("--throughput", min=0, help="ccsp: samples in large batches; 0: none  [default: 4096]"),
    ] = None,
    robust: Annotated[
        int | None,
        typer.Option("--robust", min=0, help="execution: rehearsals, compared with none  [default: 2]"),
    ] = None,
    times: Annotated[
        int | None,
        typer.Option("--times", min=1, help="execution: how often every plan is carried out  [default: 10]"),
    ] = None,
    out: Annotated[Path | None, typer.Option("--out", help="folder of the results  [runs/bench-…]")] = None,
    json: a.Json = False,
) -> None:
    """Run a suite of tasks by methods and seeds, and make its tables. Or measure how fast programs are
    searched, every solver against the plain path, paired by seed; or how often the plans that are found lead
    to the goal when they are carried out with small errors."""
    from proc3s.cli.handlers.bench import SUITES, Wanted, refuse_empty, refuse_unused, run_bench
    from proc3s.cli.handlers.bench_execution import run_field_test
    from proc3s.cli.handlers.bench_suite import SuiteWanted, run_suite

    executor, jobs, plugins = given.get("executor"), given.get("jobs"), tuple(given.get("plugins", ()))
    of_suites = {a.OPTIONS[name].flag: value for name, value in asking.items()}
    of_suites |= {"--methods": methods, "--preset": preset, "--max-cost": max_cost, "--resume": resume}
    of_searches = {"--solvers": solvers, "--executor": executor, "--throughput": throughput}
    of_plans = {"--robust": robust, "--times": times}
    refuse_unused(
        suite,
        {
            "ccsp": {**of_suites, **of_plans},
            "execution": {**of_suites, **of_searches, "--jobs": jobs},
        }.get(suite, {**of_searches, **of_plans, **({"--out": out} if resume else {})}),
    )
    refuse_empty({"--tasks": tasks, "--methods": methods, "--preset": preset, "--solvers": solvers})
    if suite not in SUITES:
        run_suite(
            SuiteWanted(
                **asking,
                suite=suite,
                tasks=_split(tasks),
                methods=_split(methods),
                presets=_split(preset),
                seeds=seeds,
                samples=samples,
                jobs=jobs or 1,
                max_cost=max_cost,
                plugins=plugins,
                out=out,
                resume=resume,
            ),
            json,
        )
        return
    wanted = Wanted(
        suite=suite,
        tasks=_split(tasks),
        solvers=_split(solvers),
        seeds=seeds or 5,
        executor=executor or ("processes" if (jobs or 1) > 1 else "serial"),
        jobs=jobs or 1,
        samples=samples,
        throughput=4096 if throughput is None else throughput,
        robust=2 if robust is None else robust,
        times=times or 10,
        plugins=plugins,
    )
    {"ccsp": run_bench, "execution": run_field_test}[suite](wanted, out, json)


def _split(given: Many) -> tuple[str, ...]:
    return tuple(name for text in given or () for name in text.split(",") if name)
