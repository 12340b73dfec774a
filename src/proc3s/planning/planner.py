"""The two-stage loop: a task becomes a program, a program becomes a plan that a world has accepted.

Read this first. Stage 1: `propose` asks for programs (`proposals.py`). Stage 2: each program runs in its
box (`sandbox/`), a solver draws its open parameters (`rounds.py`, `search/`), every grounded plan is rolled
out in the world (`search/rollout.py`). If no sample is accepted, a diagnosis of the failures goes into the
next question.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from proc3s.errors import Interrupted, Proc3sError
from proc3s.llm.errors import BudgetSpent
from proc3s.planning.attempts import Attempt, Round
from proc3s.planning.execution import Execution, execute
from proc3s.planning.parts import Setup
from proc3s.planning.pictures import Miss, draw_unsolved, nearest_miss
from proc3s.planning.proposals import Proposal, Propose
from proc3s.planning.round_budget import RoundBudget
from proc3s.planning.rounds import run_round
from proc3s.runs.events import Emit, RoundEnded
from proc3s.sandbox.box import prewarm
from proc3s.search.clock import STAGES, Clock


@dataclass(frozen=True)
class Outcome:
    """The result of a run. `feedback` counts feedback rounds; `error` is why it ended early."""

    rounds: tuple[Round, ...]
    proposals: tuple[Proposal, ...]
    feedback: int
    execution: Execution | None
    clock: Clock
    error: Proc3sError | None = None

    @property
    def attempts(self) -> tuple[Attempt, ...]:
        """The results of all programs, round by round."""
        return tuple(attempt for round_ in self.rounds for attempt in round_.attempts)


class Run:
    """A run under way: the rounds so far, of which `earlier` were done by another process."""

    def __init__(
        self, setup: Setup, propose: Propose, emit: Emit, earlier: Sequence[Round], clock: Clock
    ) -> None:
        self._setup = setup
        self._propose = propose
        self._emit = emit
        self._clock = clock
        self._left = RoundBudget(setup.method.rounds, setup.preset.repairs)
        self._rounds = list(earlier)
        self._proposals = [proposal for round_ in earlier for proposal in round_.proposals]
        for round_ in earlier:
            self._left.spend(repair=not round_.samples)

    def outcome(self) -> Outcome:
        """Carry the run to its end."""
        execution: Execution | None = None
        error: Proc3sError | None = None
        try:
            try:
                self._search()
            except BudgetSpent as reason:
                error = reason
            with self._clock("execute"):
                execution = self._execute()
                self._draw(execution)
        except Proc3sError as reason:
            error = reason
        except KeyboardInterrupt:
            error = Interrupted("interrupted")
        rounds, proposals = tuple(self._rounds), tuple(self._proposals)
        return Outcome(rounds, proposals, self._left.used, execution, self._clock, error)

    def _search(self) -> None:
        """Ask, search, and ask again with feedback, until a plan is accepted or the rounds are used up."""
        setup = self._setup
        while self._left.left:
            prewarm(setup.limits, setup.locked)
            with self._clock("llm"):
                proposals = self._propose(len(self._rounds), [round_.exchange for round_ in self._rounds])
            self._proposals += proposals
            with self._clock("solve"):
                self._rounds.append(latest := run_round(setup, proposals, self._emit))
            for attempt in latest.attempts:
                if attempt.broken_off:
                    raise attempt.broken_off
            if any(a.solution or (setup.method.samples == "none" and a.fallback) for a in latest.attempts):
                return
            self._left.spend(repair=not latest.samples)
            self._emit(self._ended(latest))

    def _ended(self, latest: Round) -> RoundEnded:
        return RoundEnded(
            round=len(self._rounds) - 1,
            candidate=latest.attempts[latest.best].candidate,
            diagnosis=latest.attempts[latest.best].diagnosis,
            seconds=dict(self._clock.wall),
            cpu_seconds=dict(self._clock.cpu),
        )

    def _draw(self, execution: Execution | None) -> None:
        """Pictures of a run that was not solved: whatever its plan, what came nearest."""
        pictures = self._setup.pictures
        if pictures is None or not pictures.miss or (execution and execution.executed == "solution"):
            return
        miss = nearest_miss([attempt for round_ in self._rounds for attempt in round_.attempts])
        if miss is None and execution and execution.violations:
            miss = Miss.of(execution.plan, execution.violations[0])
        draw_unsolved(self._setup.problem, miss, pictures.folder, self._emit)

    def _execute(self) -> Execution | None:
        """Carry out the accepted plan, or the latest one to fall back on, and let the judge look."""
        if not self._rounds:
            return None
        setup, latest = self._setup, self._rounds[-1]
        winner = latest.attempts[latest.best]
        if winner.solution and winner.solution.plan:
            place = (winner.round, winner.candidate)
            return execute(setup.problem, winner.solution.plan, "solution", place, setup.pictures, self._emit)
        ranked = (round_.attempts[i] for round_ in reversed(self._rounds) for i in round_.ranking)
        usable = next((attempt for attempt in ranked if attempt.fallback), None)
        if usable is None or usable.fallback is None:
            return None
        place = (usable.round, usable.candidate)
        return execute(setup.problem, usable.fallback, "fallback", place, setup.pictures, self._emit)


def plan(
    setup: Setup, propose: Propose, emit: Emit, earlier: Sequence[Round] = (), clock: Clock | None = None
) -> Outcome:
    """Solve a problem; `earlier` rounds were done already, `clock` has the seconds that they took."""
    return Run(setup, propose, emit, earlier, clock or Clock(*STAGES)).outcome()
