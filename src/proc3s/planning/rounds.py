"""One round: the proposed programs are grounded, race for the samples, and leave a diagnosis each."""

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from proc3s.domain.source_text import source_text
from proc3s.domain.values import Plan
from proc3s.feedback.diagnosis import diagnose
from proc3s.planning.attempts import Attempt, Round
from proc3s.planning.grounding import Opened, ReproducibilityCheck, open_sketch
from proc3s.planning.improving import Improved, improved
from proc3s.planning.parts import Setup
from proc3s.planning.proposals import Proposal
from proc3s.runs.events import (
    AttemptEnded,
    Audited,
    BatchEvaluated,
    Emit,
    PlanImproved,
    ProgramExtracted,
    SamplerCall,
    SketchLoaded,
)
from proc3s.sandbox.box import prewarm
from proc3s.sandbox.errors import SketchError
from proc3s.search.clock import Deadline
from proc3s.search.evaluator import Confirm, Evaluator
from proc3s.search.race import race
from proc3s.search.screen_audit import Audit
from proc3s.search.search import Search
from proc3s.search.start import start_search
from proc3s.search.trial import Trial


@dataclass(frozen=True)
class Entrant:
    """A loaded program with its search under way."""

    setup: Setup
    opened: Opened
    evaluator: Evaluator
    confirm: Confirm
    search: Search
    deadline: Deadline
    audit: Audit | None
    review: Audit


REVIEWED = 24
"""So many rejects of screens that are not exact are put to the world before a round is diagnosed: a screen
may name a later step, or another constraint, than the world would."""


def run_round(setup: Setup, proposals: Sequence[Proposal], emit: Emit) -> Round:
    """Ground every program, let them race, diagnose what failed."""
    deadline = Deadline("--limit round", setup.clock_limits.round)
    with ExitStack() as boxes:
        entrants = [_enter(setup, proposal, boxes, emit, deadline) for proposal in proposals]
        race([e.search for e in entrants if isinstance(e, Entrant)], _budget(setup, len(entrants)))
        attempts = tuple(
            _attempt(e, proposal, emit)
            if isinstance(e, Entrant)
            else Attempt(diagnose((), e), proposal.round, proposal.candidate)
            for e, proposal in zip(entrants, proposals, strict=True)
        )
    for attempt in attempts:
        emit(_ended(attempt))
    return Round(tuple(proposals), attempts)


def _budget(setup: Setup, programs: int = 1) -> int:
    """Samples that so many programs may take together."""
    return {"none": 0, "one": programs, "budget": setup.problem.samples}[setup.method.samples]


def _enter(
    setup: Setup, proposal: Proposal, boxes: ExitStack, emit: Emit, deadline: Deadline
) -> Entrant | SketchError:
    """A search of the program, not begun yet; or why there can be none."""
    round_, candidate = proposal.round, proposal.candidate
    try:
        found = proposal.program()
        source = found.program
        emit(ProgramExtracted(round=round_, candidate=candidate, source=source, blocks=found.blocks))
        opened = boxes.enter_context(open_sketch(setup, source))
        prewarm(setup.limits, setup.locked)  # confirms the winner, or serves the next program
        emit(_loaded(proposal, opened))
        return _search(setup, source, opened, proposal, emit, deadline)
    except SketchError as error:
        return error


def _loaded(proposal: Proposal, opened: Opened) -> SketchLoaded:
    samplers = opened.sketch.space.samplers
    return SketchLoaded(
        round=proposal.round,
        candidate=proposal.candidate,
        parameters={name: source_text(sampler) for name, sampler in samplers.items()},
        dims={name: sampler.dim for name, sampler in samplers.items()},
        samplers={name: _call(sampler) for name, sampler in samplers.items()},
        log=opened.log,
    )


def _call(sampler: Any) -> SamplerCall:
    known = fields(sampler) if is_dataclass(sampler) else ()
    args = {field.name: getattr(sampler, field.name) for field in known}
    return SamplerCall(sampler=type(sampler).__name__, args=args)


def _search(
    setup: Setup, source: str, opened: Opened, proposal: Proposal, emit: Emit, deadline: Deadline
) -> Entrant:
    audit = Audit(setup.audit, setup.problem.seed) if setup.audit else None
    review = Audit(REVIEWED, setup.problem.seed)
    confirm = ReproducibilityCheck(setup, source)
    evaluator = Evaluator(setup.problem, opened.sketch, setup.executor, confirm, audit, review)
    key = (proposal.round, proposal.candidate) if proposal.candidate else (proposal.round,)
    columns = partial(BatchEvaluated.from_trials, proposal.round, proposal.candidate)
    search = start_search(
        evaluator,
        setup.make_solver,
        _budget(setup),
        key,
        lambda trials: emit(columns(trials)),
        deadline.check,
    )
    return Entrant(setup, opened, evaluator, confirm, search, deadline, audit, review)


def _attempt(entrant: Entrant, proposal: Proposal, emit: Emit) -> Attempt:
    setup, search = entrant.setup, entrant.search
    better = _improved(entrant, proposal, emit)
    if entrant.audit and not search.broken_off:
        found = entrant.audit.check(setup.problem, setup.executor)
        emit(Audited.of(proposal.round, proposal.candidate, found))
    reviewed: tuple[Trial, ...] = ()
    if not search.broken_off and not search.solution:
        reviewed = entrant.review.check(setup.problem, setup.executor).world
    return Attempt(
        diagnosis=diagnose(search.trials, search.halted, setup.problem, search.space, reviewed, search.alike),
        round=proposal.round,
        candidate=proposal.candidate,
        solution=better.best if better else search.solution,
        improved=better,
        fallback=entrant.opened.plan if setup.method.fallback == "last_plan" else None,
        nearest=_nearest(entrant),
        broken_off=search.broken_off,
        samples=entrant.evaluator.samples,
        evaluations=entrant.evaluator.evaluations,
        rehearsals=entrant.evaluator.rehearsals,
        rejected_by=dict(entrant.evaluator.rejected_by),
    )


def _improved(entrant: Entrant, proposal: Proposal, emit: Emit) -> Improved | None:
    """The accepted plan of a search with more room, if there is one and that was wanted."""
    solution, setup = entrant.search.solution, entrant.setup
    if solution is None:
        return None
    key, confirm = (proposal.round, proposal.candidate), entrant.confirm
    better = improved(setup, entrant.opened.sketch, solution, key, confirm, entrant.deadline)
    if better:
        emit(PlanImproved(round=key[0], candidate=key[1], **better.counts))
    return better


def _nearest(entrant: Entrant) -> Mapping[str, Any] | None:
    """The sample that came furthest, if none was accepted."""
    best = max(entrant.search.trials, key=lambda trial: trial.progress, default=None)
    if best is None or best.accepted or not (plan := best.plan or _again(entrant, best)):
        return None
    if best.screen in {spec.name for spec in entrant.setup.problem.domain.screens if not spec.exact}:
        best = _in_the_world(entrant, plan)  # a screen may name another step or constraint
    return {
        "reached": best.reached,
        "plan": [action.to_json() for action in plan],
        "violations": [violation.to_json() for violation in best.violations],
    }


def _in_the_world(entrant: Entrant, plan: Plan) -> Trial:
    """What the world says of a plan that a screen rejected."""
    plain = replace(entrant.setup.problem, screens="none")
    return next(iter(entrant.setup.executor.map(plain, [plan])))


def _again(entrant: Entrant, trial: Trial) -> Plan | None:
    """The plan of a sample that a screen rejected, made again to be shown; None if the program fails."""
    try:
        batch = entrant.opened.sketch.plans(np.array([trial.u]), trial.index)
    except SketchError:
        return None
    return None if 0 in batch.errors else batch.plan(0)


def _ended(attempt: Attempt) -> AttemptEnded:
    return AttemptEnded(
        round=attempt.round,
        candidate=attempt.candidate,
        diagnosis=attempt.diagnosis,
        samples=attempt.samples,
        evaluations=attempt.evaluations,
        rehearsals=attempt.rehearsals,
        rejected_by=dict(attempt.rejected_by),
        fallback=[action.to_json() for action in attempt.fallback] if attempt.fallback else None,
        nearest=dict(attempt.nearest) if attempt.nearest else None,
    )
