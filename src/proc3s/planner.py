"""The two-stage loop: a task becomes a program, a program becomes a plan that a world has accepted.

Read this first. Stage 1: `propose` asks for a program (`conversation.py`). Stage 2: the program runs in its
box (`sketch/`), a solver draws its open parameters (`solving.py`), every grounded plan is rolled out in the
world (`problem.py`). If no sample is accepted, a diagnosis of the failures goes into the next question.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from proc3s.audit import Audit
from proc3s.clock import Clock
from proc3s.conversation import Exchange, Proposal, Propose, Rounds
from proc3s.errors import Interrupted, Proc3sError
from proc3s.evaluation import Evaluator
from proc3s.events import Audited, BatchEvaluated, Emit, ProgramExtracted, RoundEnded, SketchLoaded
from proc3s.execution import Execution, execute
from proc3s.feedback import Diagnosis, diagnose
from proc3s.grounding import Opened, Repeatable, Setup, open_sketch
from proc3s.influence import influence
from proc3s.problem import Trial
from proc3s.sketch.box import prewarm
from proc3s.sketch.errors import SketchError
from proc3s.solving import Search, solve
from proc3s.state import Plan, source_text


@dataclass(frozen=True)
class Attempt:
    """What one program came to: the accepted trial, or a plan to fall back on, and a diagnosis."""

    diagnosis: Diagnosis
    solution: Trial | None = None
    fallback: Plan | None = None
    broken_off: Proc3sError | None = None
    samples: int = 0
    evaluations: int = 0
    rejected_by: Mapping[str, int] = field(default_factory=dict)
    round: int = 0


@dataclass(frozen=True)
class Outcome:
    """What a run came to. `rounds` counts feedback rounds; `error` is why it did not come to its end."""

    attempts: tuple[Attempt, ...]
    proposals: tuple[Proposal, ...]
    rounds: int
    execution: Execution | None
    clock: Clock
    error: Proc3sError | None = None


def plan(setup: Setup, propose: Propose, emit: Emit) -> Outcome:
    """Ask, search, and ask again with feedback, until a plan is accepted or the rounds are used up."""
    clock = Clock("llm", "solve", "execute")
    proposals: list[Proposal] = []
    attempts: list[Attempt] = []
    history: list[Exchange] = []
    rounds = Rounds(setup.method.rounds, setup.preset.repairs)
    execution, error = None, None
    try:
        while rounds.left:
            prewarm(setup.limits, setup.locked)
            with clock("llm"):
                proposals.append(propose(len(history), history))
            with clock("solve"):
                attempts.append(attempt := _attempt(setup, proposals[-1], emit))
            if attempt.broken_off:
                raise attempt.broken_off
            if attempt.solution or (setup.method.samples == "none" and attempt.fallback):
                break
            rounds.spend(repair=not attempt.samples)
            emit(RoundEnded(round=len(history), diagnosis=attempt.diagnosis))
            history.append(Exchange(proposals[-1].answer, attempt.diagnosis))
        with clock("execute"):
            execution = _execute(setup, attempts, emit)
    except Proc3sError as reason:
        error = reason
    except KeyboardInterrupt:
        error = Interrupted("interrupted")
    return Outcome(tuple(attempts), tuple(proposals), rounds.used, execution, clock, error)


def _attempt(setup: Setup, proposal: Proposal, emit: Emit) -> Attempt:
    """Ground one program: check it, search its parameters, diagnose what failed."""
    try:
        source = proposal.program()
        emit(ProgramExtracted(round=proposal.round, source=source))
        setup = replace(setup, problem=replace(setup.problem, program=source))
        with open_sketch(setup) as opened:
            prewarm(setup.limits, setup.locked)  # confirms the winner, or serves the next round
            samplers = opened.sketch.space.samplers.items()
            parameters = {name: source_text(sampler) for name, sampler in samplers}
            emit(SketchLoaded(round=proposal.round, parameters=parameters, log=opened.log))
            return _search(setup, opened, proposal.round, emit)
    except SketchError as error:
        return Attempt(diagnose((), error), round=proposal.round)


def _search(setup: Setup, opened: Opened, round_: int, emit: Emit) -> Attempt:
    budget = {"none": 0, "one": 1, "budget": setup.problem.samples}[setup.method.samples]
    audit = Audit(setup.audit, setup.problem.seed) if setup.audit else None
    evaluator = Evaluator(setup.problem, opened.sketch, setup.executor, Repeatable(setup), audit)
    # A key of its own for every round, so that no search draws the numbers that made the scene.
    rng = np.random.default_rng(np.random.SeedSequence(setup.problem.seed, spawn_key=(round_,)))
    space = replace(opened.sketch.space, probe=lambda: influence(opened.sketch))
    search: Search = solve(
        space,
        setup.make_solver(space, budget, rng),
        evaluator,
        budget,
        lambda trials: emit(BatchEvaluated.from_trials(round_, trials)) if trials else None,
    )
    if audit and not search.broken_off:
        emit(Audited.of(round_, audit.check(setup.problem, setup.executor)))
    return Attempt(
        diagnosis=diagnose(search.trials, search.halted, setup.problem, space),
        solution=search.solution,
        fallback=opened.plan if setup.method.fallback == "last_plan" else None,
        broken_off=search.broken_off,
        samples=evaluator.samples,
        evaluations=evaluator.evaluations,
        rejected_by=dict(evaluator.rejected_by),
        round=round_,
    )


def _execute(setup: Setup, attempts: list[Attempt], emit: Emit) -> Execution | None:
    """Carry out the accepted plan, or the latest one to fall back on, and let the judge look."""
    last = attempts[-1]
    if last.solution and last.solution.plan:
        return execute(setup.problem, last.solution.plan, "solution", last.round, setup.picture, emit)
    usable = [(attempt.fallback, attempt.round) for attempt in attempts if attempt.fallback]
    if not usable:
        return None
    fallback, round_ = usable[-1]
    return execute(setup.problem, fallback, "fallback", round_, setup.picture, emit)
