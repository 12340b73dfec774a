"""The history of a run: its log read into rounds and programs, as far as they are there.

A run may have been broken off anywhere, resumed, or written by an earlier version: every part may be missing.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal, TypeAlias

from pydantic import BaseModel, ConfigDict, ValidationError

from proc3s.errors import UsageError
from proc3s.feedback.report import Diagnosis
from proc3s.llm.types import Completion, Message
from proc3s.reporting.changes import Change, line_changes, rebound, unified
from proc3s.reporting.trials import Samples, StepReport, by_step
from proc3s.runs.events import SamplerCall
from proc3s.runs.reading import LOG, label, read_events

Log: TypeAlias = Sequence[dict[str, Any]]
Ending: TypeAlias = Literal["solved", "executed", "failed", "unusable", "unfinished"]


class ProgramRecord(BaseModel):
    """One program of a round and its result."""

    model_config = ConfigDict(frozen=True)

    round: int
    candidate: int
    ending: Ending
    """`executed`: carried out without being accepted; `unusable`: before a sample was drawn."""
    best: bool = True
    """The one of its round that got furthest; the next question shows it."""
    answer: str | None = None
    source: str | None = None
    blocks: str = ""
    """Which blocks of the answer it was taken from, where there was a choice."""
    parameters: dict[str, str] = {}
    """Open parameters and how each is sampled."""
    dims: dict[str, int] = {}
    """Columns of u that each takes; empty where that is not known."""
    samplers: dict[str, SamplerCall] = {}
    """The sampler of each, as far as the log says."""
    printed: str = ""
    samples: Samples = Samples()
    taken: int = 0
    """Samples, as the run counts them."""
    evaluations: int | None = None
    rejected_by: dict[str, int] = {}
    diagnosis: Diagnosis | None = None
    nearest: dict[str, Any] | None = None
    """The plan that came furthest, of a program that failed."""
    audited: tuple[int, int] | None = None
    """Rejects of screens that were put to the world, and how many of them it accepts."""
    change: Change | None = None

    @property
    def file(self) -> str:
        """Its name in the run folder."""
        return f"program-{label(self.round, self.candidate)}.py"

    @property
    def steps(self) -> tuple[StepReport, ...]:
        """First violations by step."""
        return by_step(self.samples, self.diagnosis)


class RoundRecord(BaseModel):
    """A question, its answers and their programs."""

    model_config = ConfigDict(frozen=True)

    number: int
    messages: tuple[Message, ...] = ()
    completions: tuple[Completion, ...] = ()
    notes: tuple[str, ...] = ()
    """What was warned of, and calls that failed."""
    programs: tuple[ProgramRecord, ...] = ()


class Story(BaseModel):
    """A run folder, read."""

    model_config = ConfigDict(frozen=True)

    run: Path
    began: str | None = None
    options: dict[str, Any] = {}
    versions: dict[str, str] = {}
    goal: str | None = None
    """The instruction; None where an earlier version's log does not say it."""
    budget: int | None = None
    """Samples that a round may take."""
    rounds: tuple[RoundRecord, ...] = ()
    executed: dict[str, Any] | None = None
    """The event of the execution: plan, violations, the judge's verdict."""
    summary: dict[str, Any] | None = None
    """None for a run that was broken off, or is still at work."""

    @property
    def programs(self) -> tuple[ProgramRecord, ...]:
        """Those of all rounds, in order."""
        return tuple(program for round_ in self.rounds for program in round_.programs)

    @property
    def task(self) -> str:
        """`domain/task`."""
        return str(self.options.get("task") or "a task that the log does not name")

    @property
    def solved(self) -> bool:
        """A world accepted a plan."""
        return self.executed is not None and self.executed["executed"] == "solution"

    @property
    def error(self) -> str | None:
        """Why the run did not come to its end, if it says so."""
        return self.summary.get("error") if self.summary else None


def read_story(run: Path) -> Story:
    """The story that a run folder tells. Raises UsageError if it is none, or another version's log."""
    try:
        return _story(run, read_events(run))
    except (KeyError, TypeError, AttributeError, ValueError, ValidationError) as error:
        reason = error.errors()[0]["msg"] if isinstance(error, ValidationError) else repr(error)
        raise UsageError(f"{run / LOG} was not written by this version of proc3s ({reason})") from error


def _story(run: Path, log: Log) -> Story:
    begun = _last(log, "run_started") or {}
    resumed = _last(log, "run_resumed") or {}
    ended = _last(log, "run_ended")
    if resumed and ended and log.index(resumed) > log.index(ended):
        ended = None
    executed = _last(log, "plan_executed")
    numbers = sorted({event["round"] for event in log if "round" in event})
    rounds: list[RoundRecord] = []
    for number in numbers:
        rounds.append(_round(number, _latest(log, number), executed, rounds[-1] if rounds else None))
    options = resumed.get("options") or begun.get("options") or {}
    return Story(
        run=run,
        began=begun.get("time"),
        options=options,
        goal=begun.get("goal") or options.get("goal"),
        versions=begun.get("versions", {}),
        budget=begun.get("samples"),
        rounds=tuple(rounds),
        executed=executed,
        summary=ended["summary"] if ended else None,
    )


def _last(log: Log, kind: str) -> dict[str, Any] | None:
    return next((event for event in reversed(log) if event["event"] == kind), None)


def _latest(log: Log, number: int) -> Log:
    """The events of a round; of one that was begun again by another process, those of the last time."""
    own = [event for event in log if event.get("round") == number]
    asked = [i for i, event in enumerate(own) if event["event"] == "prompt_rendered"]
    return own[asked[-1] :] if asked else own


def _round(number: int, log: Log, executed: dict[str, Any] | None, before: RoundRecord | None) -> RoundRecord:
    prompt = _last(log, "prompt_rendered") or {}
    received = [event for event in log if event["event"] == "answer_received"]
    completions = {event["candidate"]: Completion.model_validate(event["completion"]) for event in received}
    answers = {
        first + i: candidate.text
        for first, completion in completions.items()
        for i, candidate in enumerate(completion.candidates)
    }
    candidates = {event["candidate"] for event in log if "candidate" in event} | set(answers)
    best = (_last(log, "round_ended") or {}).get("candidate")
    if best is None and executed and executed["round"] == number:
        best = executed["candidate"]
    old = next((p for p in before.programs if p.best), None) if before else None
    programs = [
        _program([e for e in log if e.get("candidate") == c], (number, c), executed, answers.get(c))
        for c in sorted(candidates)
    ]
    return RoundRecord(
        number=number,
        messages=prompt.get("messages", ()),
        completions=tuple(completions.values()),
        notes=tuple(note for event in log for note in _notes(event)),
        programs=tuple(_compared(program, best, old) for program in programs),
    )


def _notes(event: dict[str, Any]) -> list[str]:
    """What an event tells a person beside the course of the run."""
    match event["event"]:
        case "warned":
            return [event["text"]]
        case "call_failed":
            return [event["message"]]
        case "answer_received":
            return list(event["completion"].get("notes", ()))
    return []


def _program(
    log: Log, place: tuple[int, int], executed: dict[str, Any] | None, answer: str | None
) -> ProgramRecord:
    extracted = _last(log, "program_extracted") or {}
    loaded = _last(log, "sketch_loaded") or {}
    ended = _last(log, "attempt_ended") or {}
    audited = _last(log, "audited")
    samples = Samples.of([event for event in log if event["event"] == "batch_evaluated"])
    diagnosis = Diagnosis.model_validate(ended["diagnosis"]) if ended else None
    ours = executed if executed and (executed["round"], executed["candidate"]) == place else None
    return ProgramRecord(
        round=place[0],
        candidate=place[1],
        ending=_ending(ours, samples, diagnosis),
        answer=answer,
        source=extracted.get("source"),
        blocks=extracted.get("blocks", ""),
        parameters=loaded.get("parameters", {}),
        dims=loaded.get("dims", {}),
        samplers=loaded.get("samplers", {}),
        printed=loaded.get("log", ""),
        samples=samples,
        taken=ended.get("samples", len(samples.u)),
        evaluations=ended.get("evaluations"),
        rejected_by=ended.get("rejected_by", {}),
        diagnosis=diagnosis,
        nearest=ended.get("nearest"),
        audited=(audited["checked"], len(audited["wrong"])) if audited else None,
    )


def _ending(executed: dict[str, Any] | None, samples: Samples, diagnosis: Diagnosis | None) -> Ending:
    if executed:
        return "solved" if executed["executed"] == "solution" else "executed"
    if any(samples.accepted):
        return "solved"
    if diagnosis is None:
        return "unfinished"
    return "unusable" if diagnosis.program_errors and not diagnosis.samples else "failed"


def _compared(program: ProgramRecord, best: int | None, old: ProgramRecord | None) -> ProgramRecord:
    """The program with its rank in the round, and what it changes of the one that the question showed."""
    program = program.model_copy(update={"best": best is None or program.candidate == best})
    if old is None or old.source is None or program.source is None:
        return program
    added, removed, parts = line_changes(old.source, program.source)
    change = Change(
        since_round=old.round,
        since_candidate=old.candidate,
        lines_added=added,
        lines_removed=removed,
        parts=parts,
        new_parameters={n: t for n, t in program.parameters.items() if n not in old.parameters},
        gone_parameters=_gone(old, program),
        rebound=rebound(old.parameters, program.parameters),
        diff=unified(old.source, program.source, old.file, program.file),
    )
    return program.model_copy(update={"change": change})


def _gone(old: ProgramRecord, new: ProgramRecord) -> tuple[str, ...]:
    """Parameters of the older program alone; none while those of the newer one are not known."""
    return tuple(name for name in old.parameters if new.parameters and name not in new.parameters)
