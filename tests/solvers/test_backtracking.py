from dataclasses import replace
from itertools import cycle

import numpy as np
import pytest

from proc3s import Space
from proc3s.domain.samplers import ContinuousSampler
from proc3s.testing.solvers import blocked, chain, check_batch, hopeless, lock, samples, solution, toy


def spread(u):
    """How many different values every parameter takes."""
    return [len(np.unique(column)) for column in u.T]


def discs(count=5, radius=0.16):
    """Discs put into the unit square one by one; some prefixes leave no room for the next."""

    def margins(p):
        centres = radius + p.reshape(count, 2) * (1 - 2 * radius)
        gaps = np.linalg.norm(centres[:, None] - centres[None], axis=2) - 2 * radius
        return [min(gaps[i, :i], default=1.0) for i in range(count)]

    return toy(margins, np.repeat(np.arange(count), 2).tolist())


def test_what_comes_in_before_the_failing_step_is_kept(solvers):
    problem = chain(6, 0.3)
    solver = solvers("backtracking")(problem.space, 1000, np.random.default_rng(0))
    fresh = solver.ask(1000)
    trials = [problem(row, i) for i, row in enumerate(fresh)]
    solver.tell(trials)
    reached = max(trial.reached for trial in trials)
    assert 0 < reached < 6
    children = solver.ask(1000)
    assert spread(children) == [1] * reached + [len(children)] * (6 - reached)
    assert any((children[0, :reached] == trial.u[:reached]).all() for trial in trials)


def test_of_equal_prefixes_the_one_with_the_smaller_violation_goes_on(solvers):
    problem = toy(lambda p: [1.0, -1.0 - p[0]], [0, 1])
    solver = solvers("backtracking")(problem.space, 1000, np.random.default_rng(0))
    fresh = solver.ask(1000)
    solver.tell([problem(row, 0) for row in fresh])
    assert (solver.ask(1000)[:, 0] == fresh[:, 0].min()).all()


@pytest.mark.parametrize("seed", range(10))
def test_a_chain_is_solved_link_by_link(solvers, seed):
    """Uniform draws need 10^10 samples on average."""
    assert solution(solvers("backtracking"), chain(10, 0.1), 1000, seed) is not None


@pytest.mark.parametrize("seed", range(3))
def test_a_combination_is_found_digit_by_digit(solvers, seed):
    assert solution(solvers("backtracking"), lock(6, 6), 1000, seed) is not None


@pytest.mark.parametrize("seed", range(5))
def test_dead_ends_are_left(solvers, seed):
    assert solution(solvers("backtracking"), discs(), 2000, seed) is not None


def test_an_early_parameter_with_a_late_effect_is_drawn_again(solvers):
    """The influence says step 0; the step that it decides is the last."""
    problem = toy(lambda p: [1.0, *(0.5 - p[1:]), 0.1 - abs(p[0] - 0.7)], range(5))
    assert solution(solvers("backtracking"), problem, 3000) is not None


def test_everything_is_drawn_again_in_the_end(solvers):
    problem = toy(lambda p: [*(0.9 - p), -1.0], range(8))
    u = samples(solvers("backtracking"), problem.space, problem, 3000)
    assert min(spread(u)) > 200


def test_an_influence_that_is_wrong_costs_samples_only(solvers):
    """Every step needs the parameter that is said to come in last."""
    problem = chain(4, 0.4)
    wrong = replace(problem, space=Space(problem.space.samplers, lambda: {f"p{i}": 3 - i for i in range(4)}))
    assert solution(solvers("backtracking"), wrong, 5000) is not None


@pytest.mark.parametrize("problem", [toy(lambda p: [1, -p.sum()], [0, 0, 0]), hopeless(3)])
def test_where_everything_matters_from_the_first_step_it_is_rejection(solvers, problem):
    u = samples(solvers("backtracking"), problem.space, problem, 500)
    assert np.array_equal(u, np.random.default_rng(0).random((500, 3)))


def test_a_parameter_that_changes_nothing_is_drawn_with_the_others(solvers):
    problem = toy(lambda p: [1.0, -1.0], [0, 1, np.iinfo(np.int64).max])
    solver = solvers("backtracking")(problem.space, 200, np.random.default_rng(0))
    solver.tell([problem(row, 0) for row in solver.ask(200)])
    children = solver.ask(200)
    assert spread(children) == [1, len(children), len(children)]


def test_a_plan_whose_first_steps_are_fixed(solvers):
    problem = toy(lambda p: [1.0, 1.0, *(0.1 - np.abs(p - 0.5))], [2, 3, 4])
    assert solution(solvers("backtracking"), problem, 500) is not None
    never = toy(lambda p: [-1.0, *p], [1, 2])
    assert samples(solvers("backtracking"), never.space, never, 200).shape == (200, 2)


def test_the_program_is_not_probed_for_an_easy_problem(solvers):
    def probe():
        raise AssertionError("probed")

    problem = toy(lambda p: [p[0], 0.5 - p[1]], [0, 1])
    easy = replace(problem, space=Space(problem.space.samplers, probe))
    assert solution(solvers("backtracking"), easy, 1000) is not None


def test_a_sampler_may_take_several_dimensions(solvers):
    class Square(ContinuousSampler):
        dim = 2

    space = Space({"a": Square(0, 1), "b": ContinuousSampler(0, 1)}, lambda: {"a": 0, "b": 1})
    problem = replace(toy(lambda p: [1.0, -1.0], [0, 1]), space=space)
    solver = solvers("backtracking")(space, 100, np.random.default_rng(0))
    solver.tell([problem(row, 0) for row in solver.ask(100)])
    children = solver.ask(100)
    assert spread(children) == [1, 1, len(children)]


@pytest.mark.parametrize("name", ["backtracking", "cma", "portfolio"])
def test_a_limit_that_cuts_a_batch_does_not_change_the_samples(solvers, name):
    problem = blocked()
    whole = samples(solvers(name), problem.space, problem, 600)
    solver = solvers(name)(problem.space, 600, np.random.default_rng(0))
    pieces = np.empty((0, problem.space.dim))
    for limit in cycle([1, 7, 30]):
        if len(pieces) >= len(whole):
            break
        u = solver.ask(limit)
        check_batch(u, limit)
        solver.tell([problem(row, 0) for row in u])
        pieces = np.vstack([pieces, u])
    assert np.array_equal(pieces[: len(whole)], whole)
