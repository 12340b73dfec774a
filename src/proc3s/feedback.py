"""Feedback: what the trials of a round say about why it failed."""

from collections import Counter
from collections.abc import Sequence

from pydantic import BaseModel, ConfigDict

from proc3s.problem import Trial
from proc3s.sketch.errors import SketchError


class Failure(BaseModel):
    """One way in which samples failed: at a step by a violation, or by an error of the program."""

    model_config = ConfigDict(frozen=True)

    kind: str
    """Name of the constraint, or of the program error."""
    text: str
    """The sentence of the violation or the message of the error."""
    step: int | None = None
    """Step of the plan, from 0; None for an error."""
    skill: str | None = None
    line: int | None = None
    """Line of the program, for an error."""
    source: str | None = None
    """That line."""
    share: int
    """Percent of the samples, rounded to 5 so that the text is stable."""


class Diagnosis(BaseModel):
    """Why a round did not end in an accepted plan; one object for the LLM, the console and the log."""

    model_config = ConfigDict(frozen=True)

    samples: int
    """Verdicts taken in the round."""
    reached: int = 0
    """Most steps that any sample carried out before its first violation."""
    failures: tuple[Failure, ...] = ()
    """Ways to fail, commonest first."""
    program_errors: tuple[Failure, ...] = ()
    """Why the program could not be used, or had to be stopped."""


def diagnose(trials: Sequence[Trial], error: SketchError | None = None) -> Diagnosis:
    """Rank the first failures of trials; `error` is what ended the program, if something did.

    Failures are counted as the paper does, by joint step, skill and sentence; ties keep plan order.
    """
    counts = Counter(_first_failure(trial) for trial in trials if not trial.accepted)
    ranked = sorted(counts.items(), key=lambda item: (-item[1], item[0].step or 0, item[0].text))
    return Diagnosis(
        samples=len(trials),
        reached=max((trial.reached for trial in trials), default=0),
        failures=tuple(f.model_copy(update={"share": _percent(n, len(trials))}) for f, n in ranked),
        program_errors=_program_errors(error) if error else (),
    )


def _first_failure(trial: Trial) -> Failure:
    if trial.violations:
        first = trial.violations[0]
        return Failure(kind=first.constraint, text=first.text, step=first.step, skill=first.skill, share=0)
    assert isinstance(trial.error, SketchError)
    return _failure(trial.error)


def _failure(error: SketchError) -> Failure:
    return Failure(kind=error.kind, text=error.message, line=error.line, source=error.source, share=0)


def _program_errors(error: SketchError) -> tuple[Failure, ...]:
    issues = error.issues or (error,)
    return tuple(
        Failure(kind=error.kind, text=i.message, line=i.line, source=i.source, share=100) for i in issues
    )


def _percent(part: int, whole: int) -> int:
    return max(5, 5 * round(20 * part / whole))
