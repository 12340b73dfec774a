"""An accepted plan is improved: the same program is asked for plans with more room around it."""

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from proc3s.domain.values import FloatArray
from proc3s.errors import Interrupted, Proc3sError, blame
from proc3s.planning.parts import Setup
from proc3s.sandbox.errors import SketchError
from proc3s.search.clock import Deadline
from proc3s.search.evaluator import Confirm, Evaluator
from proc3s.search.improvement import ENOUGH, Improvement, improve, room_value
from proc3s.search.sketch import Sketch
from proc3s.search.start import space_of
from proc3s.search.trial import Trial

TRIES = 2
"""So many of the roomiest plans are rehearsed, and the first accepted one."""
LATER = 1
"""After round and candidate in the key of random numbers: no search has a key of this length."""


@dataclass(frozen=True)
class Improved:
    """What came of improving: the trial with the most room, and what was spent on it, apart from the search.

    `held` says whether it passed its rehearsals, None where there are none. `broken_off` is what ended it
    before its time; the trial is good all the same.
    """

    best: Trial
    start: Trial
    samples: int
    evaluations: int
    rehearsals: int
    held: bool | None
    broken_off: Proc3sError | None = None

    @property
    def counts(self) -> dict[str, Any]:
        """Samples, the room before and after, whether the plan passed rehearsals, and what broke it off."""
        before, after = (trial.room.value if trial.room else None for trial in (self.start, self.best))
        ended = str(self.broken_off).partition(";")[0] if self.broken_off else None
        counts = {"samples": self.samples, "room_before": before, "room_after": after}
        return {**counts, "held": self.held, "broken_off": ended}


def improved(
    setup: Setup, sketch: Sketch, start: Trial, key: tuple[int, int], confirm: Confirm, deadline: Deadline
) -> Improved | None:
    """The roomiest plan that is found around an accepted one; None where there is nothing to improve.

    Plans are tried without rehearsals, which only decide between the roomiest; none is lost by them.
    """
    if setup.improve == 0 or sketch.space.dim == 0 or room_value(start) >= ENOUGH:
        return None
    evaluator = Evaluator(dataclasses.replace(setup.problem, robust=0), sketch, setup.executor)
    found, broken_off = _explore(setup, evaluator, start, key, deadline)
    best, rehearsals, held = _kept(setup, found, confirm)
    return Improved(best, start, evaluator.samples, evaluator.evaluations, rehearsals, held, broken_off)


def _explore(
    setup: Setup, evaluator: Evaluator, start: Trial, key: tuple[int, int], deadline: Deadline
) -> tuple[Improvement, Proc3sError | None]:
    """Samples around the start, and what broke this off."""
    space, found = space_of(evaluator), Improvement(start)
    rng = np.random.default_rng(np.random.SeedSequence(setup.problem.seed, spawn_key=(*key, LATER)))

    def take(u: FloatArray) -> Iterator[Trial]:
        for trial in evaluator.stream(u):
            yield trial
            deadline.check()

    try:
        solver = setup.make_improver(space, setup.improve, rng)
        with blame(f"solver {setup.improver}", SketchError):
            improve(found, setup.problem.domain, space, solver, setup.improve, take)
    except SketchError:  # what was found by then is as good
        return found, None
    except Proc3sError as error:
        return found, error
    except KeyboardInterrupt:
        return found, Interrupted("interrupted")
    return found, None


def _kept(setup: Setup, found: Improvement, confirm: Confirm) -> tuple[Trial, int, bool | None]:
    """The roomiest trial that passes its rehearsals and is confirmed, those of all, and whether it passed.

    If none passes, it is the roomiest that stands an expected error, or else the start: what is roomier but
    stands less is no safer. It is the start if that was to pass rehearsals.
    """

    def good(trial: Trial) -> bool:
        return trial is found.start or confirm(trial) is None

    ranked, rehearsals = [*found.better[:TRIES], found.start], 0
    passed, failed = (True, False) if setup.rehearsals else (None, None)
    try:
        for trial in ranked:
            again = _rehearsed(setup, trial)
            rehearsals += again.rehearsals
            if again.accepted and good(trial):
                return trial, rehearsals, passed
        if not setup.problem.robust:
            safer = [trial for trial in found.better[:TRIES] if room_value(trial) >= 1]
            return next(trial for trial in [*safer, found.start] if good(trial)), rehearsals, failed
    except SketchError:  # too many that cannot be confirmed
        pass
    return found.start, rehearsals, passed if setup.problem.robust else failed


def _rehearsed(setup: Setup, trial: Trial) -> Trial:
    """An accepted trial after its rehearsals; itself without any."""
    if not setup.rehearsals or trial.plan is None:
        return trial
    problem = dataclasses.replace(setup.problem, robust=setup.rehearsals)
    return next(iter(setup.executor.map(problem, [trial.plan])))
