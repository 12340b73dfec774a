from itertools import groupby

import numpy as np
import pytest

from proc3s.testing.solvers import blocked, box, chain, samples, solution, toy
from proc3s_solvers import portfolio


@pytest.fixture
def turns(solvers, monkeypatch):
    """Who asked, and how many samples in a row, over a hopeless search of a given length."""

    def play(budget, **options):
        asked = []

        def spy(kind):
            class Spy(kind):
                def tell(self, trials):
                    asked.extend([kind.__name__] * len(trials))
                    super().tell(trials)

            return Spy

        for name in ("Rejection", "Backtracking", "Cma"):
            monkeypatch.setattr(portfolio, name, spy(getattr(portfolio, name)))
        problem = blocked()
        samples(solvers("portfolio", **options), problem.space, problem, budget)
        return [(name, len(list(run))) for name, run in groupby(asked)]

    return play


def test_turns_double_after_rejection(turns):
    assert turns(64 + 2 * 128 + 2 * 256 + 100) == [
        ("Rejection", 64),
        ("Backtracking", 128),
        ("Cma", 128),
        ("Backtracking", 256),
        ("Cma", 256),
        ("Backtracking", 100),
    ]


def test_turns_may_be_of_any_length(turns):
    assert turns(10 + 2 * 7 + 2 * 14, rejection=10, turn=7) == [
        ("Rejection", 10),
        ("Backtracking", 7),
        ("Cma", 7),
        ("Backtracking", 14),
        ("Cma", 14),
    ]


def test_a_solver_goes_on_where_its_last_turn_ended(solvers):
    problem = blocked()
    u = samples(solvers("portfolio"), problem.space, problem, 64 + 2 * 128 + 2 * 256)
    at = np.cumsum([0, 64, 128, 128, 256, 256])
    first, second, third = np.random.default_rng(0).spawn(3)
    by_backtracking = np.vstack([u[at[1] : at[2]], u[at[3] : at[4]]])
    by_cma = np.vstack([u[at[2] : at[3]], u[at[4] :]])
    assert np.array_equal(u[:64], first.random((64, 10)))
    for name, rng, found in (("backtracking", second, by_backtracking), ("cma", third, by_cma)):
        alone = samples(lambda s, b, _, n=name, r=rng: solvers(n)(s, b, r), problem.space, problem, 384)
        assert np.array_equal(found, alone)


PROBLEMS = {
    "box": box(),
    "chain": chain(10, 0.16),
    "ball": toy(lambda p: [0.12 - float(np.linalg.norm(p - 0.37))], [0] * 4),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", PROBLEMS)
def test_it_is_never_much_worse_than_the_best_of_its_solvers(solvers, name):
    """On average over five seeds: twice the samples of the best, and 128."""
    problem = PROBLEMS[name]

    def mean(solver):
        found = [solution(solvers(solver), problem, 1000, seed) for seed in range(5)]
        return np.mean([1000 if trial is None else trial.index + 1 for trial in found])

    best = min(mean(solver) for solver in ("rejection", "backtracking", "cma"))
    assert mean("portfolio") <= 2 * best + 128
