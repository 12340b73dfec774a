"""Conformance kit of executors: inherit `ExecutorTests`, give it a `make_executor`, and run pytest."""

import dataclasses
import itertools
from collections.abc import Callable, Iterator
from typing import TypeAlias

import pytest

from proc3s import Executor, Plan, Problem, Rollouts, Trial
from proc3s.checks.subject import Subject
from proc3s.plugins.registry import open_registry

Work: TypeAlias = tuple[Problem, list[Plan], list[Trial]]

COUNT = 24
"""Plans that are tried."""


class ExecutorTests:
    """An executor gives the trials that one world gives. Override the fixtures `make_executor`, a callable
    without arguments, and `domain_name`, an installed domain with bundled programs."""

    @pytest.fixture
    def work(self, domain_name: str) -> Work:
        """A problem, plans of a bundled program, and their trials in one world: good and bad ones."""
        for answer, batch in Subject(open_registry(), domain_name).batches:
            good = [i for i in range(len(batch)) if i not in batch.errors][:COUNT]
            plans = [batch.plan(i) for i in good]
            rollouts = Rollouts(answer.problem)
            trials = [rollouts(plan) for plan in plans]
            rollouts.close()
            if {trial.accepted for trial in trials} == {True, False}:
                return answer.problem, plans, trials
        pytest.fail("no bundled program of the domain has plans that are accepted and others that are not")

    @pytest.fixture
    def executor(self, make_executor: Callable[[], Executor]) -> Iterator[Executor]:
        """An executor that is closed after the test."""
        made = make_executor()
        yield made
        made.close()

    def test_trials_are_those_of_one_world_in_order(self, executor: Executor, work: Work) -> None:
        """Whoever computes them."""
        problem, plans, wanted = work
        assert list(executor.map(problem, plans)) == wanted

    def test_it_serves_one_problem_after_another(self, executor: Executor, work: Work) -> None:
        """Worlds of an earlier problem do not linger."""
        problem, plans, wanted = work
        judged = dataclasses.replace(problem, check_goal=not problem.check_goal)
        other = list(executor.map(judged, plans[:8]))
        assert list(executor.map(problem, plans[:8])) == wanted[:8]
        assert list(executor.map(judged, plans[:8])) == other

    def test_plans_are_taken_lazily_and_the_rest_is_cancelled(self, executor: Executor, work: Work) -> None:
        """An endless stream of plans gives its first trials."""
        problem, plans, wanted = work
        trials = executor.map(problem, itertools.cycle(plans))
        assert len(list(itertools.islice(trials, COUNT + 6))) == COUNT + 6
        trials.close()  # type: ignore[attr-defined]
        assert list(executor.map(problem, plans[:4])) == wanted[:4]

    def test_no_plans_give_no_trials(self, executor: Executor, work: Work) -> None:
        """And do not wait for any."""
        assert list(executor.map(work[0], [])) == []

    def test_it_may_be_closed_twice(self, make_executor: Callable[[], Executor]) -> None:
        """Also if it never worked."""
        made = make_executor()
        made.close()
        made.close()
