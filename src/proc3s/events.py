"""Typed events of a run: what logs, consoles and reports hang on."""

import math
from collections.abc import Callable, Sequence
from typing import Any, Literal, TypeAlias

from pydantic import BaseModel, ConfigDict

from proc3s.audit import Findings
from proc3s.feedback import Diagnosis
from proc3s.llms import Completion, Message
from proc3s.problem import Trial


class Event(BaseModel):
    """Base of all events; `event` names it in the log."""

    model_config = ConfigDict(frozen=True)

    event: str


class RunStarted(Event):
    """A run begins; `options` are enough to repeat it."""

    event: Literal["run_started"] = "run_started"
    options: dict[str, Any]
    versions: dict[str, str]
    samples: int
    """Samples that a round may take."""
    scene: str
    """The initial state as JSON."""


class PromptRendered(Event):
    """The messages of a round, before the LLM is asked."""

    event: Literal["prompt_rendered"] = "prompt_rendered"
    round: int
    sha256: str
    messages: tuple[Message, ...]


class AnswerReceived(Event):
    """The answer of a round."""

    event: Literal["answer_received"] = "answer_received"
    round: int
    completion: Completion


class ProgramExtracted(Event):
    """The program found in the answer."""

    event: Literal["program_extracted"] = "program_extracted"
    round: int
    source: str


class SketchLoaded(Event):
    """The program passed its contract check; these are its open parameters."""

    event: Literal["sketch_loaded"] = "sketch_loaded"
    round: int
    parameters: dict[str, str]
    log: str = ""


class BatchEvaluated(Event):
    """Trials of one batch as columns; equal positions belong to one sample."""

    event: Literal["batch_evaluated"] = "batch_evaluated"
    round: int
    first: int
    u: list[list[float]]
    accepted: list[bool]
    reached: list[int]
    violation: list[str | None]
    step: list[int | None]
    text: list[str | None]
    margin: list[float | None]

    @classmethod
    def from_trials(cls, round_: int, trials: Sequence[Trial]) -> "BatchEvaluated":
        """The columns of a batch that is not empty."""
        firsts = [trial.violations[0] if trial.violations else None for trial in trials]
        return cls(
            round=round_,
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


class Audited(Event):
    """Rejects of screens that were put to the world: how many, and those it accepts."""

    event: Literal["audited"] = "audited"
    round: int
    checked: int
    wrong: list[dict[str, Any]]

    @classmethod
    def of(cls, round_: int, findings: Findings) -> "Audited":
        """The findings of one round."""
        wrong = [
            {"plan": [action.to_json() for action in plan], "rejected_for": violation.text}
            for plan, violation in findings.wrong
        ]
        return cls(round=round_, checked=findings.checked, wrong=wrong)


class RoundEnded(Event):
    """A round without an accepted plan, and why."""

    event: Literal["round_ended"] = "round_ended"
    round: int
    diagnosis: Diagnosis


class PlanExecuted(Event):
    """The plan that was carried out, what it violated, and the judge's verdict."""

    event: Literal["plan_executed"] = "plan_executed"
    round: int
    executed: Literal["solution", "fallback"]
    plan: list[dict[str, Any]]
    violations: list[dict[str, Any]]
    goal_reached: bool | None
    goal_reason: str


class RunEnded(Event):
    """The end of a run with its summary."""

    event: Literal["run_ended"] = "run_ended"
    summary: dict[str, Any]


Emit: TypeAlias = Callable[[Event], None]
