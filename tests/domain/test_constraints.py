import numpy as np
import pytest

import toy_world
from proc3s import Action, Margin, SpecError, Violation
from proc3s.domain.margins import sentence
from proc3s.domain.world import make_world
from proc3s.search.rollout import carry_out
from proc3s.wording import plain

SLIDE = Action("slide", ("object_0", 3.0))
FAR = Action("slide", ("object_0", 50.0))


def with_constraint(tmp_path, value=None, target="toy_world:answer", says="no", tolerance=0.0):
    """A problem whose only constraint returns a value."""
    line = f'  mine: {{says: "{says}", target: "{target}", tolerance: {tolerance}'
    text = toy_world.DOMAIN.replace(
        '  on_wire: {says: "{bead} leaves the wire", target: "toy_world:on_wire", tolerance: 0.5}',
        line + (f", args: {{value: {value}}}}}" if target == "toy_world:answer" else "}"),
    )
    return toy_world.problem(tmp_path, text)


def trial_of(problem, *actions, stop=True):
    trial, _ = carry_out(make_world(problem.domain), problem, actions, stop)
    return trial


@pytest.mark.parametrize(
    ("value", "margin"), [("true", 1.0), ("false", -1.0), ("0", 0.0), ("-2", -2.0), ("1.5", 1.5)]
)
def test_what_a_constraint_may_return(tmp_path, value, margin):
    trial = trial_of(with_constraint(tmp_path, value), SLIDE)
    assert trial.margins == ({"mine": margin},)
    assert trial.accepted == (margin >= 0)


def test_none_is_does_not_apply(tmp_path):
    trial = trial_of(with_constraint(tmp_path, "null"), SLIDE)
    assert trial.accepted
    assert trial.margins == ({},)


@pytest.mark.parametrize(
    ("target", "margin"),
    [("says_true", 1.0), ("says_false", -1.0), ("thousandth", -0.125)],
)
def test_numpy_numbers_count_as_numbers(tmp_path, target, margin):
    assert trial_of(with_constraint(tmp_path, target=f"toy_world:{target}"), SLIDE).margins == (
        {"mine": margin},
    )


@pytest.mark.parametrize("value", ["yes", "[1]", "{a: 1}"])
def test_anything_else_is_an_error_of_the_spec(tmp_path, value):
    with pytest.raises(SpecError, match=r"constraint mine: target: returned .*not a margin"):
        trial_of(with_constraint(tmp_path, value), SLIDE)


def test_nan_is_an_error_of_the_spec(tmp_path):
    with pytest.raises(SpecError, match="nan"):
        trial_of(with_constraint(tmp_path, target="toy_world:not_a_number"), SLIDE)


@pytest.mark.parametrize(("tolerance", "accepted"), [(0.0, False), (1.9, False), (2.0, True), (2.1, True)])
def test_a_margin_down_to_the_tolerance_is_fulfilled(tmp_path, tolerance, accepted):
    trial = trial_of(with_constraint(tmp_path, "-2", tolerance=tolerance), SLIDE)
    assert trial.accepted == accepted
    assert trial.margins == ({"mine": -2.0},)


@pytest.mark.parametrize("says", ["{nothing}", "{0}", "{", "{bead.size}", "{bead[0]}", "{bead:d}"])
def test_a_sentence_with_a_bad_placeholder_is_an_error_of_the_spec(tmp_path, says):
    text = toy_world.DOMAIN.replace("{bead} leaves", f"{says} leaves")
    if says == "{bead[0]}":  # the one that Python can fill in: a letter of the name
        assert trial_of(toy_world.problem(tmp_path, text), FAR).violations[0].text == "o leaves the wire"
        return
    with pytest.raises(SpecError, match=r"on_wire(: |\.)says"):
        trial_of(toy_world.problem(tmp_path, text), FAR)


def test_a_violation_says_all(tmp_path):
    trial = trial_of(toy_world.problem(tmp_path), SLIDE, FAR)
    assert trial.violations == (Violation("on_wire", 1, "slide", -43.0, "object_0 leaves the wire"),)
    assert (trial.reached, len(trial.margins)) == (1, 2)


def test_a_rollout_stops_at_the_first_violating_step(tmp_path):
    trial = trial_of(toy_world.problem(tmp_path), SLIDE, FAR, FAR, SLIDE)
    assert [v.step for v in trial.violations] == [1]
    assert len(trial.margins) == 2


def test_an_execution_does_not_stop(tmp_path):
    back = Action("slide", ("object_0", -50.0))
    trial = trial_of(toy_world.problem(tmp_path), SLIDE, FAR, back, FAR, stop=False)
    assert [v.step for v in trial.violations] == [1, 3]
    assert (trial.reached, len(trial.margins)) == (1, 4)


def test_violations_of_one_step_keep_the_order_of_the_spec(tmp_path):
    text = toy_world.DOMAIN.replace(
        "constraints:\n",
        'constraints:\n  first: {says: "first", target: "toy_world:answer", args: {value: -1}}\n',
    )
    trial = trial_of(toy_world.problem(tmp_path, text), FAR)
    assert [v.constraint for v in trial.violations] == ["first", "on_wire"]


def test_a_margin_carries_details():
    assert Margin(1.0).details == {}
    assert Margin(np.float64(-1), {"who": "object_0"}).details == {"who": "object_0"}


def test_an_infinite_violation_is_still_valid_json(tmp_path):
    import json

    from proc3s.runs.events import BatchEvaluated

    trial = trial_of(with_constraint(tmp_path, target="toy_world:infinite"), SLIDE)
    assert not trial.accepted
    event = BatchEvaluated.from_trials(0, 0, [trial]).model_dump(mode="json")
    json.dumps(event, allow_nan=False)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (103.2, "103"),
        (0.012345, "0.0123"),
        (1e-5, "0.00001"),
        (1e5, "100000"),
        (0.1 + 0.2, "0.3"),
        (5.0, "5"),
        (float("inf"), "infinity"),
        (np.float32(0.5), "0.5"),
    ],
)
def test_numbers_in_a_sentence_are_written_as_people_do(tmp_path, value, text):
    spec = with_constraint(tmp_path, "-1", says="off by {gap}").domain.spec
    said = sentence(spec.constraints["mine"], {"gap": value})
    assert said == f"off by {text}"


@pytest.mark.parametrize(("value", "text"), [(100.4, "100"), (99.6, "100"), (0.0123, "0.012"), (-0.0, "0")])
def test_a_miss_is_told_without_an_exponent(value, text):
    assert plain(value) == text
