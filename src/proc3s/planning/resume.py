"""Reads the completed rounds of a run folder, so that another process can continue the run."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from uuid import uuid4

from proc3s.domain.values import Action
from proc3s.errors import UsageError
from proc3s.feedback.report import Diagnosis
from proc3s.llm.budget import Ledger
from proc3s.llm.types import LLM, Completion, Request, WrappedLLM, digest
from proc3s.planning.attempts import Attempt, Round
from proc3s.planning.proposals import Proposal, proposals_of
from proc3s.runs.reading import read_events, started
from proc3s.search.clock import STAGES, Clock


@dataclass(frozen=True)
class LoggedAnswer:
    """An answer of a run, with the request that it answers."""

    round: int
    candidate: int
    sha256: str
    completion: Completion


@dataclass(frozen=True)
class RunHistory:
    """The completed rounds of a run, all answers so far, and the seconds that they took.

    Without arguments: the history of a new run.
    """

    id: str = field(default_factory=lambda: uuid4().hex[:8])
    """Names the run."""
    rounds: tuple[Round, ...] = ()
    answers: tuple[LoggedAnswer, ...] = ()
    ledger: Ledger = field(default_factory=Ledger)
    """The cost of the live calls so far."""
    versions: Mapping[str, str] = field(default_factory=dict)
    wall: dict[str, float] | None = None
    cpu: dict[str, float] | None = None

    def clock(self) -> Clock:
        """A clock that continues from these seconds."""
        return Clock(*STAGES, wall=self.wall, cpu=self.cpu)


def past_of(run: Path) -> RunHistory:
    """The history of an interrupted run. Raises UsageError if the run has ended, or the folder has none."""
    events = read_events(run)
    ended = [event for event in events if event["event"] == "run_ended"]
    if ended and ended[-1]["summary"]["error"] is None:
        raise UsageError(f"{run} came to its end (summary.json); there is nothing to go on with")
    answers = answers_of(events)
    done = [event for event in events if event["event"] == "round_ended"]
    charged = [event["ledger"] for event in events if event["event"] == "charged"]
    return RunHistory(
        id=started(run).get("id") or RunHistory().id,
        ledger=Ledger.model_validate(charged[-1]) if charged else Ledger(),
        versions=started(run)["versions"],
        rounds=tuple(_round(events, answers, number) for number in range(len(done))),
        answers=answers,
        wall=done[-1]["seconds"] if done else None,
        cpu=done[-1]["cpu_seconds"] if done else None,
    )


def answers_of(events: Sequence[dict[str, Any]]) -> tuple[LoggedAnswer, ...]:
    """Every answer of a log, once, with its prompt."""
    prompts: dict[int, str] = {}
    found: dict[LoggedAnswer, None] = {}
    for event in events:
        if event["event"] == "prompt_rendered":
            prompts[event["round"]] = event["sha256"]
        elif event["event"] == "answer_received":
            completion = Completion.model_validate(event["completion"])
            key = (event["round"], event["candidate"], prompts.get(event["round"], ""))
            found[LoggedAnswer(*key, completion)] = None
    return tuple(found)


def _round(events: Sequence[dict[str, Any]], answers: Sequence[LoggedAnswer], number: int) -> Round:
    attempts = {e["candidate"]: e for e in events if e["event"] == "attempt_ended" and e["round"] == number}
    given = [proposals_of(a.completion, number, a.candidate) for a in answers if a.round == number]
    proposals = {proposal.candidate: proposal for proposal in itertools.chain(*given)}
    kept = sorted(attempts.keys() & proposals.keys())
    return Round(
        proposals=tuple(proposals[candidate] for candidate in kept),
        attempts=tuple(_attempt(attempts[candidate], proposals[candidate]) for candidate in kept),
    )


def _attempt(event: dict[str, Any], proposal: Proposal) -> Attempt:
    fallback = event["fallback"]
    return Attempt(
        diagnosis=Diagnosis.model_validate(event["diagnosis"]),
        round=proposal.round,
        candidate=proposal.candidate,
        fallback=tuple(Action.from_json(action) for action in fallback) if fallback else None,
        nearest=event["nearest"],
        samples=event["samples"],
        evaluations=event["evaluations"],
        rehearsals=event.get("rehearsals", 0),
        rejected_by=event["rejected_by"],
    )


class ResumedLLM(WrappedLLM):
    """Answers prompts that the interrupted run had answers to from its log, and asks for all others."""

    def __init__(self, llm: LLM, answers: Sequence[LoggedAnswer]) -> None:
        super().__init__(llm)
        self._known = {(a.round, a.candidate, a.sha256): a.completion for a in answers}

    def complete(self, request: Request) -> Completion:
        """The logged answer to this prompt, else a new one."""
        key = (request.round, request.candidate, digest(request.messages))
        return self._known.get(key) or self._llm.complete(request)
