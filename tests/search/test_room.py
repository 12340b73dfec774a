"""The room of a plan: its tightest margin, in errors of the size that is to be expected."""

import dataclasses

import numpy as np
import pytest

from proc3s import Action, Rollouts
from proc3s.specs.base import Target
from proc3s.specs.domain import ErrorsSpec

PLAN = (Action("hop", (4.0,)), Action("hop", (10.0,)))
"""Two metres before the first pit, then two behind it."""


def changed(problem, **fields):
    """A problem whose domain differs in fields of its spec."""
    spec = problem.domain.spec.model_copy(update=fields)
    return dataclasses.replace(problem, domain=dataclasses.replace(problem.domain, spec=spec))


def with_constraint(problem, name, **fields):
    constraints = dict(problem.domain.spec.constraints)
    constraints[name] = constraints[name].model_copy(update=fields)
    return changed(problem, constraints=constraints)


def trial_of(problem, plan=PLAN):
    rollouts = Rollouts(problem)
    try:
        rollouts(plan)
        return rollouts(plan)
    finally:
        rollouts.close()


@pytest.mark.parametrize("prefixes", [True, False])
def test_it_is_the_smallest_margin_over_the_expected_error(problem, prefixes):
    room = trial_of(changed(problem(prefixes=prefixes), errors=ErrorsSpec(picked=0.0, placed=0.5))).room
    assert (room.value, room.constraint, room.step, room.margin) == (4.0, "no_pit", 0, 2.0)
    assert str(room) == "4.0, at step 0: no_pit by 2"


def test_a_skill_names_the_error_that_its_margins_are_used_up_by(problem):
    made = changed(problem(), errors=ErrorsSpec(placed=0.5, picked=4.0))
    skills = {"hop": made.domain.spec.skills["hop"].model_copy(update={"error": "picked"})}
    assert trial_of(changed(made, skills=skills)).room.value == 0.5


def test_a_constraint_that_is_yes_or_no_leaves_no_room_and_takes_none(problem):
    made = changed(problem(), errors=ErrorsSpec(picked=0.0, placed=1.0))
    made = with_constraint(made, "no_pit", error="none")
    room = trial_of(made).room
    assert (room.constraint, room.step, room.value) == ("on_line", 1, 86.0)
    assert trial_of(with_constraint(made, "on_line", error="none")).room is None


def test_a_bool_is_yes_or_no(problem):
    made = with_constraint(problem(), "no_pit", error="none")
    assert trial_of(with_constraint(made, "on_line", target="walk:on_line_at_all")).room is None


def test_judges_have_a_margin_too_where_the_goal_counts(problem):
    judge = (Target(target="walk:near", args={"place": 14.0, "reach": 1.5}),)
    made = changed(problem(check_goal=True), errors=ErrorsSpec(picked=0.0, placed=1.0))
    made = dataclasses.replace(made, task=made.task.model_copy(update={"judge": judge}))
    room = trial_of(made).room
    assert (room.constraint, room.step, room.value) == ("goal", None, 1.5)
    assert str(room) == "1.5, by 1.5 at the goal: 0 m off"
    assert trial_of(dataclasses.replace(made, check_goal=False)).room.constraint == "no_pit"


def test_a_plan_that_is_refused_has_no_room_to_speak_of(problem):
    trial = trial_of(problem(), (Action("hop", (8.0,)),))
    assert not trial.accepted
    assert trial.room is None


def test_room_does_not_depend_on_the_process(problem, one):
    made = changed(problem(), errors=ErrorsSpec(picked=0.0, placed=0.5))
    (there,) = one.map(made, [PLAN])
    assert there.room == trial_of(made).room


def test_errors_are_positive():
    with pytest.raises(ValueError, match="greater than 0"):
        ErrorsSpec(placed=0)
    assert ErrorsSpec().turn == pytest.approx(np.radians(0.5))


def test_an_error_of_zero_limits_nothing(problem):
    made = changed(problem(), errors=ErrorsSpec(picked=0.0, placed=1.0))
    skills = {"hop": made.domain.spec.skills["hop"].model_copy(update={"error": "picked"})}
    assert trial_of(changed(made, skills=skills)).room is None


def test_what_a_constraint_tolerates_is_room(problem):
    exact = changed(problem(), errors=ErrorsSpec(picked=0.0, placed=0.5))
    lenient = with_constraint(exact, "no_pit", tolerance=0.5)
    assert (trial_of(exact).room.value, trial_of(lenient).room.value) == (4.0, 5.0)
