"""The summary of a run: one flat document for people and programs."""

from collections import Counter
from dataclasses import asdict
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict

from proc3s.domain.values import Plan
from proc3s.domain.world_options import world_used
from proc3s.errors import Stopped
from proc3s.feedback.report import Diagnosis, Failure
from proc3s.llm.budget import Spent
from proc3s.planning.attempts import furthest
from proc3s.planning.options import RunOptions
from proc3s.planning.parts import Setup
from proc3s.planning.planner import Outcome


class Summary(BaseModel):
    """What `run` and `solve` print with `--json` and keep as `summary.json`."""

    model_config = ConfigDict(use_attribute_docstrings=True)

    task: str | None = None
    """`domain/task`."""
    method: str | None = None
    """The method."""
    llm: str | None = None
    """The language model as `--llm` names it; null if none was asked."""
    llm_source: Literal["live", "recorded", "authored", "manual", "none"] = "none"
    """Where the last answer is from; authored ones were written by hand."""
    stale: bool = False
    """An answer was given to another prompt than that of this run (`-L stale=accept`)."""
    solver: str | None = None
    """The solver."""
    preset: str | None = None
    """The preset."""
    seed: int | None = None
    """The seed of the scene and of the search."""
    world: dict[str, str] = {}
    """What the worlds really used of what `-W` may choose; empty for a world without options."""
    solved: bool = False
    """The world accepted the plan."""
    executed: Literal["solution", "fallback", "none"] = "none"
    """Whether the plan that was carried out is an accepted one."""
    goal_reached: bool | None = None
    """The judge says that the instruction is fulfilled; null without a judge."""
    goal_reason: str | None = None
    """Why the judge says so."""
    goal_expected: bool | None = None
    """The same verdict on the world that accepted the plan; execution may end otherwise."""
    rounds: int = 0
    """Feedback rounds after the first answer."""
    samples: int = 0
    """Parameter vectors with a verdict, up to the accepted one, over all rounds."""
    evaluations: int = 0
    """Those of them that the world had to look at."""
    rehearsals: int = 0
    """Of plans that the world had accepted, under disturbances (`--robust`)."""
    rejected_by: dict[str, int] = {}
    """Samples that each screen rejected."""
    room: dict[str, Any] | None = None
    """What is tightest in the accepted plan: `value` in errors that are to be expected, `margin`,
    `constraint`, `step` (null for the goal) and `says`; null where nothing limits it."""
    improved: dict[str, Any] | None = None
    """What was tried around the first accepted plan for more room: `samples`, `room_before` and `room_after`
    in errors that are to be expected, whether the plan passed its rehearsals (`held`), and what ended this
    before its time (`broken_off`); null where nothing was tried."""
    seconds: dict[str, float] = {}
    """Wall seconds by stage."""
    cpu_seconds: dict[str, float] = {}
    """CPU seconds by stage, those of child processes included."""
    plan: list[dict[str, Any]] | None = None
    """The plan that was carried out, or else could not be though a world accepted it: `skill` and `args` of
    every step."""
    violations: list[dict[str, Any]] = []
    """What that plan violates; without one, the failures of the last round."""
    program_errors: list[dict[str, Any]] = []
    """Errors of the last program, with their line."""
    nearest: dict[str, Any] | None = None
    """Of an unsolved run, the plan that came furthest, and what it violates."""
    usage: Spent = Spent()
    """What the answers cost, recorded ones when they were recorded; unknown sums are null."""
    run_dir: str | None = None
    """The run folder."""
    stopped: Stopped | None = None
    """Why the run did not come to its end, in a word; `error` says it in a sentence."""
    error: str | None = None
    """Null unless the run could not be carried out."""


def summarize(
    options: RunOptions,
    setup: Setup,
    outcome: Outcome,
    run_dir: Path | None,
    usage: Spent,
) -> Summary:
    """The summary of an outcome. With no plan executed, the violations are those of the last round."""
    execution = outcome.execution
    last = _last(outcome)
    wall, cpu = outcome.clock.totals()
    plan = execution.plan if execution else _accepted(outcome)
    sources = {proposal.source for proposal in outcome.proposals}
    return Summary(
        task=options.task,
        method=setup.method.name,
        llm=None if sources == {"none"} else options.llm,
        llm_source=outcome.proposals[-1].source if outcome.proposals else "none",
        stale=any(proposal.stale for proposal in outcome.proposals),
        solver=setup.solver,
        preset=setup.preset.name,
        seed=options.seed,
        world=world_used(setup.problem.domain),
        solved=execution is not None and execution.executed == "solution",
        executed=execution.executed if execution else "none",
        goal_reached=execution.score.reached if execution and execution.score else None,
        goal_reason=execution.reason if execution else None,
        goal_expected=execution.expected.reached if execution and execution.expected else None,
        rounds=outcome.feedback,
        samples=sum(attempt.samples for attempt in outcome.attempts),
        evaluations=sum(attempt.evaluations for attempt in outcome.attempts),
        rehearsals=sum(attempt.rehearsals for attempt in outcome.attempts),
        rejected_by=_rejected_by(outcome),
        room=asdict(execution.room) if execution and execution.room else None,
        improved=_improved(outcome),
        seconds=_seconds(outcome.clock.wall, wall),
        cpu_seconds=_seconds(outcome.clock.cpu, cpu),
        plan=[action.to_json() for action in plan] if plan else None,
        nearest=None if execution and execution.executed == "solution" else _nearest(outcome),
        usage=usage,
        violations=_violations(outcome, last),
        program_errors=[_program_error(f) for f in (*last.program_errors, *last.failures) if f.step is None],
        run_dir=str(run_dir) if run_dir else None,
        stopped=outcome.error.stopped if outcome.error else None,
        error=str(outcome.error) if outcome.error else None,
    )


def _last(outcome: Outcome) -> Diagnosis:
    """The diagnosis of the last round's best program."""
    if not outcome.rounds:
        return Diagnosis(samples=0)
    latest = outcome.rounds[-1]
    return latest.attempts[latest.best].diagnosis


def _accepted(outcome: Outcome) -> Plan | None:
    """A plan that a world has accepted; it is told even if it could not be carried out."""
    found = (attempt.solution.plan for attempt in outcome.attempts if attempt.solution)
    return next((plan for plan in found if plan), None)


def _nearest(outcome: Outcome) -> dict[str, Any] | None:
    """The plan of the attempt that got furthest."""
    best = furthest(outcome.attempts)
    if best is None or best.nearest is None:
        return None
    return {"round": best.round, "candidate": best.candidate, **best.nearest}


def _rejected_by(outcome: Outcome) -> dict[str, int]:
    total: Counter[str] = Counter()
    for attempt in outcome.attempts:
        total.update(attempt.rejected_by)
    return dict(total)


def _improved(outcome: Outcome) -> dict[str, Any] | None:
    better = next((attempt.improved for attempt in outcome.attempts if attempt.improved), None)
    return better.counts if better else None


def _seconds(stages: dict[str, float], total: float) -> dict[str, float]:
    return {name: round(value, 4) for name, value in {**stages, "total": total}.items()}


def _violations(outcome: Outcome, last: Diagnosis) -> list[dict[str, Any]]:
    if outcome.execution:
        return [{**v.to_json(), "share": 100} for v in outcome.execution.violations]
    return [
        {"constraint": f.kind, "step": f.step, "skill": f.skill, "text": f.text, "share": f.share}
        for f in last.failures
        if f.step is not None
    ]


def _program_error(failure: Failure) -> dict[str, Any]:
    return {
        "kind": failure.kind,
        "message": failure.text,
        "line": failure.line,
        "source": failure.source,
        "share": failure.share,
        "parameters": failure.parameters,
    }
