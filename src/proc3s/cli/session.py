"""One run from the command line: options to parts, parts to a run folder, a console and a summary."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import typer

from proc3s.cli.console import Console
from proc3s.conversation import ask_llm, given_program
from proc3s.errors import Proc3sError, UsageError
from proc3s.events import Emit, Event, RunEnded, RunStarted
from proc3s.llms import Source
from proc3s.options import (
    RunOptions,
    key_values,
    make_llm,
    make_problem,
    make_prompter,
    make_setup,
)
from proc3s.planner import Outcome, plan
from proc3s.registry import Registry, open_registry
from proc3s.runs import RunFolder, events_of, new_folder, started, versions
from proc3s.specfile import validate
from proc3s.summary import Summary, summarize


def run_options(**given: Any) -> RunOptions:
    """Options of a run from the arguments of a command; None leaves the default."""
    values = {name: value for name, value in given.items() if value is not None}
    for name in ("domain_options", "method_options", "solver_options", "llm_options", "limits"):
        values[name] = key_values(values.get(name, []))
    if "plugins" in values:
        values["plugins"] = [path.resolve() for path in values["plugins"]]
    if "template_dir" in values:
        values["template_dir"] = values["template_dir"].resolve()
    if values.get("jobs", 1) > 1:
        values.setdefault("executor", "processes")
    return validate(RunOptions, values, "options")


def read_program(path: Path) -> str:
    """The text of a program. Raises UsageError if it cannot be read."""
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"the program {path} cannot be read: {error}") from error


@dataclass(frozen=True)
class Given:
    """A program that is there already, where it is from, and the round whose random draws it takes."""

    program: str
    origin: Source = "none"
    round: int = 0


def run_task(
    options: Callable[[], RunOptions],
    out: Path | None,
    as_json: bool,
    given: Callable[[], Given] | None = None,
) -> None:
    """Run and print the summary; ends the process with its exit code.

    With `as_json` even a wrong option gives the whole document, with the mistake under `error`.
    """
    try:
        summary, code = _run(options(), out, as_json, given() if given else None)
    except Proc3sError as error:
        if as_json:
            typer.echo(Summary(error=str(error)).model_dump_json(indent=2))
        raise
    if as_json:
        typer.echo(summary.model_dump_json(indent=2))
    raise typer.Exit(code)


def replay_run(run: Path, changes: dict[str, Any], out: Path | None, as_json: bool) -> None:
    """Search the last program of a run again, with the random draws of its round."""

    def options() -> RunOptions:
        changed = {name: value for name, value in changes.items() if value is not None}
        if "solver_options" in changed:
            changed["solver_options"] = key_values(changed["solver_options"])
        return validate(RunOptions, {**started(run)["options"], **changed}, str(run))

    def given() -> Given:
        programs = events_of(run, "program_extracted")
        if not programs:
            raise UsageError(f"{run} has no program to replay")
        sources = {e["round"]: e["completion"]["source"] for e in events_of(run, "answer_received")}
        executed = [event["round"] for event in events_of(run, "plan_executed")]
        last = next((p for p in programs if p["round"] in executed), programs[-1])
        origin = sources.get(last["round"], "none")
        return Given(last["source"], "recorded" if origin == "live" else origin, last["round"])

    run_task(options, out, as_json, given)


def _run(options: RunOptions, out: Path | None, as_json: bool, given: Given | None) -> tuple[Summary, int]:
    if given is not None:
        options = options.model_copy(update={"feedback": 0})
    if options.unsafe_exec:
        typer.echo("proc3s: WARNING: with --unsafe-exec the LLM's programs can read your files", err=True)
    registry = open_registry(options.plugins)
    problem = make_problem(registry, options, goal_needed=given is None)
    setup = make_setup(registry, options, problem)
    if given is None:
        llm, prompter = make_llm(registry, options), make_prompter(registry, options, problem)
        prompter.rehearse(problem)
        ask = partial(ask_llm, llm, prompter, problem)
    path = out or new_folder(Path("runs"), options.task, options.method, options.seed)
    setup = replace(setup, picture=path / "plan.png")
    folder = RunFolder(path)
    console = Console(options, quiet=as_json)
    emit = _broadcast(registry, folder, console)
    try:
        emit(
            RunStarted(
                options=options.model_dump(mode="json"),
                versions=versions(),
                samples=problem.samples,
                scene=problem.scene,
            )
        )
        with console:
            propose = given_program(given.program, given.origin, given.round) if given else ask(emit)
            outcome = plan(setup, propose, emit)
        summary = summarize(options, setup, outcome, path)
        emit(RunEnded(summary=summary.model_dump(mode="json")))
    finally:
        folder.close()
        setup.executor.close()
    console.result(summary)
    for status in registry.plugins.failures:
        typer.echo(f"proc3s: plugin {status.name} ({status.source}) failed: {status.error}", err=True)
    return summary, exit_code(outcome, summary)


def _broadcast(registry: Registry, folder: RunFolder, console: Console) -> Emit:
    def emit(event: Event) -> None:
        folder.emit(event)
        console.update(event)
        registry.plugins.on_event(event)

    return emit


def exit_code(outcome: Outcome, summary: Summary) -> int:
    """0 solved, 1 unsolved, or the code of the error that ended the run."""
    if outcome.error is not None:
        typer.echo(f"proc3s: {outcome.error}", err=True)
        return outcome.error.exit_code
    return 0 if summary.solved else 1
