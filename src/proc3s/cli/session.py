"""One run from the command line: options to parts, parts to a run folder, a console and a summary."""

import functools
import threading
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import typer

from proc3s.backends import find_llm, patient, price_of
from proc3s.budget import Ledger, Spent, spent_on
from proc3s.cli.console import Console
from proc3s.cli.failures import warn_of_failures
from proc3s.cli.streams import json_of, print_document
from proc3s.config import choose_llm
from proc3s.conversation import Propose, Question, ask_llm, given_program
from proc3s.errors import LLMError, Proc3sError, UsageError
from proc3s.events import (
    AnswerReceived,
    CallFailed,
    Charged,
    Event,
    PromptRendered,
    RunEnded,
    RunResumed,
    RunStarted,
    Unwritten,
)
from proc3s.expense import bound_of, in_words
from proc3s.limits import box_limits
from proc3s.llms import Request, Source
from proc3s.options import (
    RunOptions,
    key_values,
    make_problem,
    make_prompter,
    make_setup,
)
from proc3s.past import Past, Remembering, past_of
from proc3s.planner import Outcome, plan
from proc3s.readiness import check_parts
from proc3s.recordings import Recorder
from proc3s.registry import open_registry
from proc3s.runs import RunFolder, events_of, new_folder, options_of, versions
from proc3s.specfile import validate
from proc3s.summary import Summary, summarize
from proc3s.textfiles import read_text
from proc3s.unused import unused, unused_budget

_OPTION_LISTS = ("domain_options", "method_options", "solver_options", "llm_options", "limits")
_MAY_CHANGE = {"llm", "llm_options", "llm_jobs", "jobs", "executor", "record", "budget", "limits"}
"""What another process may do otherwise, and still go on with the same run."""
_LIMITS = ("max_cost", "max_tokens", "max_calls")


def run_options(**given: Any) -> RunOptions:
    """Options of a run from the arguments of a command; None leaves the default."""
    return validate(RunOptions, _plain(given), "options")


def _plain(given: dict[str, Any]) -> dict[str, Any]:
    """Arguments of a command as fields of RunOptions, those that were given alone."""
    values = {name: value for name, value in given.items() if value is not None}
    for name in _OPTION_LISTS:
        if name in values:
            values[name] = key_values(values[name])
    if budget := {name: values.pop(name) for name in _LIMITS if name in values}:
        values["budget"] = budget
    if "plugins" in values:
        values["plugins"] = [path.resolve() for path in values["plugins"]]
    for name in ("template_dir", "record"):
        if name in values:
            values[name] = values[name].resolve()
    if values.get("jobs", 1) > 1:
        values.setdefault("executor", "processes")
    return values


def with_llm(options: RunOptions) -> RunOptions:
    """The options with the LLM that is asked, whoever chose it; says so if it was not the command line."""
    chosen = choose_llm(options.llm, options.llm_options)
    if chosen.by not in ("--llm", "default"):
        typer.echo(f"proc3s: asking {chosen.name}, as {chosen.by} says", err=True)
    return options.model_copy(update={"llm": chosen.name, "llm_options": dict(chosen.options)})


def read_program(path: Path) -> str:
    """The text of a program. Raises UsageError if it cannot be read."""
    try:
        return read_text(path)
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"the program {path} cannot be read: {error}") from error


@dataclass(frozen=True)
class Given:
    """A program that is there already, where it is from, and whose random draws it takes."""

    program: str
    origin: Source = "none"
    round: int = 0
    candidate: int = 0
    stale: bool = False


@dataclass(frozen=True)
class Job:
    """A run that was asked for; one that goes on has a past."""

    options: RunOptions
    out: Path | None = None
    given: Given | None = None
    past: Past | None = None


def run_task(job: Callable[[], Job], as_json: bool) -> None:
    """Run and print the summary; ends the process with its exit code.

    With `as_json` even a wrong option gives the whole document, with the mistake under `error`.
    """
    try:
        summary, code = Session(job(), as_json).run()
    except Proc3sError as error:
        if as_json:
            print_document(json_of(Summary(error=str(error), stopped=error.stopped)))
        raise
    if as_json:
        print_document(json_of(summary))
    raise typer.Exit(code)


def replay_run(run: Path, changes: dict[str, Any], out: Path | None, as_json: bool) -> None:
    """Search the last program of a run again, with the random draws of its round."""

    def job() -> Job:
        options = {**options_of(run), **_plain(changes)}
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

    def job() -> Job:
        logged = validate(RunOptions, options_of(run), str(run))
        if task not in (None, logged.task):
            raise UsageError(f"{run} is a run of {logged.task}, not of {task}")
        if logged.llm is None:
            raise UsageError(f"{run} asked no LLM, so there is nothing to go on with; repeat its command")
        past = past_of(run)
        if past.versions != versions():
            typer.echo("proc3s: other versions are installed than when the run began", err=True)
        return Job(_resumed(logged, _plain(given)), run, past=past)

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


class Session:
    """One run: its parts, its folder, its console, and who hears of its events."""

    def __init__(self, job: Job, quiet: bool) -> None:
        self._job = job
        self._options = job.options
        if job.given is not None:
            self._options = job.options.model_copy(update={"feedback": 0})
        if self._options.unsafe_exec:
            typer.echo("proc3s: WARNING: with --unsafe-exec the LLM's programs can read your files", err=True)
        self._registry = open_registry(self._options.plugins)
        self._problem = make_problem(self._registry, self._options, goal_needed=job.given is None)
        self._setup = make_setup(self._registry, self._options, self._problem)
        check_parts(self._setup.problem)
        _tell(unused(self._options, self._setup))
        self._past = job.past or Past()
        self._ledger = self._past.ledger
        self._recorded = {(a.round, a.candidate): a.completion for a in self._past.answers}
        self._emitting = threading.Lock()
        self._unwritten: list[str] = []
        self._most: str | None = None
        self._ask = self._asker() if job.given is None else None
        self._console = Console(self._options, self._problem.samples, quiet)

    def run(self) -> tuple[Summary, int]:
        """Run to the end, and the exit code."""
        options, job = self._options, self._job
        path = job.out or new_folder(Path("runs"), options.task, options.method, options.seed)
        setup = replace(self._setup, picture=path / "plan.png")
        self._folder = RunFolder(path, resume=job.past is not None)
        try:
            self._emit(self._begun())
            if self._most:
                self._console.say(f"{options.llm}: {self._most}")
            with self._console:
                outcome = plan(setup, self._propose(), self._emit, self._past.rounds, self._past.clock())
            summary = self._complete(summarize(options, setup, outcome, path, self._spent()))
            self._emit(RunEnded(summary=summary.model_dump(mode="json")))
            summary = self._complete(summary)
        finally:
            self._folder.close()
            setup.executor.close()
        self._console.result(summary)
        warn_of_failures(self._registry)
        for text in self._unwritten:
            if text != str(outcome.error):
                typer.echo(f"proc3s: {text}", err=True)
        code = _exit_code(outcome, summary, resumable=job.given is None)
        return summary, UsageError.exit_code if self._unwritten else code

    def _complete(self, summary: Summary) -> Summary:
        """The summary with what could not be written, if nothing worse is to be told."""
        if not self._unwritten or summary.error is not None:
            return summary
        return summary.model_copy(update={"error": "; ".join(self._unwritten), "stopped": UsageError.stopped})

    def _begun(self) -> Event:
        if self._job.past is not None:
            options = self._options.model_dump(mode="json")
            return RunResumed(options=options, versions=versions())
        return RunStarted(
            id=self._past.id,
            options=self._options.model_dump(mode="json"),
            versions=versions(),
            samples=self._problem.samples,
            scene=self._problem.scene,
            goal=self._problem.goal,
        )

    def _asker(self) -> Callable[[], Propose]:
        """Who is asked; made before the run begins, so that a missing key or a stale template stops it."""
        options = self._options
        chosen = find_llm(self._registry, options.llm or "", options.llm_options)
        question = Question(
            self._problem,
            make_prompter(self._registry, options, self._problem),
            chosen.call.sampling(options.seed, options.candidates),
            options.llm_jobs or options.candidates,
        )
        question.prompter.rehearse(self._problem)
        llm = patient(chosen, options.budget, self._past.ledger, self._charged, self._call_failed)
        llm.prepare()
        if not llm.live:
            _tell(unused_budget(options.budget, chosen.name))
        elif not self._past.rounds:
            self._most = in_words(bound_of(question, price_of(chosen)), options.budget)
        if options.record is not None:
            llm = Recorder(llm, options.record, self._past.id)
        return lambda: ask_llm(Remembering(llm, self._past.answers), question, self._emit)

    def _propose(self) -> Propose:
        given = self._job.given
        if self._ask is not None:
            return self._ask()
        assert given is not None
        return given_program(given.program, given.origin, given.round, given.candidate, given.stale)

    def _call_failed(self, request: Request, error: LLMError, wait: float) -> None:
        self._emit(CallFailed(round=request.round, fault=error.fault, message=str(error), wait=wait))

    def _charged(self, ledger: Ledger) -> None:
        self._ledger = ledger
        self._emit(Charged(ledger=ledger))

    def _spent(self) -> Spent:
        """What live answers cost now, and recorded ones when they were recorded."""
        recorded = [c for c in self._recorded.values() if c.source == "recorded"]
        then = (spent_on(completion, completion.attempts) for completion in recorded)
        return functools.reduce(Spent.plus, then, self._ledger.spent)

    def _emit(self, event: Event) -> None:
        if isinstance(event, AnswerReceived):
            self._recorded[event.round, event.candidate] = event.completion
        with self._emitting:  # calls in flight have news of their own
            lost = self._folder.emit(event)
            heard = (event, lost) if lost else (event,)
            self._unwritten += [one.text for one in heard if isinstance(one, Unwritten)]
            if self._unwritten and isinstance(event, RunStarted | RunResumed | PromptRendered):
                raise UsageError(self._unwritten[0])  # what is asked and not kept is paid for in vain
            for one in heard:
                self._console.update(one)
                self._registry.plugins.on_event(one)


def _tell(sentences: Iterable[str]) -> None:
    for sentence in sentences:
        typer.echo(f"proc3s: {sentence}", err=True)


def _exit_code(outcome: Outcome, summary: Summary, resumable: bool) -> int:
    """0 solved, 1 unsolved, or the code of the error that ended the run."""
    if outcome.error is None:
        return 0 if summary.solved else 1
    text = str(outcome.error)
    gone = isinstance(outcome.error, LLMError) and outcome.error.fault == "no_answer"
    if resumable and outcome.error.exit_code != 2 and not gone:
        text += f"\n  go on with: proc3s run --resume {summary.run_dir}"
    typer.echo(f"proc3s: {text}", err=True)
    return 0 if summary.solved else outcome.error.exit_code
