"""Feedback: what the trials of a round say about why it failed."""

import re
from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

from proc3s.domain.samplers import Space
from proc3s.feedback.circumstances import circumstances
from proc3s.feedback.parameters import bound_hits, separations
from proc3s.feedback.report import ConstraintReport, Diagnosis, Failure
from proc3s.feedback.shares import shares
from proc3s.sandbox.errors import SketchError, SketchTimeout
from proc3s.search.problem import Problem
from proc3s.search.trial import Trial

_NUMBER = re.compile(r"-?\d+(\.\d+)?")


_TEXTS = 3


@dataclass(frozen=True)
class _Failed:
    """A sample that failed, standing for `weight` samples."""

    trial: Trial
    weight: float = 1.0


def diagnose(
    trials: Sequence[Trial],
    error: SketchError | None = None,
    problem: Problem | None = None,
    space: Space | None = None,
    reviewed: Sequence[Trial] = (),
    alike: bool = False,
) -> Diagnosis:
    """Rank the first failures of trials; `error` is what ended the program, if something did.

    Failures are counted as the paper does, by joint step, skill and sentence; sentences that differ in
    numbers only count as one, and ties keep plan order. `problem` and `space` name what never failed and
    the parameters that matter. `reviewed` are the world's verdicts on a uniform choice of what screens that
    are not exact rejected: they stand for all of these.
    """
    failed = [trial for trial in trials if not trial.accepted]
    weighed = _weighed(failed, problem, reviewed)
    failures = _ranked(weighed, trials, space)
    errors = sum(failure.share for failure in failures if failure.step is None)
    reports = _by_constraint(weighed, len(trials), 100 - errors)
    names = list(problem.domain.spec.constraints) if problem else []
    violated = {report.constraint for report in reports}
    return Diagnosis(
        samples=len(trials),
        reached=max((one.trial.reached for one in weighed), default=0),
        failures=failures,
        alike=alike,
        program_errors=_program_errors(error, len(trials)) if error else (),
        constraints=reports,
        never_violated=tuple(name for name in names if trials and name not in violated),
        separations=separations(failed, space) if space else (),
        bound_hits=bound_hits(failed, space) if space else (),
    )


def _weighed(failed: Sequence[Trial], problem: Problem | None, reviewed: Sequence[Trial]) -> list[_Failed]:
    """Failures as the world sees them: those reviewed stand for all that such screens rejected."""
    if problem is None or not reviewed:
        return [_Failed(trial) for trial in failed]
    exact = {None} | {spec.name for spec in problem.domain.screens if spec.exact}
    sure = [_Failed(trial) for trial in failed if trial.screen in exact]
    weight = (len(failed) - len(sure)) / len(reviewed)
    return sure + [_Failed(trial, weight) for trial in reviewed if not trial.accepted]


def _ranked(failed: Sequence[_Failed], trials: Sequence[Trial], space: Space | None) -> tuple[Failure, ...]:
    groups: defaultdict[tuple[object, ...], list[_Failed]] = defaultdict(list)
    for one in failed:
        groups[_sort(_first_failure(one.trial))].append(one)
    counts = {key: sum(one.weight for one in group) for key, group in groups.items()}
    firsts = {key: _first_failure(group[0].trial) for key, group in groups.items()}
    ranked = sorted(groups, key=lambda key: (-counts[key], firsts[key].step or 0, firsts[key].text))
    percents = shares([counts[key] for key in ranked], len(trials))
    return tuple(
        firsts[key].model_copy(update={"share": share, "parameters": _parameters(groups[key], trials, space)})
        for key, share in zip(ranked, percents, strict=True)
    )


def _sort(failure: Failure) -> tuple[object, ...]:
    """Failures with the same are one."""
    # Reasons of judges and messages of errors are full of numbers that differ from sample to sample.
    exact = failure.step is not None and failure.skill != "goal"
    text = failure.text if exact else _NUMBER.sub("#", failure.text)
    # A loop without end is met at any of its lines.
    line = None if failure.kind == SketchTimeout.__name__ else failure.line
    return failure.kind, failure.step, failure.skill, line, text


def _parameters(group: Sequence[_Failed], trials: Sequence[Trial], space: Space | None) -> str:
    """In which samples the program failed so, if it is an error."""
    if space is None or group[0].trial.error is None:
        return ""
    indices = {one.trial.index for one in group}
    others = [trial for trial in trials if trial.index not in indices]
    return circumstances([one.trial for one in group], others, space)


def _first_failure(trial: Trial) -> Failure:
    if trial.violations:
        first = trial.violations[0]
        return Failure(kind=first.constraint, text=first.text, step=first.step, skill=first.skill, share=0)
    assert isinstance(trial.error, SketchError)
    error = trial.error
    return Failure(kind=error.kind, text=error.message, line=error.line, source=error.source, share=0)


def _by_constraint(failed: Sequence[_Failed], samples: int, left: int) -> tuple[ConstraintReport, ...]:
    found: defaultdict[str, list[_Failed]] = defaultdict(list)
    for one in failed:
        if one.trial.violations:
            found[one.trial.violations[0].constraint].append(one)
    percents = shares([sum(one.weight for one in group) for group in found.values()], samples, left)
    reports = [
        _report(name, [one.trial for one in group], share)
        for (name, group), share in zip(found.items(), percents, strict=True)
    ]
    return tuple(sorted(reports, key=lambda report: (-report.share, report.constraint)))


def _report(constraint: str, trials: Sequence[Trial], share: int) -> ConstraintReport:
    """What the trials that a constraint refused have in common."""
    told = [trial.violations[0] for trial in trials]
    roomiest = max((trial.room for trial in trials if trial.room), key=lambda room: room.value, default=None)
    return ConstraintReport(
        constraint=constraint,
        share=share,
        steps=tuple(sorted({violation.step for violation in told})),
        texts=tuple(text for text, _ in Counter(v.text for v in told).most_common(_TEXTS)),
        best_margin=max(violation.margin for violation in told),
        room=str(roomiest) if roomiest else "",
    )


def _program_errors(error: SketchError, samples: int) -> tuple[Failure, ...]:
    """What ended the program: all there is to say without a sample, else what its last sample showed."""
    issues = error.issues or (error,)
    share = shares([1], samples + 1)[0] if samples else 100
    return tuple(
        Failure(kind=error.kind, text=i.message, line=i.line, source=i.source, share=share) for i in issues
    )
