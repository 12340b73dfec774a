"""Typed events of a run: what logs, consoles and reports hang on."""

import math
from collections.abc import Callable, Sequence
from typing import Any, Literal, TypeAlias

from pydantic import BaseModel, ConfigDict

from proc3s.feedback.report import Diagnosis
from proc3s.llm.budget import Ledger
from proc3s.llm.types import Completion, Message
from proc3s.search.screen_audit import Findings
from proc3s.search.trial import Trial


class Event(BaseModel):
    """Base of all events; `event` names it in the log."""

    model_config = ConfigDict(frozen=True, use_attribute_docstrings=True)

    event: str


class OfProgram(Event):
    """An event of one of the programs that were proposed in a round."""

    round: int
    """Counted from 0; round 0 is the first question."""
    candidate: int = 0
    """Which of the answers of its round, from 0."""


class RunStarted(Event):
    """A run begins; `options` are enough to repeat it."""

    event: Literal["run_started"] = "run_started"
    id: str = ""
    """Names the run among all others; it keeps it when it is resumed."""
    options: dict[str, Any]
    """Options of the run, as on the command line."""
    versions: dict[str, str]
    """Versions of Python, the platform, proc3s and what it needs."""
    samples: int
    """Samples that a round may take."""
    scene: str
    """The initial state as JSON."""
    goal: str = ""
    """The instruction in plain language."""
    world: dict[str, str] = {}
    """What the worlds really use of what `-W` may choose."""


class RunResumed(Event):
    """A run goes on in another process, with these options and versions."""

    event: Literal["run_resumed"] = "run_resumed"
    options: dict[str, Any]
    """Options of the run, as on the command line."""
    versions: dict[str, str]
    """Versions of Python, the platform, proc3s and what it needs."""


class PromptRendered(Event):
    """The messages of a round, before the LLM is asked."""

    event: Literal["prompt_rendered"] = "prompt_rendered"
    round: int
    """Counted from 0; round 0 is the first question."""
    sha256: str
    """Of roles and texts of the messages; a recorded answer is found by it."""
    messages: tuple[Message, ...]
    """The messages in order."""


class CallFailed(Event):
    """A call to the LLM that failed in passing; it is repeated after `wait` seconds."""

    event: Literal["call_failed"] = "call_failed"
    round: int
    """Counted from 0; round 0 is the first question."""
    fault: str
    """The kind of failure."""
    message: str
    """What the provider said."""
    wait: float
    """Seconds until the next call."""


class Charged(Event):
    """A live call was made: what all of them cost up to here, be their answers used or not."""

    event: Literal["charged"] = "charged"
    ledger: Ledger
    """Calls, tokens and US dollars of all calls up to here."""


class Warned(Event):
    """Something that a person should know while the run goes on."""

    event: Literal["warned"] = "warned"
    round: int
    """Counted from 0; round 0 is the first question."""
    text: str
    """What to know."""


class AnswerReceived(OfProgram):
    """An answer; `candidate` is the number of its first candidate, the others follow it."""

    event: Literal["answer_received"] = "answer_received"
    completion: Completion
    """The answer, where it is from, and what it cost."""


class ProgramExtracted(OfProgram):
    """The program found in an answer."""

    event: Literal["program_extracted"] = "program_extracted"
    source: str
    """Its text; `program-N.py` holds the same."""
    blocks: str = ""
    """Which blocks of code it was taken from, where the answer holds others too."""


class SamplerCall(BaseModel):
    """A sampler by its name, and what it was made with."""

    sampler: str
    args: dict[str, Any]


class SketchLoaded(OfProgram):
    """The program passed its contract check; these are its open parameters."""

    event: Literal["sketch_loaded"] = "sketch_loaded"
    parameters: dict[str, str]
    """How each open parameter is sampled, as a program writes it."""
    dims: dict[str, int] = {}
    """How many columns of `u` each of them takes, in the same order."""
    samplers: dict[str, SamplerCall] = {}
    """The sampler of each of them: its name and its arguments."""
    log: str = ""
    """What the program printed while it was loaded."""


class BatchEvaluated(OfProgram):
    """Trials of one batch as columns; equal positions belong to one sample."""

    event: Literal["batch_evaluated"] = "batch_evaluated"
    first: int
    """Number of the first sample among those of the program, from 0."""
    u: list[list[float]]
    """Samples in the unit cube, one row each."""
    accepted: list[bool]
    """Whether the world accepted the plan."""
    reached: list[int]
    """Steps before the first violation."""
    violation: list[str | None]
    """The constraint that was violated first, or the kind of an error."""
    step: list[int | None]
    """The step of that violation, from 0."""
    text: list[str | None]
    """The violation or error in words."""
    margin: list[float | None]
    """Its margin in the constraint's unit, negative; null where it is not known."""

    @classmethod
    def from_trials(cls, round_: int, candidate: int, trials: Sequence[Trial]) -> "BatchEvaluated":
        """The columns of a batch that is not empty."""
        firsts = [trial.violations[0] if trial.violations else None for trial in trials]
        return cls(
            round=round_,
            candidate=candidate,
            first=trials[0].index,
            u=[list(trial.u) for trial in trials],
            accepted=[trial.accepted for trial in trials],
            reached=[trial.reached for trial in trials],
            violation=[_kind(t, v.constraint if v else None) for t, v in zip(trials, firsts, strict=True)],
            step=[v.step if v else None for v in firsts],
            text=[
                str(t.error) if t.error else v.text if v else None
                for t, v in zip(trials, firsts, strict=True)
            ],
            margin=[v.margin if v and math.isfinite(v.margin) else None for v in firsts],
        )


def _kind(trial: Trial, constraint: str | None) -> str | None:
    return type(trial.error).__name__ if trial.error else constraint


class Audited(OfProgram):
    """Rejects of screens that were put to the world: how many, and those it accepts."""

    event: Literal["audited"] = "audited"
    checked: int
    """Rejects that were put to the world."""
    wrong: list[dict[str, Any]]
    """Those that the world accepts: the plan, and what it was rejected for."""

    @classmethod
    def of(cls, round_: int, candidate: int, findings: Findings) -> "Audited":
        """The findings on the samples of one program."""
        wrong = [
            {"plan": [action.to_json() for action in plan], "rejected_for": violation.text}
            for plan, violation in findings.wrong
        ]
        return cls(round=round_, candidate=candidate, checked=findings.checked, wrong=wrong)


class PlanImproved(OfProgram):
    """Samples around an accepted plan were tried for one with more room; null where nothing limits it."""

    event: Literal["plan_improved"] = "plan_improved"
    samples: int
    """How many were tried, apart from those of the search."""
    room_before: float | None
    """Of the plan that was accepted first, in errors that are to be expected."""
    room_after: float | None
    """Of the plan that is carried out."""
    held: bool | None = None
    """Whether it passed its rehearsals; null where there are none."""
    broken_off: str | None = None
    """What ended this before its time."""


class AttemptEnded(OfProgram):
    """What one program came to; enough to go on with the run in another process."""

    event: Literal["attempt_ended"] = "attempt_ended"
    diagnosis: Diagnosis
    """Why nothing was accepted."""
    samples: int
    """Parameter vectors with a verdict."""
    evaluations: int
    """Those of them that the world had to look at."""
    rehearsals: int = 0
    """Of accepted plans, under disturbances."""
    rejected_by: dict[str, int]
    """Samples that each screen rejected."""
    fallback: list[dict[str, Any]] | None
    """The plan that is executed if no other comes."""
    nearest: dict[str, Any] | None
    """The plan that came furthest, and what it violates."""


class RoundEnded(OfProgram):
    """A round without an accepted plan, and why its best program failed; that goes into the next question."""

    event: Literal["round_ended"] = "round_ended"
    diagnosis: Diagnosis
    """Why nothing was accepted."""
    seconds: dict[str, float]
    """Wall seconds by stage up to here."""
    cpu_seconds: dict[str, float]
    """CPU seconds by stage, those of child processes included."""


class PlanExecuted(OfProgram):
    """The plan that was carried out, what it violated, and the judge's verdict."""

    event: Literal["plan_executed"] = "plan_executed"
    executed: Literal["solution", "fallback"]
    """Whether the world had accepted it."""
    plan: list[dict[str, Any]]
    """Skill and arguments of every step."""
    violations: list[dict[str, Any]]
    """What it violates, if it was not accepted."""
    goal_reached: bool | None
    """The judge's verdict; null without a judge."""
    goal_reason: str
    """The judge's reason."""
    goal_expected: bool | None = None
    """The judge's verdict on the state that the world which accepted the plan ends in."""
    room: dict[str, Any] | None = None
    """What is tightest in a plan without a violation: `value` in errors that are to be expected, `margin`,
    `constraint`, `step` (null for the goal) and `says`; null where nothing limits it."""


class Unwritten(Event):
    """Something could not be written, e.g. since the disk is full; the run goes on without it."""

    event: Literal["unwritten"] = "unwritten"
    text: str
    """What, where and why."""


class Undrawn(Event):
    """A picture that the world could not draw; the run is as good without it."""

    event: Literal["undrawn"] = "undrawn"
    text: str
    """Which picture, and why."""


class RunEnded(Event):
    """The end of a run with its summary."""

    event: Literal["run_ended"] = "run_ended"
    summary: dict[str, Any]
    """The document that `--json` prints."""


Emit: TypeAlias = Callable[[Event], None]
