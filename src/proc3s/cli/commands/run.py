"""`proc3s run` and `proc3s solve`."""

from pathlib import Path
from typing import Annotated

import typer

from proc3s.cli import arguments as a


def run(
    task: Annotated[str | None, typer.Argument(metavar="TASK", help="domain/task, e.g. drawing/star")] = None,
    llm: a.Llm = None,
    candidates: a.Candidates = None,
    llm_jobs: a.LlmJobs = None,
    record: a.Record = None,
    max_cost: a.MaxCost = None,
    max_tokens: a.MaxTokens = None,
    max_calls: a.MaxCalls = None,
    method: a.Method = None,
    solver: a.Solver = None,
    preset: a.Preset = None,
    executor: a.ExecutorName = None,
    jobs: a.Jobs = None,
    check_goal: a.CheckGoal = None,
    no_screens: a.NoScreens = False,
    audit: a.AuditOption = None,
    robust: a.Robust = None,
    seed: a.Seed = None,
    goal: a.Goal = None,
    samples: a.Samples = None,
    feedback: a.Feedback = None,
    out: a.Out = None,
    resume: a.Resume = None,
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
    from proc3s.cli.handlers.run import resume_run, run_task, with_llm
    from proc3s.errors import UsageError
    from proc3s.planning.options import run_options
    from proc3s.planning.session import Job

    given = {
        "llm": llm,
        "candidates": candidates,
        "llm_jobs": llm_jobs,
        "record": record,
        "max_cost": max_cost,
        "max_tokens": max_tokens,
        "max_calls": max_calls,
        "method": method,
        "solver": solver,
        "preset": preset,
        "executor": executor,
        "jobs": jobs,
        "check_goal": check_goal,
        "no_screens": no_screens or None,
        "audit": audit,
        "robust": robust,
        "seed": seed,
        "goal": goal,
        "samples": samples,
        "feedback": feedback,
        "template_dir": template_dir,
        "plugins": plugin,
        "domain_options": domain_options,
        "method_options": method_options,
        "solver_options": solver_options,
        "llm_options": llm_options,
        "limits": limits,
        "unsafe_exec": unsafe_exec or None,
    }

    def job() -> Job:
        if task is None:
            raise UsageError("name a task, e.g. drawing/star (`proc3s list tasks`)")
        return Job(with_llm(run_options(task=task, **given)), out)

    if resume is None:
        run_task(job, json)
    else:
        resume_run(resume, task, {**given, "out": out}, json)


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
    robust: a.Robust = None,
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
    from proc3s.cli.handlers.run import read_program, run_task
    from proc3s.planning.options import run_options
    from proc3s.planning.session import Given, Job

    def job() -> Job:
        options = run_options(
            task=task,
            method=method,
            solver=solver,
            preset=preset,
            executor=executor,
            jobs=jobs,
            check_goal=check_goal,
            no_screens=no_screens,
            audit=audit,
            robust=robust,
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
        return Job(options, out, Given(read_program(sketch)))

    run_task(job, json)
