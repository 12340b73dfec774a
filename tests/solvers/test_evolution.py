import math
import subprocess
import sys
import warnings

import numpy as np
import pytest

from proc3s import Trial, Violation
from proc3s.testing.solvers import chain, samples, search, solution, toy
from proc3s_solvers.batches import furthest


def failed(reached, *margins):
    violations = tuple(Violation("fits", reached, "go", margin, "") for margin in margins)
    return Trial((), violations, reached)


def ball(dim, radius):
    return toy(lambda p: [radius - float(np.linalg.norm(p - 0.37))], [0] * dim)


def test_the_step_counts_first_then_the_worst_violation():
    ordered = [
        Trial(error=ValueError("no plan")),
        failed(0, -math.inf),
        failed(0, -5.0),
        failed(0, -0.1, -4.0),
        failed(0, -0.1),
        failed(1, -math.inf),
        failed(1, -2.0),
        failed(3, -7.0),
    ]
    scores = [trial.progress for trial in ordered]
    assert scores == sorted(scores)
    assert len(set(scores)) >= len(scores) - 1
    assert furthest(ordered) is ordered[-1]


def test_equal_trials_are_taken_in_order():
    first, second = failed(1, -2.0), failed(1, -2.0)
    assert furthest([first, second]) is first


@pytest.mark.parametrize(("dim", "radius"), [(1, 0.001), (2, 0.02), (4, 0.12)])
@pytest.mark.parametrize("seed", range(3))
def test_margins_lead_to_small_targets(solvers, dim, radius, seed):
    """Uniform draws need 500 to 1,000 samples on average."""
    assert solution(solvers("cma"), ball(dim, radius), 300, seed) is not None


def test_a_target_in_a_corner(solvers):
    corner = toy(lambda p: [0.01 - p.max()], [0, 0, 0])
    assert solution(solvers("cma"), corner, 500) is not None


@pytest.mark.parametrize("seed", range(3))
def test_margins_that_lead_astray_are_overcome_by_uniform_draws(solvers, seed):
    astray = toy(lambda p: [1.0 if p[0] > 0.98 else -0.1 - p[0]], [0])
    assert solution(solvers("cma"), astray, 3000, seed) is not None


@pytest.mark.parametrize("share", [0.25, 0.5])
def test_the_uniform_share(solvers, share):
    """The strategy settles below 0.1; what lies above 0.5 is half of the uniform draws."""
    astray = toy(lambda p: [-0.1 - p.sum()], [0, 0])
    u = samples(solvers("cma", uniform=share, patience=1000, first=8), astray.space, astray, 2000)
    assert (u[500:, 0] > 0.5).mean() == pytest.approx(share / 2, abs=0.04)


def test_it_starts_anew_when_stuck(solvers):
    """On a flat problem no run makes progress; every run begins somewhere else."""
    flat = toy(lambda p: [-1.0], [0, 0])
    u = samples(solvers("cma", uniform=0.01, sigma=0.01), flat.space, flat, 2000)
    starts = {tuple(row) for row in u.round(1)}
    assert len(starts) > 5


def test_it_prints_nothing_and_warns_of_nothing(solvers, capfd):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        problem = chain(3, 0.01)
        assert list(search(solvers("cma")(problem.space, 500, np.random.default_rng(0)), problem, 500))
    assert capfd.readouterr() == ("", "")


def test_the_library_is_imported_when_used():
    code = "import sys, proc3s_solvers, proc3s_solvers.portfolio as p; sys.exit('cma' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0
