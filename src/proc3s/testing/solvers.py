"""Conformance kit of solvers: inherit `SolverTests`, give it a `make_solver` fixture, and run pytest."""

import random
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pytest

from proc3s import Action, FloatArray, Solver, Space, Trial, Violation
from proc3s.domain.samplers import ContinuousSampler, DiscreteSampler

MakeSolver: TypeAlias = Callable[[Space, int, np.random.Generator], Solver]
TrialOf: TypeAlias = Callable[[FloatArray, int], Trial]
"""The trial of one point u of the cube, shape (dim,), with the index of the sample."""


@dataclass(frozen=True)
class Toy:
    """A small CCSP without program or world: decoded values to the margin of every step of a plan.

    Where `margins` raises ValueError, the sample has no plan.
    """

    space: Space
    margins: Callable[[FloatArray], Sequence[float]]

    def __call__(self, u: FloatArray, index: int) -> Trial:
        """The trial of a point u, shape (dim,): it ends at the first step with a negative margin."""
        point = tuple(u.tolist())
        try:
            margins = [float(margin) for margin in self.margins(self.space.decode(u[None])[0])]
        except ValueError as error:
            return Trial(error=error, index=index, u=point)
        plan = tuple(Action("go", (step, *point)) for step in range(len(margins)))
        bad = [step for step, margin in enumerate(margins) if margin < 0]
        found = tuple(Violation("fits", step, "go", margins[step], "does not fit") for step in bad[:1])
        reached = bad[0] if bad else len(margins)
        told = tuple({"fits": margin} for margin in margins[: reached + 1])
        return Trial(plan, found, reached, told, index=index, u=point)


def toy(margins: Callable[[FloatArray], Sequence[float]], starts: Sequence[int], choices: int = 0) -> Toy:
    """A toy with one parameter for each of `starts`, the first step that it changes: 0 to 1, or an index."""
    one = DiscreteSampler(list(range(choices))) if choices else ContinuousSampler(0, 1)
    names = {f"p{i}": start for i, start in enumerate(starts)}
    return Toy(Space(dict.fromkeys(names, one), lambda: names), margins)


def box(dim: int = 3) -> Toy:
    """All parameters in the lower 40 % of their range, in one step."""
    return toy(lambda p: [0.4 - p.max()], [0] * dim)


def disc() -> Toy:
    """A disc off the centre that covers 5 % of the square."""
    return toy(lambda p: [0.126 - float(np.hypot(p[0] - 0.3, p[1] - 0.65))], [0, 0])


def chain(links: int = 3, width: float = 0.3) -> Toy:
    """Every step has a parameter of its own, which must lie in an interval of this width."""
    return toy(lambda p: (width / 2 - np.abs(p - 0.6)).tolist(), range(links))


def blocked(links: int = 10) -> Toy:
    """A chain whose last step never fits, though one sample is less bad than another."""
    return toy(lambda p: [*(0.15 - np.abs(p - 0.6)), -0.1 - p.sum()], range(links))


def lock(digits: int = 2, choices: int = 6) -> Toy:
    """A combination of digits; margins say right or wrong, nothing else."""
    return toy(lambda p: [1.0 if value == 1 else -1.0 for value in p], range(digits), choices)


def minefield() -> Toy:
    """Nine samples of ten raise; a fifth of the others is accepted."""

    def margins(p: FloatArray) -> list[float]:
        if p[0] > 0.1:
            raise ValueError("the program failed")
        return [0.2 - p[1]]

    return toy(margins, [0, 0])


def hopeless(dim: int) -> Toy:
    """No sample has a plan."""

    def margins(p: FloatArray) -> list[float]:
        raise ValueError("the program failed")

    return toy(margins, [0] * dim)


def search(solver: Solver, verdict: TrialOf, budget: int) -> Iterator[Trial]:
    """The trials of a search, up to the first accepted one; checks every batch that the solver asks for."""
    taken = 0
    while taken < budget:
        u = solver.ask(budget - taken)
        if not len(u):
            return
        check_batch(u, budget - taken)
        batch: list[Trial] = []
        for row in u:
            batch.append(verdict(row, taken + len(batch)))
            yield batch[-1]
            if batch[-1].accepted:
                break
        taken += len(batch)
        solver.tell(batch)
        if batch[-1].accepted:
            return


def check_batch(u: FloatArray, limit: int) -> None:
    """A batch is a float64 matrix of at most `limit` points of [0, 1). Raises AssertionError."""
    assert u.ndim == 2, f"ask must return a matrix of shape (k, dim), not shape {u.shape}"
    assert u.dtype == np.float64, f"ask must return float64, not {u.dtype}"
    assert len(u) <= limit, f"ask({limit}) returned {len(u)} samples"
    assert ((u >= 0) & (u < 1)).all(), "samples must lie in [0, 1)"


def solution(make_solver: MakeSolver, problem: Toy, budget: int, seed: int = 0) -> Trial | None:
    """The accepted trial of a search, or None."""
    solver = make_solver(problem.space, budget, np.random.default_rng(seed))
    return next((trial for trial in search(solver, problem, budget) if trial.accepted), None)


def samples(
    make_solver: MakeSolver, space: Space, verdict: TrialOf, budget: int, seed: int = 0
) -> FloatArray:
    """Everything that a search tries, shape (n, dim)."""
    solver = make_solver(space, budget, np.random.default_rng(seed))
    tried = [trial.u for trial in search(solver, verdict, budget)]
    return np.array(tried).reshape(len(tried), space.dim)


class SolverTests:
    """What the planner relies on. A third party's solver inherits it:

    class TestMine(SolverTests):
        @pytest.fixture
        def make_solver(self):
            return lambda space, budget, rng: Mine(space, budget, rng, MyOptions())
    """

    @pytest.fixture
    def make_solver(self) -> MakeSolver:
        """`callable(space, budget, rng) -> Solver`; a solver's tests override it."""
        raise NotImplementedError("give your tests a fixture make_solver: (space, budget, rng) -> Solver")

    @pytest.mark.parametrize("dim", [0, 1, 2, 7, 64])
    def test_samples_are_points_of_the_cube(self, make_solver: MakeSolver, dim: int) -> None:
        """Whatever the dimension, the whole budget is used."""
        problem = toy(lambda p: [1.0] * dim + [-1.0 - p.sum()], range(dim))
        assert samples(make_solver, problem.space, problem, 200).shape == (200, dim)

    @pytest.mark.parametrize("limit", [1, 2, 5])
    def test_a_limit_holds_whatever_the_batch_would_be(self, make_solver: MakeSolver, limit: int) -> None:
        """Also one that is smaller than the budget was."""
        problem = blocked()
        solver = make_solver(problem.space, 1000, np.random.default_rng(0))
        for _ in range(100):
            u = solver.ask(limit)
            assert len(u) >= 1
            check_batch(u, limit)
            solver.tell([problem(row, 0) for row in u])

    def test_a_budget_of_one_sample(self, make_solver: MakeSolver) -> None:
        """One sample is drawn."""
        assert samples(make_solver, box().space, hopeless(3), 1).shape == (1, 3)

    def test_the_generator_decides(self, make_solver: MakeSolver) -> None:
        """Equal generators give equal samples, others give others."""
        problem = blocked()
        one, same, other = (samples(make_solver, problem.space, problem, 300, seed) for seed in (3, 3, 4))
        assert np.array_equal(one, same)
        assert not np.array_equal(one, other)

    def test_what_a_trial_carries_besides_its_verdict_changes_nothing(self, make_solver: MakeSolver) -> None:
        """Indices run on in a portfolio, and what a screen rejects has neither plan nor margins."""
        problem = blocked()

        def screened(u: FloatArray, index: int) -> Trial:
            trial = problem(u, 1000 + 7 * index)
            assert not trial.accepted
            return replace(trial, plan=None, margins=())

        plain, other = (samples(make_solver, problem.space, told, 300) for told in (problem, screened))
        assert np.array_equal(plain, other)

    @pytest.mark.parametrize(
        "problem", [box(), disc(), chain(), lock(), minefield(), box(1)],
        ids=["box", "disc", "chain", "lock", "minefield", "line"],
    )  # fmt: skip
    @pytest.mark.parametrize("seed", [0, 1])
    def test_easy_problems_are_solved(self, make_solver: MakeSolver, problem: Toy, seed: int) -> None:
        """Each has at least one solution in a hundred uniform draws; 3,000 are allowed."""
        assert solution(make_solver, problem, 3000, seed) is not None

    @pytest.mark.parametrize("dim", [1, 3])
    def test_samples_that_raise_do_not_end_the_search(self, make_solver: MakeSolver, dim: int) -> None:
        """A program may fail on all samples; they are drawn nevertheless, and not the same again."""
        u = samples(make_solver, hopeless(dim).space, hopeless(dim), 300)
        assert len(u) == 300
        assert len(np.unique(u, axis=0)) > 100

    def test_infinite_margins_do_not_end_the_search(self, make_solver: MakeSolver) -> None:
        """A constraint may say -inf."""
        problem = toy(lambda p: [1.0, -np.inf], [0, 1])
        assert len(samples(make_solver, problem.space, problem, 300)) == 300

    def test_a_search_may_be_stopped_within_a_batch(self, make_solver: MakeSolver) -> None:
        """`tell` then gets fewer trials than were asked for, or none."""
        for told in (0, 1):
            solver = make_solver(box().space, 100, np.random.default_rng(0))
            u = solver.ask(100)
            solver.tell([box()(row, 0) for row in u[:told]])

    def test_nothing_global_is_touched(
        self, make_solver: MakeSolver, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """Neither the global generators, nor the folder in which it runs."""
        monkeypatch.chdir(tmp_path)
        problem = blocked()
        before = (random.getstate(), repr(np.random.get_state()))
        first = samples(make_solver, problem.space, problem, 300)
        assert (random.getstate(), repr(np.random.get_state())) == before
        random.seed(1)
        np.random.seed(1)
        assert np.array_equal(samples(make_solver, problem.space, problem, 300), first)
        assert not list(tmp_path.iterdir())
