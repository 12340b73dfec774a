"""Solvers on the programs of the Drawing domain, through the whole second stage."""

import pytest

LIMIT = 10000
SEEDS = range(10)
SINGLE = ("rejection", "backtracking", "cma")


@pytest.mark.parametrize("solver", ["backtracking", "portfolio"])
@pytest.mark.parametrize("program", ["chain.ends", "chain.long"])
@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in SEEDS[1:])])
def test_ten_independent_strokes_take_500_samples_at_most(programs, samples_of, program, solver, seed):
    """A long stroke is clear in one case of six: rejection needs between 10^6 and 10^11 samples."""
    task, text = programs[program]
    taken = samples_of(task, text, solver, seed, LIMIT)
    assert taken is not None
    assert taken <= 500


def test_rejection_does_not_solve_the_long_strokes(programs, samples_of):
    task, text = programs["chain.long"]
    assert samples_of(task, text, "rejection", 0, 2000) is None


@pytest.mark.slow
def test_the_portfolio_keeps_up_with_the_best_of_its_solvers(programs, samples_of):
    """Samples on average over ten seeds, an unsolved one counted as the limit; run with -s for the table."""
    limit, table = 2000, {}
    for name, (task, text) in programs.items():
        for solver in (*SINGLE, "portfolio"):
            found = [samples_of(task, text, solver, seed, limit) for seed in SEEDS]
            solved = [taken for taken in found if taken is not None]
            mean = (sum(solved) + limit * (len(found) - len(solved))) / len(found)
            table[name, solver] = mean
            print(f"{name:24} {solver:13} {len(solved):2}/10 mean {mean:7.1f} most {max(solved, default=0)}")
    for name in programs:
        best = min(table[name, solver] for solver in SINGLE)
        assert table[name, "portfolio"] <= 2 * best + 128, name
