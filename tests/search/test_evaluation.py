import numpy as np
import pytest

import toy_world
from proc3s import Action, Space, rollout
from proc3s.domain.samplers import ContinuousSampler
from proc3s.domain.world import make_world
from proc3s.sandbox import SketchRuntimeError, SketchTimeout
from proc3s.search.evaluator import Evaluator
from proc3s.search.search import Search


class Counting:
    """A serial executor that remembers which plans it was asked for."""

    def __init__(self):
        self.asked = []

    def map(self, problem, plans):
        world = make_world(problem.domain)
        for plan in plans:
            self.asked.append(plan)
            yield rollout(world, problem, plan)

    def close(self):
        pass


class Slides:
    """A sketch that slides the first bead by what its table says for round(100 u)."""

    def __init__(self, problem, moves, errors=(), dim=1):
        self.space = Space({f"p{i}": ContinuousSampler(0, 1) for i in range(dim)})
        self._signatures = problem.domain.signatures(problem.initial)
        self._moves, self._errors = moves, dict(errors)
        self.asked = 0

    def plans(self, u, first):
        moves = self._moves[self.asked : self.asked + len(u)]
        errors = {i - self.asked: e for i, e in self._errors.items() if 0 <= i - self.asked < len(moves)}
        self.asked += len(u)
        plans = [None if i in errors else [("slide", "object_0", by)] for i, by in enumerate(moves)]
        batch = toy_world.columns(self._signatures, plans, errors)
        if len(moves) < len(u):
            raise SketchTimeout("took too long", 3, "while True:", done=batch)
        return batch


@pytest.fixture
def problem(tmp_path):
    return toy_world.problem(tmp_path)


@pytest.fixture
def evaluate(problem):
    def make(moves, errors=(), dim=1):
        sketch, executor = Slides(problem, moves, errors, dim), Counting()
        return Evaluator(problem, sketch, executor), executor

    return make


class Uniform:
    def __init__(self, size):
        self._size = size
        self.told = []

    def ask(self, limit):
        return np.full((min(self._size, limit), 1), 0.5)

    def tell(self, trials):
        self.told.append(len(trials))


def places(executor):
    return [plan[0].args[1] for plan in executor.asked]


def test_trials_come_in_order_with_their_samples(evaluate):
    evaluator, _ = evaluate([20.0, 3.0, 30.0])
    u = np.array([[0.1], [0.2], [0.3]])
    trials = list(evaluator.stream(u))
    assert [t.accepted for t in trials] == [False, True, False]
    assert [t.index for t in trials] == [0, 1, 2]
    assert [t.u for t in trials] == [(0.1,), (0.2,), (0.3,)]
    assert trials[1].plan == (Action("slide", ("object_0", 3.0)),)


def test_indices_run_on_over_batches(evaluate):
    evaluator, _ = evaluate([20.0] * 5)
    list(evaluator.stream(np.zeros((3, 1))))
    assert [t.index for t in evaluator.stream(np.zeros((2, 1)))] == [3, 4]
    assert evaluator.samples == 5


def test_equal_plans_are_rolled_out_once_over_all_batches(evaluate):
    evaluator, executor = evaluate([20.0, 30.0, 20.0, 30.0, 20.0, 40.0])
    trials = [*evaluator.stream(np.zeros((3, 1))), *evaluator.stream(np.zeros((3, 1)))]
    assert places(executor) == [20.0, 30.0, 40.0]
    assert (evaluator.samples, evaluator.evaluations) == (6, 3)
    assert trials[0].violations == trials[2].violations == trials[4].violations
    assert [t.index for t in trials] == [0, 1, 2, 3, 4, 5]


def test_nothing_behind_what_was_taken_is_rolled_out(evaluate):
    evaluator, executor = evaluate([20.0, 30.0, 1.0, 40.0, 50.0])
    for trial in evaluator.stream(np.zeros((5, 1))):
        if trial.accepted:
            break
    assert places(executor) == [20.0, 30.0, 1.0]
    assert (evaluator.samples, evaluator.evaluations) == (3, 3)


def test_a_sample_that_failed_is_a_trial_with_its_error(evaluate):
    error = SketchRuntimeError("division by zero", 2, "1 / 0")
    evaluator, executor = evaluate([20.0, 0.0, 1.0], {1: error})
    trials = list(evaluator.stream(np.zeros((3, 1))))
    assert trials[1].error is error
    assert (trials[1].plan, trials[1].accepted) == (None, False)
    assert trials[2].accepted
    assert len(executor.asked) == 2


def test_a_halted_program_leaves_its_finished_samples(evaluate):
    evaluator, _ = evaluate([20.0, 30.0])
    stream = evaluator.stream(np.zeros((8, 1)))
    found = [next(stream), next(stream)]
    with pytest.raises(SketchTimeout):
        next(stream)
    assert [t.reached for t in found] == [0, 0]
    assert evaluator.samples == 2


def test_a_solution_before_the_halt_counts(evaluate):
    evaluator, _ = evaluate([20.0, 1.0])
    found = Search(Space({"p": ContinuousSampler(0, 1)}), Uniform(8), evaluator)
    found.advance(8)
    assert found.halted is None
    assert found.solution.index == 1


def test_a_halt_ends_the_search_with_what_was_done(evaluate):
    evaluator, _ = evaluate([20.0] * 10)
    reported = []
    found = Search(Space({"p": ContinuousSampler(0, 1)}), Uniform(8), evaluator, reported.append)
    found.advance(100)
    assert found.solution is None
    assert found.halted.line == 3
    assert [len(batch) for batch in reported] == [8, 2]
    assert len(found.trials) == 10


def test_the_budget_is_never_passed(evaluate):
    evaluator, _ = evaluate([20.0] * 30)
    solver = Uniform(8)
    found = Search(Space({"p": ContinuousSampler(0, 1)}), solver, evaluator)
    found.advance(20)
    assert solver.told == [8, 8, 4]
    assert len(found.trials) == evaluator.samples == 20


def test_a_solver_that_gives_up_ends_the_search(evaluate):
    evaluator, _ = evaluate([20.0] * 30)
    found = Search(Space({"p": ContinuousSampler(0, 1)}), Uniform(0), evaluator)
    found.advance(20)
    assert found.trials == []


def test_a_problem_without_parameters_is_evaluated_once(evaluate):
    evaluator, _ = evaluate([20.0] * 3, dim=0)
    found = Search(Space({}), Uniform(8), evaluator)
    found.advance(100)
    assert len(found.trials) == 1


def test_an_iterator_that_is_closed_closes_the_executor(problem):
    closed = []

    class Watched(Counting):
        def map(self, problem, plans):
            try:
                yield from super().map(problem, plans)
            finally:
                closed.append(True)

    stream = Evaluator(problem, Slides(problem, [20.0, 30.0]), Watched()).stream(np.zeros((2, 1)))
    next(stream)
    stream.close()
    assert closed == [True]
