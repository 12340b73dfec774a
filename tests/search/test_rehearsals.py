"""With `robust` a plan must also pass when it is carried out with errors."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from proc3s import Action, Rollouts
from proc3s.plugins.loose_files import import_loose_file
from proc3s.search.evaluator import Evaluator
from proc3s.specs.base import Target

from .conftest import HOPS, Walks

SAFE = (Action("hop", (3.0,)),)
CLOSE = (Action("hop", (5.8,)),)
"""The pit begins at 6 m, and a hop may be half a metre off."""
FALLS = (Action("hop", (8.0,)),)


@pytest.fixture
def shaky(problem):
    """A problem in the shaky world."""
    import_loose_file(Path(__file__).with_name("shaky.py"))

    def make(**fields):
        made = problem(**fields)
        spec = made.domain.spec.model_copy(update={"world": Target(target="shaky:Shaky")})
        return dataclasses.replace(made, domain=dataclasses.replace(made.domain, spec=spec))

    return make


def verdicts(problem, *plans):
    rollouts = Rollouts(problem)
    try:
        return [rollouts(plan) for plan in plans]
    finally:
        rollouts.close()


def test_a_plan_must_pass_its_rehearsals(shaky):
    safe, close, falls = verdicts(shaky(robust=2), SAFE, CLOSE, FALLS)
    assert (safe.accepted, safe.rehearsals) == (True, 2)
    assert not close.accepted
    assert close.violations[0].constraint == "rehearsal"
    assert close.violations[0].text == "rehearsed: fell into pit 0"
    assert (close.violations[0].step, close.reached) == (0, 0)
    assert close.room
    assert (falls.violations[0].constraint, falls.rehearsals) == ("no_pit", 0)


def test_without_there_are_none(shaky):
    assert [(trial.accepted, trial.rehearsals) for trial in verdicts(shaky(), SAFE, CLOSE)] == [(True, 0)] * 2


def test_two_rehearsals_have_opposite_errors(shaky):
    """One of them goes too far, whatever is drawn; one alone may not."""
    plans = [(Action("hop", (5.5 + k / 100,)),) for k in range(1, 40)]
    assert not any(trial.accepted for trial in verdicts(shaky(robust=2), *plans))
    assert {trial.accepted for trial in verdicts(shaky(robust=1), *plans)} == {True, False}


def test_the_verdict_depends_on_the_plan_alone(shaky):
    plans = [(Action("hop", (5.0,)), Action("hop", (7.6 + k / 20,))) for k in range(20)]
    made = shaky(robust=1)
    forwards, backwards = verdicts(made, *plans), verdicts(made, *plans[::-1])
    uncached = verdicts(dataclasses.replace(made, prefixes=False), *plans)
    assert forwards == backwards[::-1] == uncached
    assert {trial.accepted for trial in forwards} == {True, False}


def test_rehearsals_are_counted_apart(shaky, serial):
    made = shaky(robust=2)
    evaluator = Evaluator(made, Walks(made), serial)
    trials = list(evaluator.stream(np.random.default_rng(0).random((400, HOPS))))
    assert evaluator.rehearsals == sum(trial.rehearsals for trial in trials) > 0
    assert evaluator.evaluations == evaluator.samples == 400


def test_a_world_without_errors_cannot_rehearse(cli):
    result = cli("run", "drawing/star", "--robust", 1)
    assert result.code == 2
    assert "nothing disturbs the world of drawing" in result.stderr
