"""`proc3s run` and `proc3s solve`."""

from pathlib import Path
from typing import Annotated

import typer

from proc3s.cli import arguments as a


def run(
    *,
    task: Annotated[str | None, typer.Argument(metavar="TASK", help="domain/task, e.g. drawing/star")] = None,
    given: Annotated[a.Given, a.all_fields()],
    out: a.Out = None,
    resume: a.Resume = None,
    json: a.Json = False,
) -> None:
    """Solve a task: ask the LLM for a program, search its numbers, execute the plan, judge the result."""
    from proc3s.cli.handlers.run import resume_run, run_task, with_llm
    from proc3s.errors import UsageError
    from proc3s.planning.options import run_options
    from proc3s.planning.session import Job

    def job() -> Job:
        if task is None:
            raise UsageError("name a task, e.g. drawing/star (`proc3s list tasks`)")
        return Job(with_llm(run_options(task=task, **given)), out)

    if resume is None:
        run_task(job, json)
    else:
        resume_run(resume, task, {**given, "out": out}, json)


def solve(
    *,
    task: a.Task,
    sketch: Annotated[
        Path,
        typer.Option(
            "--sketch", metavar="PATH", help="program, or answer (.md) with one", rich_help_panel="Search"
        ),
    ],
    given: Annotated[a.Given, a.all_fields(asks=False)],
    out: a.Out = None,
    json: a.Json = False,
) -> None:
    """Second stage only: search the numbers of a program that is there already. Asks no LLM."""
    from proc3s.cli.handlers.run import read_program, run_task
    from proc3s.planning.options import run_options
    from proc3s.planning.session import Given, Job

    def job() -> Job:
        options = run_options(task=task, feedback=0, **given)
        return Job(options, out, Given(read_program(sketch)))

    run_task(job, json)
