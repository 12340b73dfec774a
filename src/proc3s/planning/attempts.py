"""The result of each program of a round."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from proc3s.domain.values import Plan
from proc3s.errors import Proc3sError
from proc3s.feedback.report import Diagnosis
from proc3s.planning.improving import Improved
from proc3s.planning.proposals import Proposal
from proc3s.prompts.conversation import Exchange
from proc3s.search.trial import Trial


@dataclass(frozen=True)
class Attempt:
    """The result of one program: the accepted trial, or a plan to fall back on, and a diagnosis."""

    diagnosis: Diagnosis
    round: int = 0
    candidate: int = 0
    solution: Trial | None = None
    """The accepted trial, improved if that was wanted."""
    improved: Improved | None = None
    fallback: Plan | None = None
    nearest: Mapping[str, Any] | None = None
    """The plan that came furthest and what it violates, as JSON."""
    broken_off: Proc3sError | None = None
    samples: int = 0
    evaluations: int = 0
    rehearsals: int = 0
    rejected_by: Mapping[str, int] = field(default_factory=dict)


def furthest(attempts: Sequence[Attempt]) -> Attempt | None:
    """The attempt whose nearest plan came furthest; None if no plan was tried."""
    tried = [attempt for attempt in attempts if attempt.nearest]
    return max(tried, key=lambda attempt: attempt.diagnosis.progress, default=None)


@dataclass(frozen=True)
class Round:
    """The programs of a round and their results, in the same order."""

    proposals: tuple[Proposal, ...]
    attempts: tuple[Attempt, ...]

    @property
    def ranking(self) -> list[int]:
        """Numbers of the attempts, the solved one or the furthest first; equals in order."""
        ranks = [(a.solution is not None, a.diagnosis.progress) for a in self.attempts]
        return sorted(range(len(ranks)), key=lambda i: ranks[i], reverse=True)

    @property
    def best(self) -> int:
        """Number of the attempt that was solved or got furthest."""
        return self.ranking[0]

    @property
    def exchange(self) -> Exchange:
        """What the next question shows of this round."""
        return Exchange(self.proposals[self.best].answer, self.attempts[self.best].diagnosis)

    @property
    def samples(self) -> int:
        """Samples of all programs together."""
        return sum(attempt.samples for attempt in self.attempts)
