from statistics import NormalDist

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from proc3s import SolverSpec, Space
from proc3s.domain.samplers import ContinuousSampler
from proc3s.plugins.registry import open_registry


def solver(name, dim=3, budget=1000, seed=0, **options):
    import importlib

    spec = open_registry().get(SolverSpec, name)
    module, _, model = spec.options.partition(":")
    options = getattr(importlib.import_module(module), model)(**options)
    space = Space({f"p{i}": ContinuousSampler(0, 1) for i in range(dim)})
    return spec.load()(space, budget, np.random.default_rng(seed), options)


def draw(made, total, told=()):
    """All samples until the budget is spent or the solver gives up."""
    batches, left = [], total
    while left:
        batch = made.ask(left)
        if not len(batch):
            break
        assert len(batch) <= left
        made.tell(told)
        batches.append(batch)
        left -= len(batch)
    return np.vstack(batches)


NAMES = pytest.mark.parametrize("name", ["rejection", "gaussian"])


@NAMES
@settings(max_examples=20, deadline=None)
@given(first=st.integers(1, 300), largest=st.integers(1, 300), budget=st.integers(1, 400))
@pytest.mark.slow
def test_the_size_of_batches_never_changes_which_samples_are_drawn(name, first, largest, budget):
    plain = draw(solver(name, budget=budget), budget)
    other = draw(solver(name, budget=budget, first=first, largest=largest), budget)
    assert plain.shape == (budget, 3)
    assert np.array_equal(plain, other)


@NAMES
def test_batches_double_from_the_first_to_the_largest(name):
    made = solver(name, budget=100, first=3, largest=10)
    assert [len(made.ask(100)) for _ in range(4)] == [3, 6, 10, 10]


@NAMES
def test_samples_lie_in_the_unit_cube(name):
    u = draw(solver(name, budget=5000), 5000)
    assert ((u >= 0) & (u <= 1)).all()


@NAMES
def test_seeds_decide(name):
    assert np.array_equal(draw(solver(name, seed=4), 50), draw(solver(name, seed=4), 50))
    assert not np.array_equal(draw(solver(name, seed=4), 50), draw(solver(name, seed=5), 50))


@NAMES
def test_options_are_checked(name):
    for bad in ({"first": 0}, {"largest": -1}, {"firts": 3}):
        with pytest.raises(ValueError, match=r"first|largest|firts"):
            solver(name, **bad)


def test_rejection_draws_uniformly():
    u = draw(solver("rejection", budget=8000), 8000)
    counts, _ = np.histogramdd(u, bins=2, range=[(0, 1)] * 3)
    assert np.abs(counts / 8000 - 1 / 8).max() < 0.015


def test_gaussian_begins_with_no_noise_at_all():
    assert (solver("gaussian").ask(10)[0] == 0.5).all()


@pytest.mark.parametrize("budget", [1, 2, 3])
def test_gaussian_with_a_small_budget(budget):
    u = draw(solver("gaussian", budget=budget), budget)
    assert len(u) == budget
    assert (u[0] == 0.5).all()


def test_the_deviation_of_gaussian_grows_linearly_to_one():
    budget = 20000
    u = draw(solver("gaussian", dim=1, budget=budget), budget).ravel()
    z = np.array([NormalDist().inv_cdf(v) for v in np.clip(u, 1e-15, 1 - 1e-15)])
    expected = np.linspace(0, 1, budget)
    for k in range(10):
        part = slice(k * budget // 10, (k + 1) * budget // 10)
        assert np.sqrt((z[part] ** 2).mean()) == pytest.approx(
            np.sqrt((expected[part] ** 2).mean()), rel=0.08
        )


def test_gaussian_gives_up_when_its_budget_is_spent():
    made = solver("gaussian", budget=5)
    assert len(draw(made, 50)) == 5
    assert len(made.ask(10)) == 0
