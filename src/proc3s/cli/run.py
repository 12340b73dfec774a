"""`proc3s run` and `proc3s solve`."""

from pathlib import Path
from typing import Annotated

import typer

from proc3s.cli import arguments as a


def run(
    task: a.Task,
    llm: a.Llm = None,
    method: a.Method = None,
    solver: a.Solver = None,
    preset: a.Preset = None,
    executor: a.ExecutorName = None,
    jobs: a.Jobs = None,
    check_goal: a.CheckGoal = None,
    no_screens: a.NoScreens = False,
    audit: a.AuditOption = None,
    seed: a.Seed = None,
    goal: a.Goal = None,
    samples: a.Samples = None,
    feedback: a.Feedback = None,
    out: a.Out = None,
    template_dir: a.TemplateDir = None,
    plugin: a.Plugins = None,
    domain_options: a.DomainOptions = None,
    method_options: a.MethodOptions = None,
    solver_options: a.SolverOptions = None,
    llm_options: a.LlmOptions = None,
    limits: a.LimitOptions = None,
    unsafe_exec: a.UnsafeExec = False,
    json: a.Json = False,
) -> None:
    """Solve a task: ask the LLM for a program, search its numbers, execute the plan, judge the result."""
    from proc3s.cli.session import run_options, run_task

    options = lambda: run_options(  # noqa: E731 - mistakes in options are reported inside run_task
        task=task,
        llm=llm,
        method=method,
        solver=solver,
        preset=preset,
        executor=executor,
        jobs=jobs,
        check_goal=check_goal,
        no_screens=no_screens,
        audit=audit,
        seed=seed,
        goal=goal,
        samples=samples,
        feedback=feedback,
        template_dir=template_dir,
        plugins=plugin,
        domain_options=domain_options,
        method_options=method_options,
        solver_options=solver_options,
        llm_options=llm_options,
        limits=limits,
        unsafe_exec=unsafe_exec,
    )
    run_task(options, out, json)


def solve(
    task: a.Task,
    sketch: Annotated[Path, typer.Option("--sketch", help="file with the program itself")],
    method: a.Method = None,
    solver: a.Solver = None,
    preset: a.Preset = None,
    executor: a.ExecutorName = None,
    jobs: a.Jobs = None,
    check_goal: a.CheckGoal = None,
    no_screens: a.NoScreens = False,
    audit: a.AuditOption = None,
    seed: a.Seed = None,
    goal: a.Goal = None,
    samples: a.Samples = None,
    out: a.Out = None,
    plugin: a.Plugins = None,
    domain_options: a.DomainOptions = None,
    method_options: a.MethodOptions = None,
    solver_options: a.SolverOptions = None,
    limits: a.LimitOptions = None,
    unsafe_exec: a.UnsafeExec = False,
    json: a.Json = False,
) -> None:
    """Second stage only: search the numbers of a program that is there already. Asks no LLM."""
    from proc3s.cli.session import Given, read_program, run_options, run_task

    options = lambda: run_options(  # noqa: E731 - mistakes in options are reported inside run_task
        task=task,
        method=method,
        solver=solver,
        preset=preset,
        executor=executor,
        jobs=jobs,
        check_goal=check_goal,
        no_screens=no_screens,
        audit=audit,
        seed=seed,
        goal=goal,
        samples=samples,
        feedback=0,
        plugins=plugin,
        domain_options=domain_options,
        method_options=method_options,
        solver_options=solver_options,
        limits=limits,
        unsafe_exec=unsafe_exec,
    )
    run_task(options, out, json, lambda: Given(read_program(sketch)))
