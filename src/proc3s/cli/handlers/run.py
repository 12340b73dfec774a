"""One run from the command line: options to parts, parts to a run folder, a console and a summary."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import typer

from proc3s.cli.console.run import Console
from proc3s.cli.failures import say, warn_of_failures
from proc3s.cli.streams import json_of, print_document
from proc3s.errors import Proc3sError, UsageError
from proc3s.llm.config import choose_llm
from proc3s.llm.types import Source
from proc3s.planning.limits import box_limits
from proc3s.planning.options import RunOptions, plain_options
from proc3s.planning.resume import past_of
from proc3s.planning.session import Ended, Given, Job, Session
from proc3s.planning.summary import Summary
from proc3s.plugins.versions import versions
from proc3s.prompts.extract import extract_program
from proc3s.runs.newest import itself
from proc3s.runs.reading import events_of, options_of
from proc3s.sandbox.errors import SketchError
from proc3s.specs.yaml_files import validate
from proc3s.textfiles import read_text

_MAY_CHANGE = {"llm", "llm_options", "llm_jobs", "jobs", "executor", "record", "budget", "limits"}
"""What another process may do otherwise, and still go on with the same run."""


def with_llm(options: RunOptions) -> RunOptions:
    """The options with the LLM that is asked, whoever chose it; says so if it was not the command line."""
    chosen = choose_llm(options.llm, options.llm_options)
    if chosen.by not in ("--llm", "default"):
        typer.echo(f"proc3s: asking {chosen.name}, as {chosen.by} says", err=True)
    return options.model_copy(update={"llm": chosen.name, "llm_options": dict(chosen.options)})


def read_program(path: Path) -> str:
    """The text of a program, or the program in an answer (`.md`). Raises UsageError if there is none."""
    try:
        text = read_text(path)
        return extract_program(text) if path.suffix == ".md" else text
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"the program {path} cannot be read: {error}") from error
    except SketchError as error:
        raise UsageError(f"{path}: {error}") from error


def run_task(job: Callable[[], Job], as_json: bool) -> None:
    """Run and print the summary; ends the process with its exit code.

    With `as_json` even a wrong option gives the whole document, with the mistake under `error`.
    """
    try:
        ended = _carried_out(job(), as_json)
    except Proc3sError as error:
        if as_json:
            print_document(json_of(Summary(error=str(error), stopped=error.stopped)))
        raise
    if as_json:
        print_document(json_of(ended.summary))
    raise typer.Exit(ended.exit_code)


def _carried_out(job: Job, quiet: bool) -> Ended:
    """Run, with a console that shows how it goes and how it ended."""
    if job.options.unsafe_exec:
        typer.echo("proc3s: WARNING: with --unsafe-exec the LLM's programs can read your files", err=True)
    session = Session(job)
    say(session.notices)
    console = Console(job.options, session.samples, quiet)
    session.listen(console.update)
    if session.expense:
        console.say(f"{job.options.llm}: {session.expense}")
    with console:
        ended = session.run()
    console.result(ended.summary)
    warn_of_failures(session.registry)
    say(_complaints(ended, job))
    return ended


def _complaints(ended: Ended, job: Job) -> Iterator[str]:
    """What went wrong in a run that came to an end all the same."""
    error = str(ended.outcome.error) if ended.outcome.error else None
    yield from (text for text in ended.unwritten if text != error)
    if error is not None:
        resumable = ended.resumable and job.given is None
        yield error + (f"\n  go on with: proc3s run --resume {ended.summary.run_dir}" if resumable else "")


def replay_run(run: Path, changes: dict[str, Any], out: Path | None, as_json: bool) -> None:
    """Search the last program of a run again, with the random draws of its round."""

    def job() -> Job:
        options = {**options_of(run), "no_miss_picture": False, "pictures": "last", **plain_options(changes)}
        if changes.get("executor") not in (None, options_of(run)["executor"]):
            options["jobs"] = 1  # those of the run were another executor's
        return Job(validate(RunOptions, options, str(run)), out, _program_of(run))

    run_task(job, as_json)


def _program_of(run: Path) -> Given:
    """The program whose plan was executed; else that of the last round which came furthest."""
    programs = {(e["round"], e["candidate"]): e["source"] for e in events_of(run, "program_extracted")}
    if not programs:
        raise UsageError(f"{run} has no program to replay")
    wanted = [(e["round"], e["candidate"]) for e in events_of(run, "plan_executed")]
    wanted += [(e["round"], e["candidate"]) for e in reversed(events_of(run, "round_ended"))]
    round_, candidate = next((place for place in wanted if place in programs), list(programs)[-1])
    answers = {e["round"]: e["completion"] for e in events_of(run, "answer_received")}
    answer: dict[str, Any] = answers.get(round_, {"source": "none"})
    origin: Source = "recorded" if answer["source"] == "live" else answer["source"]
    return Given(programs[round_, candidate], origin, round_, candidate, answer.get("stale", False))


def resume_run(run: Path, task: str | None, given: dict[str, Any], as_json: bool) -> None:
    """Go on with a run that was broken off, from its last completed step."""
    run = itself(run)  # `latest` may lead elsewhere before the run is over

    def job() -> Job:
        logged = validate(RunOptions, options_of(run), str(run))
        if task not in (None, logged.task):
            raise UsageError(f"{run} is a run of {logged.task}, not of {task}")
        if logged.llm is None:
            raise UsageError(f"{run} asked no LLM, so there is nothing to go on with; repeat its command")
        past = past_of(run)
        if past.versions != versions():
            typer.echo("proc3s: other versions are installed than when the run began", err=True)
        return Job(_resumed(logged, plain_options(given)), run, past=past)

    run_task(job, as_json)


def _resumed(logged: RunOptions, changes: dict[str, Any]) -> RunOptions:
    """The options of a run that goes on. Raises UsageError for a change that would make it another run."""
    if fixed := sorted(set(changes) - _MAY_CHANGE):
        raise UsageError(f"a run that goes on keeps its {fixed[0].replace('_', ' ')}; leave that option out")
    if box_limits(changes.get("limits", {})):
        raise UsageError("a run that goes on keeps the limits of its box; only those of the clock may change")
    if "limits" in changes:
        changes["limits"] = {**logged.limits, **changes["limits"]}
    if "budget" in changes:
        changes["budget"] = {**logged.budget.model_dump(), **changes["budget"]}
    if "llm" in changes:
        changes.setdefault("llm_options", {})  # those of the other LLM are not meant for this one
    elif "llm_options" in changes:
        changes["llm_options"] = {**logged.llm_options, **changes["llm_options"]}
    options = validate(RunOptions, {**logged.model_dump(), **changes}, "options")
    return with_llm(options) if "llm" in changes else options
