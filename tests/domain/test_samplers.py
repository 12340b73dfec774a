import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import toy_world
from proc3s import Action, Space
from proc3s.domain.plan_batch import Parameter, Signature
from proc3s.domain.samplers import ContinuousSampler, DiscreteSampler
from proc3s.domain.values import Pose
from proc3s.search.jitter import Jitter

finite = st.floats(allow_nan=False, allow_infinity=False)
unit = st.floats(0, 1, exclude_max=True)
EDGE = np.array([[0.0], [0.5], [np.nextafter(1, 0)], [1.0]])


@given(finite, finite, st.lists(unit, min_size=1))
@example(-1.7e308, 1.7e308, [0.5])
@example(-1.0, 1e-16, [0.9999999999999999])
def test_continuous_values_lie_between_the_bounds(a, b, u):
    low, high = min(a, b), max(a, b)
    values = ContinuousSampler(low, high).decode(np.array(u)[:, None])
    assert values.shape == (len(u), 1)
    assert ((low <= values) & (values <= high)).all()


def test_continuous_values_are_uniform():
    u = np.linspace(0, 1, 5)[:, None]
    assert ContinuousSampler(-1, 3).decode(u).ravel().tolist() == [-1, 0, 1, 2, 3]


def test_equal_bounds_are_a_constant():
    assert (ContinuousSampler(2, 2).decode(EDGE) == 2).all()


@pytest.mark.parametrize("bounds", [(1, 0), (np.nan, 1), (0, np.nan), (0, np.inf), (-np.inf, 0)])
def test_bounds_are_finite_and_ordered(bounds):
    with pytest.raises(ValueError, match=r"min|bounds"):
        ContinuousSampler(*bounds)


@given(st.integers(1, 50), st.lists(st.floats(0, 1), min_size=1))
def test_discrete_values_are_indices(n, u):
    values = DiscreteSampler(list(range(n))).decode(np.array(u)[:, None])
    assert ((values >= 0) & (values < n) & (values == np.floor(values))).all()


@given(st.integers(1, 20))
def test_discrete_values_are_equally_likely(n):
    u = (np.arange(10 * n) + 0.5)[:, None] / (10 * n)
    assert np.bincount(DiscreteSampler(range(n)).decode(u).ravel().astype(int)).tolist() == [10] * n


def test_a_discrete_sampler_needs_a_value():
    with pytest.raises(ValueError, match="at least one"):
        DiscreteSampler([])


def test_a_space_gives_each_sampler_its_own_dimension():
    space = Space({"x": ContinuousSampler(0, 10), "k": DiscreteSampler("abc"), "y": ContinuousSampler(5, 5)})
    assert space.dim == 3
    rows = space.decode(np.array([[0.25, 0.9, 0.1], [0.5, 0.0, 0.2]]))
    assert rows.tolist() == [[2.5, 2, 5], [5, 0, 5]]


def test_a_space_without_parameters():
    assert Space({}).dim == 0
    assert Space({}).decode(np.empty((4, 0))).shape == (4, 0)


SLIDE = Signature(
    "slide", (Parameter("bead", "object", choices=("a", "b")), Parameter("by", "float", noise=2))
)
LOOK = Signature(
    "look", (Parameter("at", "point", noise=0.5), Parameter("pose", "pose"), Parameter("n", "int"))
)
PLAN = [("slide", "b", 3.0), ("look", (1.0, 2.0, 3.0), Pose(1, 2, 3), 4), ("slide", "a", -1.0)]


@pytest.fixture
def jitter():
    return Jitter(toy_world.columns((SLIDE, LOOK), [PLAN]))


def test_every_noisy_number_is_a_dimension(jitter):
    assert jitter.space.dim == 5


def test_the_centre_is_the_plan_itself(jitter):
    batch = jitter.plans(np.full((2, 5), 0.5))
    assert batch.plan(0) == batch.plan(1) == toy_world.columns((SLIDE, LOOK), [PLAN]).plan(0)


def test_noise_is_normal_with_the_declared_deviation(jitter):
    up, down = 0.8413447460685429, 1 - 0.8413447460685429  # one standard deviation
    slide, look, last = jitter.plans(np.array([[up, up, 0.5, down, down]])).plan(0)
    assert slide.args == ("b", pytest.approx(5.0))
    assert look.args == (pytest.approx((1.5, 2.0, 2.5)), Pose(1, 2, 3), 4)
    assert last.args == ("a", pytest.approx(-3.0))


@given(st.lists(st.lists(st.floats(0, 1), min_size=5, max_size=5), min_size=1, max_size=5))
def test_noise_is_finite_everywhere_and_touches_nothing_else(u):
    batch = Jitter(toy_world.columns((SLIDE, LOOK), [PLAN])).plans(np.array(u))
    assert np.isfinite(batch.values).all()
    for i in range(len(u)):
        assert [a.skill for a in batch.plan(i)] == ["slide", "look", "slide"]
        assert batch.plan(i)[1].args[1:] == (Pose(1, 2, 3), 4)


def test_rows_do_not_influence_each_other(jitter):
    u = np.random.default_rng(0).random((6, 5))
    whole = jitter.plans(u)
    assert [whole.plan(i) for i in range(6)] == [jitter.plans(u[i : i + 1]).plan(0) for i in range(6)]


def test_a_plan_without_noise_has_no_dimension():
    quiet = Signature("slide", (Parameter("by", "float"),))
    jitter = Jitter(toy_world.columns((quiet,), [[("slide", 1.0)]]))
    assert jitter.space.dim == 0
    assert jitter.plans(np.empty((1, 0))).plan(0) == (Action("slide", (1.0,)),)


def test_noise_never_makes_an_action_that_its_skill_forbids():
    narrow = Signature("slide", (Parameter("by", "float", low=0, high=1, noise=50),))
    batch = Jitter(toy_world.columns((narrow,), [[("slide", 0.5)]])).plans(np.array([[0.01], [0.5], [0.99]]))
    for i in range(3):
        assert i in batch.errors or 0 <= batch.plan(i)[0].args[0] <= 1
    assert batch.plan(1)[0].args == (0.5,)


NAMES = ("cup", "can")
PICK = Signature(
    "pick",
    (Parameter("o", "object", choices=NAMES), Parameter("g", "grasp", noise=0.01, turn_noise=0.1)),
)
PLACE = Signature(
    "place",
    (*PICK.params, Parameter("p", "pose", noise=0.02)),
)
GRASP, SPOT = Pose(0.01, 0.0, 0.005, 0.0, math.pi, 0.4), Pose(0.1, -0.5, 0.03)
CARRY = [("pick", "cup", GRASP), ("place", "cup", GRASP, SPOT), ("pick", "can", GRASP)]


@pytest.fixture
def carry():
    return Jitter(toy_world.columns((PICK, PLACE), [CARRY]))


def test_a_grasp_of_one_object_is_perturbed_once_and_another_objects_grasp_by_itself(carry):
    assert carry.space.dim == 6 + 3 + 6
    first, second, third = carry.plans(np.random.default_rng(0).random((1, 15))).plan(0)
    assert first.args[1] == second.args[1] != GRASP
    assert third.args[1] not in (first.args[1], GRASP)


def test_without_noise_poses_and_grasps_stay_to_the_bit(carry):
    plan = carry.plans(np.full((1, 15), 0.5)).plan(0)
    assert plan == toy_world.columns((PICK, PLACE), [CARRY]).plan(0)


def test_poses_are_moved_in_their_own_frame(carry):
    up = 0.8413447460685429  # one standard deviation
    u = np.full((1, 15), 0.5)
    u[0, 0] = u[0, 6] = up
    pick, place, _ = carry.plans(u).plan(0)
    # the grasp looks down (pitch pi): its x axis points back along its yaw
    assert pick.args[1].x == pytest.approx(0.01 - 0.01 * math.cos(0.4))
    assert pick.args[1].y == pytest.approx(-0.01 * math.sin(0.4))
    assert pick.args[1].z == pytest.approx(0.005)
    assert place.args[2] == Pose(*map(pytest.approx, (0.12, -0.5, 0.03, 0, 0, 0)))


def test_a_plan_without_a_number_stays_as_it_is():
    jitter = Jitter(toy_world.columns((Signature("tap", ()),), [[("tap",), ("tap",)]]))
    assert jitter.space.dim == 0
    assert jitter.plans(np.empty((2, 0))).plan(1) == (Action("tap", ()), Action("tap", ()))
