import dataclasses
import json
import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

import toy_world
from proc3s import Action, Pose
from proc3s.domain.plan_batch import Parameter, Signature
from proc3s.domain.source_text import source_text
from proc3s.domain.world import make_world
from proc3s.search.rollout import carry_out

finite = st.floats(allow_nan=False, allow_infinity=False)


@pytest.fixture
def domain(tmp_path):
    return toy_world.domain(tmp_path)


@pytest.fixture
def problem(tmp_path):
    return toy_world.problem(tmp_path)


def beads(*places):
    return {"beads": [{"name": f"object_{i}", "place": place} for i, place in enumerate(places)]}


def test_a_state_survives_json_bit_by_bit(domain):
    states = domain.states
    state = states.parse(beads(0.1 + 0.2, 1e-300, -0.0))
    again = states.parse(json.loads(json.dumps(states.dump(state))))
    assert again == state
    assert math.copysign(1, again.beads[2].place) == -1


def test_a_state_is_frozen_and_its_lists_are_tuples(domain):
    state = domain.states.parse(beads(1.0))
    assert isinstance(state.beads, tuple)
    with pytest.raises(dataclasses.FrozenInstanceError):
        state.moves = 3
    with pytest.raises(dataclasses.FrozenInstanceError):
        state.beads[0].place = 3


def test_defaults_fill_what_the_scene_leaves_out(domain):
    assert domain.states.parse(beads()).moves == 0


@pytest.mark.parametrize(
    "data",
    [
        {},
        {"beads": [{"name": "a"}]},
        {"beads": [{"name": "a", "place": "here"}]},
        {"beads": [{"name": "a", "place": 1.0, "colour": "red"}]},
        {"beads": [], "mooves": 3},
    ],
)
def test_data_that_does_not_fit_the_types_is_refused(domain, data):
    with pytest.raises(ValidationError):
        domain.states.parse(data)


def test_object_names_keep_the_order_of_the_state(domain):
    assert domain.object_names(domain.states.parse(beads(3, 2, 1))) == ("object_0", "object_1", "object_2")


def test_signatures_know_the_objects_of_the_state(domain):
    (slide,) = domain.signatures(domain.states.parse(beads(1, 2)))
    assert slide.skill == "slide"
    assert slide.params[0].choices == ("object_0", "object_1")
    assert slide.params[1].noise == 2
    assert slide.width == 2


def test_a_problem_pickles_with_its_state_already_made(problem):
    before = problem.initial
    problem.domain.margins, problem.domain.skill("slide")
    again = pickle.loads(pickle.dumps(problem))
    assert again == problem
    assert again.domain.states.dump(again.initial) == problem.domain.states.dump(before)


def test_a_pickled_problem_gives_the_same_verdict(problem):
    plan = (Action("slide", ("object_1", 3.0)), Action("slide", ("object_0", 40.0)))
    again = pickle.loads(pickle.dumps(problem))
    one, _ = carry_out(make_world(problem.domain), problem, plan, stop=False)
    two, _ = carry_out(make_world(again.domain), again, plan, stop=False)
    assert one == two
    assert one.reached == 1


def test_a_problem_hashes(problem, tmp_path):
    assert hash(problem) == hash(pickle.loads(pickle.dumps(problem)))


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1, "1"),
        (1.0, "1.0"),
        (-0.0, "-0.0"),
        (True, "True"),
        (None, "None"),
        ("it's", '"it\'s"'),
        ((1, 2.5), "[1, 2.5]"),
        ({"a": (1,)}, "{'a': [1]}"),
        (Pose(1, 2.0, 3), "Pose(x=1, y=2.0, z=3, roll=0.0, pitch=0.0, yaw=0.0)"),
    ],
)
def test_source_text(value, text):
    assert source_text(value) == text


def test_source_text_rounds_for_reading_only():
    assert source_text([2 / 3, -0.001, 1e9], decimals=2) == "[0.67, 0.0, 1000000000.0]"
    assert source_text(2 / 3) == repr(2 / 3)


@given(st.recursive(finite | st.integers() | st.text() | st.booleans(), lambda x: st.lists(x, max_size=3)))
def test_source_text_evaluates_to_the_value(value):
    assert eval(source_text(value)) == value


@pytest.mark.parametrize("bad", [math.nan, math.inf, [1.0, -math.inf], {"a": math.nan}, Pose(math.nan, 0, 0)])
def test_source_text_refuses_what_is_not_finite(bad):
    with pytest.raises(ValueError, match="finite"):
        source_text(bad)


SIGNATURES = (
    Signature("go", (Parameter("x", "float"), Parameter("times", "int"))),
    Signature(
        "pick",
        (
            Parameter("item", "object", choices=("object_0", "object_1")),
            Parameter("how", "str", choices=("soft", "hard")),
            Parameter("grasp", "grasp"),
        ),
    ),
    Signature("look", (Parameter("at", "point"), Parameter("from_", "pose"))),
    Signature("wait", ()),
)


def test_plans_come_out_of_columns_as_they_went_in():
    pose, grasp = Pose(1, 2, 3, 0.1, 0.2, 0.3), Pose(0, 0, 0.5, 0, math.pi, 1)
    plans = [
        [("go", 1.5, 3), ("wait",)],
        None,
        [("pick", "object_1", "soft", grasp), ("look", (7.0, 8.0, 9.0), pose), ("wait",), ("go", -2.0, -1)],
    ]
    batch = toy_world.columns(SIGNATURES, plans, {1: KeyError("no plan")})
    assert len(batch) == 3
    assert batch.plan(0) == (Action("go", (1.5, 3)), Action("wait", ()))
    assert batch.plan(2) == (
        Action("pick", ("object_1", "soft", grasp)),
        Action("look", ((7.0, 8.0, 9.0), pose)),
        Action("wait", ()),
        Action("go", (-2.0, -1)),
    )
    assert isinstance(batch.plan(0)[0].args[1], int)
    assert isinstance(batch.plan(2)[0].args[2], Pose)
    with pytest.raises(KeyError, match="no plan"):
        batch.plan(1)


def test_an_action_as_json_and_as_text():
    action = Action("look", ((1.0, 2.0, 3.0), Pose(1, 2, 3), "object_0", 4, 2 / 3))
    assert json.loads(json.dumps(action.to_json())) == {
        "skill": "look",
        "args": [[1.0, 2.0, 3.0], [1, 2, 3, 0.0, 0.0, 0.0], "object_0", 4, 2 / 3],
    }
    assert str(action) == "look((1, 2, 3), (1, 2, 3, 0, 0, 0), object_0, 4, 0.6667)"


def test_equal_plans_hash_equally():
    one, two = ((Action("look", ((1.0, 2.0, 3.0), Pose(1, 2, 3))),) for _ in range(2))
    assert hash(one) == hash(two)
    assert len({one, two}) == 1


def test_columns_that_are_floats_stay_exact():
    value = np.nextafter(0.1, 1)
    assert toy_world.columns(SIGNATURES, [[("go", value, 1)]]).plan(0)[0].args[0] == value
