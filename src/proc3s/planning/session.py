"""One run: its parts, its folder, and who hears of its events."""

import functools
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from proc3s.domain.world_options import world_used
from proc3s.errors import UsageError
from proc3s.llm.budget import Ledger, Spent, spent_on
from proc3s.llm.errors import LLMError
from proc3s.llm.types import Request, Source
from proc3s.planning.expense import bound_of, in_words
from proc3s.planning.llm_backend import find_llm, open_llm, price_of
from proc3s.planning.options import RunOptions
from proc3s.planning.own_templates import unused_templates
from proc3s.planning.parts import Pictures
from proc3s.planning.planner import Outcome, plan
from proc3s.planning.proposals import Propose, Question, ask_llm, given_program
from proc3s.planning.readiness import check_parts
from proc3s.planning.resume import RunHistory
from proc3s.planning.setup import make_prompter, make_setup
from proc3s.planning.summary import Summary, summarize
from proc3s.planning.unused_options import unused, unused_budget
from proc3s.planning.ways_on import no_bundled_answer
from proc3s.plugins.registry import Registry, open_registry
from proc3s.plugins.versions import versions
from proc3s.runs.events import (
    AnswerReceived,
    CallFailed,
    Charged,
    Emit,
    Event,
    PromptRendered,
    RunEnded,
    RunResumed,
    RunStarted,
    Unwritten,
)
from proc3s.runs.folder import RunFolder, new_folder
from proc3s.runs.newest import RUNS, link_latest


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
    past: RunHistory | None = None


@dataclass(frozen=True)
class Ended:
    """A run that came to an end, one way or another; `unwritten` says what its folder lacks."""

    summary: Summary
    outcome: Outcome
    unwritten: tuple[str, ...]

    @property
    def exit_code(self) -> int:
        """0 solved, 1 unsolved, 2 if something could not be written, or that of the error that ended it."""
        if self.unwritten:
            return UsageError.exit_code
        if self.summary.solved:
            return 0
        return self.outcome.error.exit_code if self.outcome.error else 1

    @property
    def resumable(self) -> bool:
        """Whether another process may go on with the run and come further."""
        error = self.outcome.error
        gone = isinstance(error, LLMError) and error.fault == "no_answer"
        return error is not None and error.exit_code != UsageError.exit_code and not gone


class Session:
    """One run: its parts, its folder, and who hears of its events: plugins, then `listeners`.

    All parts are made at once: raises Proc3sError for whatever is certain before the run begins.
    """

    def __init__(self, job: Job, listeners: Sequence[Emit] = (), registry: Registry | None = None) -> None:
        self._job = job
        self._listeners = list(listeners)
        self._options = job.options
        if job.given is not None:
            self._options = job.options.model_copy(update={"feedback": 0})
        self.registry = registry or open_registry(self._options.plugins)
        self._setup = make_setup(self.registry, self._options, goal_needed=job.given is None)
        check_parts(self._setup.problem)
        self.notices = [*unused(self._options, self._setup)]
        """What whoever asked for the run should know before it begins."""
        self._past = job.past or RunHistory()
        self._ledger = self._past.ledger
        self._recorded = {(a.round, a.candidate): a.completion for a in self._past.answers}
        self._emitting = threading.Lock()
        self._unwritten: list[str] = []
        self.expense: str | None = None
        """The most that the run may ask and cost, in words; None where nothing is paid."""
        self._ask = self._asker() if job.given is None else None

    @property
    def samples(self) -> int:
        """How many samples a round may take."""
        return self._setup.problem.samples

    def listen(self, listener: Emit) -> None:
        """Tell a listener of all events from now on."""
        self._listeners.append(listener)

    def run(self) -> Ended:
        """Carry the run out to its end."""
        options, job = self._options, self._job
        path = job.out or new_folder(RUNS, options.task, options.method, options.seed)
        miss = options.pictures != "none" and not options.no_miss_picture
        setup = replace(self._setup, pictures=Pictures(path, options.pictures, miss))
        self._folder = RunFolder(path, resume=job.past is not None)
        link_latest(path)
        try:
            self._emit(self._begun())
            outcome = plan(setup, self._propose(), self._emit, self._past.rounds, self._past.clock())
            summary = self._complete(summarize(options, setup, outcome, path, self._spent()))
            self._emit(RunEnded(summary=summary.model_dump(mode="json")))
            summary = self._complete(summary)
        finally:
            self._folder.close()
            setup.executor.close()
        return Ended(summary, outcome, tuple(self._unwritten))

    def _complete(self, summary: Summary) -> Summary:
        """The summary with what could not be written, if nothing worse is to be told."""
        if not self._unwritten or summary.error is not None:
            return summary
        return summary.model_copy(update={"error": "; ".join(self._unwritten), "stopped": UsageError.stopped})

    def _begun(self) -> Event:
        world = world_used(self._setup.problem.domain)
        # With the defaults that held, so that whoever carries the plan out again elsewhere has them, too.
        pinned = {"world_options": {**self._options.world_options, **world}}
        options = self._options.model_copy(update=pinned).model_dump(mode="json")
        if self._job.past is not None:
            return RunResumed(options=options, versions=versions())
        return RunStarted(
            id=self._past.id,
            options=options,
            versions=versions(),
            samples=self._setup.problem.samples,
            scene=self._setup.problem.scene,
            goal=self._setup.problem.goal,
            world=world,
        )

    def _asker(self) -> Callable[[], Propose]:
        """Who is asked; made before the run begins, so that a missing key or a stale template stops it."""
        options, problem = self._options, self._setup.problem
        chosen = find_llm(self.registry, options.llm or "", options.llm_options)
        prompter = make_prompter(self.registry, options, problem)
        sampling = chosen.call.sampling(options.seed, options.candidates)
        prompter.rehearse(problem)
        self.notices += unused_templates(self.registry, options.template_dir)
        question = Question(problem, prompter, sampling, options.llm_jobs or options.candidates)
        llm = open_llm(chosen, options.budget, self._past, options.record, self._charged, self._call_failed)
        if llm.bundled_only and problem.goal != problem.task.instruction:
            raise no_bundled_answer(self.registry, options)
        llm.prepare()
        if not llm.live:
            self.notices += unused_budget(options.budget, chosen.name)
        elif not self._past.rounds:
            self.expense = in_words(bound_of(question, price_of(chosen)), options.budget)
        return lambda: ask_llm(llm, question, self._emit)

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
                for listener in self._listeners:
                    listener(one)
                self.registry.plugins.on_event(one)
