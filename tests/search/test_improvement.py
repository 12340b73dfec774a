"""Samples around an accepted plan are tried for one with more room."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from proc3s import Action, Trial
from proc3s.domain.room import Room
from proc3s.domain.samplers import ContinuousSampler, Space
from proc3s.search.evaluator import Evaluator
from proc3s.search.improvement import ENOUGH, Improvement, improve, room_value
from proc3s.specs.domain import ErrorsSpec
from proc3s_solvers.roomier import Roomier, RoomierOptions

from .conftest import HOPS, Walks

START = (5.9, 7.0, 6.0, 0.5, 0.5)
"""A tenth of a metre before the first pit, then over it."""


@pytest.fixture
def narrow(problem):
    """A problem in which a metre is what is to be expected."""
    made = problem()
    spec = made.domain.spec.model_copy(update={"errors": ErrorsSpec(picked=0.0, placed=1.0)})
    return dataclasses.replace(made, domain=dataclasses.replace(made.domain, spec=spec))


def improved(problem, executor, samples=60, seed=0, start=START):
    evaluator = Evaluator(problem, Walks(problem), executor)
    (first,) = evaluator.stream(np.array([start]) / 30)
    assert first.accepted
    found = Improvement(first)
    space = evaluator.sketch.space
    solver = Roomier(space, samples, np.random.default_rng(seed), RoomierOptions())
    improve(found, problem.domain, space, solver, samples, evaluator.stream)
    return found


def test_there_is_more_room_around_an_accepted_plan(narrow, serial):
    found = improved(narrow, serial)
    assert room_value(found.start) == pytest.approx(0.1)
    assert found.most > 0.5
    assert found.better[0].accepted
    assert [*map(room_value, found.better)] == sorted(map(room_value, found.better), reverse=True)


def test_no_more_samples_are_tried_than_wanted(narrow, serial):
    assert len(improved(narrow, serial, samples=7).trials) == 7


def test_it_ends_where_there_is_room_enough(narrow, serial):
    spec = narrow.domain.spec.model_copy(update={"errors": ErrorsSpec(picked=0.0, placed=0.1)})
    easy = dataclasses.replace(narrow, domain=dataclasses.replace(narrow.domain, spec=spec))
    found = improved(easy, serial)
    assert found.most >= ENOUGH
    assert len(found.trials) < 60


@pytest.mark.parametrize("seed", range(3))
def test_it_is_the_same_with_any_number_of_workers(narrow, serial, two, seed):
    one, other = (improved(narrow, executor, samples=24, seed=seed) for executor in (serial, two))
    assert one.trials == other.trials


def test_a_solver_that_gives_up_ends_it(narrow, serial):
    class Tired:
        def tell(self, trials):
            self.told = list(trials)

        def ask(self, limit):
            return np.empty((0, HOPS))

    found, solver = Improvement(improved(narrow, serial, samples=1).start), Tired()
    improve(found, narrow.domain, Walks(narrow).space, solver, 10, lambda u: iter(()))
    (told,) = solver.told
    assert (told.u, told.room) == (found.start.u, found.start.room)
    assert min(told.left.values()) == pytest.approx(told.room.value)
    assert found.trials == []


def test_what_no_parameter_changes_costs_two_looks_along_each(narrow, serial):
    """The room of a plan that every sample has."""

    class Stuck(Walks):
        def plans(self, u, first):
            return super().plans(np.tile(np.array(START) / 30, (len(u), 1)), first)

    evaluator = Evaluator(narrow, Stuck(narrow), serial)
    (start,) = evaluator.stream(np.array([START]) / 30)
    found, space = Improvement(start), evaluator.sketch.space
    solver = Roomier(space, 24, np.random.default_rng(0), RoomierOptions())
    improve(found, narrow.domain, space, solver, 24, evaluator.stream)
    assert len(found.trials) == 2 * HOPS
    assert found.better == []


@given(st.lists(st.floats(0.02, 0.98), min_size=1, max_size=5))
@settings(deadline=None)
def test_linear_margins_are_balanced_wherever_it_begins(start):
    """Every margin is the distance of a parameter to one bound of its range: the most is half the range."""
    space = Space({f"x{k}": ContinuousSampler(0, 1) for k in range(len(start))})
    solver = Roomier(space, 60, np.random.default_rng(0), RoomierOptions(aim=10.0))
    best = trial = boxed(start)
    solver.tell([trial])
    for _ in range(40):
        trials = [boxed(u) for u in solver.ask(60)]
        best = max([best, *trials], key=room_value)
        solver.tell(trials)
    assert room_value(best) >= room_value(trial)
    assert room_value(best) == pytest.approx(5.0, abs=0.05)


def boxed(u):
    """A trial whose margins, in tenths, are the distances of u to the faces of the cube."""
    faces = {(k, side): 10 * abs(x - (side == "high")) for k, x in enumerate(u) for side in ("low", "high")}
    (step, side), least = min(faces.items(), key=lambda item: item[1])
    return Trial((Action("stand", ()),), u=tuple(u), room=Room(least, side, step, least), left=faces)
