"""Several searches share a budget by successive halving."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from proc3s import Action, Space, Trial
from proc3s.domain.margins import Violation
from proc3s.domain.samplers import ContinuousSampler
from proc3s.search.race import race
from proc3s.search.search import Search

SPACE = Space({"p": ContinuousSampler(0, 1)})


class Uniform:
    def __init__(self):
        self.told = 0

    def ask(self, limit):
        return np.zeros((min(limit, 7), 1))

    def tell(self, trials):
        self.told += len(trials)


class Steps:
    """An evaluator: every sample reaches so many steps; the one of number `solved` is accepted."""

    def __init__(self, reached, solved=math.inf):
        self.reached, self.solved, self.count = reached, solved, 0

    def stream(self, u):
        for _ in u:
            self.count += 1
            bad = (Violation("c", self.reached, "s", -1.0, "bad"),) if self.count != self.solved else ()
            yield Trial(plan=(Action("s", ()),), violations=bad, reached=self.reached)


def searches(*evaluators):
    return [Search(SPACE, Uniform(), evaluator) for evaluator in evaluators]


def test_one_alone_gets_everything():
    (search,) = searches(Steps(1))
    race([search], 100)
    assert len(search.trials) == 100


def test_the_better_half_goes_on():
    entrants = searches(*map(Steps, [3, 1, 4, 2]))
    race(entrants, 1200)
    spent = [len(search.trials) for search in entrants]
    assert spent == [300, 100, 700, 100]


def test_equals_go_on_in_order():
    entrants = searches(Steps(1), Steps(1))
    race(entrants, 100)
    assert [len(search.trials) for search in entrants] == [75, 25]


def test_a_solution_stops_its_siblings():
    entrants = searches(Steps(1), Steps(1, solved=3), Steps(9))
    race(entrants, 900)
    assert entrants[1].solution
    assert len(entrants[2].trials) == 0


def test_what_a_search_leaves_goes_to_the_others():
    entrants = [Search(Space({}), Uniform(), Steps(9)), *searches(Steps(1))]
    race(entrants, 100)
    assert [len(search.trials) for search in entrants] == [1, 99]


def test_nobody_and_nothing():
    race([], 100)
    entrants = searches(Steps(1), Steps(1))
    race(entrants, 0)
    assert [len(search.trials) for search in entrants] == [0, 0]


@settings(deadline=None)
@given(st.lists(st.integers(0, 5), min_size=1, max_size=9), st.integers(0, 3000))
def test_the_budget_is_spent_and_not_passed(reached, budget):
    entrants = searches(*map(Steps, reached))
    race(entrants, budget)
    spent = [len(search.trials) for search in entrants]
    assert sum(spent) <= budget
    assert sum(spent) >= budget - len(reached) ** 2
    assert max(spent) == spent[reached.index(max(reached))] or budget < 4 * len(reached) ** 2


@pytest.mark.parametrize("pieces", [[100], [30, 70], [1] * 100])
def test_a_search_in_pieces_is_the_same_search(pieces):
    (search,) = searches(Steps(1))
    for piece in pieces:
        search.advance(piece)
    assert len(search.trials) == 100


class GivesUp(Uniform):
    """Asks a hundred samples and no more."""

    asked = 0

    def ask(self, limit):
        self.asked += min(limit, 7)
        return np.zeros((min(limit, 7) if self.asked <= 105 else 0, 1))


def test_when_the_leaders_give_up_the_others_go_on():
    leaders = [Search(SPACE, GivesUp(), Steps(9)) for _ in range(2)]
    entrants = [*leaders, *searches(Steps(1), Steps(2))]
    race(entrants, 1000)
    assert sum(len(search.trials) for search in entrants) == 1000
