"""The margins of judges: how far one object may be shifted until a goal is missed."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from proc3s_tabletop.objects.extents import common, gap, hull, inside
from proc3s_tabletop.tasks import formations, judges

BLOCKS = {"category": "block"}
OFF = st.floats(-0.03, 0.03)
ANGLE = st.floats(0, 2 * np.pi)
SHARE = st.floats(0, 0.99)


def state(blocks, bowl=None):
    """Blocks at (x, y, z, yaw), named and coloured in turn, and a bowl at (x, y)."""
    things = [("block", ["red", "green", "blue", "yellow"][k % 4], *place) for k, place in enumerate(blocks)]
    things += [("bowl", "white", *bowl, 0.025, 0.0)] if bowl else []
    objects = {}
    for k, (category, color, x, y, z, yaw) in enumerate(things):
        pose = SimpleNamespace(x=x, y=y, z=z, roll=0.0, pitch=0.0, yaw=yaw)
        objects[f"object_{k}"] = SimpleNamespace(category=category, color=color, pose=pose)
    return SimpleNamespace(objects=objects)


def on_one(blocks):
    return judges.on(state(blocks), (), what={"color": "green"}, below={"color": "red"})


def on_two(blocks):
    given = {"supports": 2, "most_gap": 0.02}
    return judges.on(state(blocks), (), what={"color": "blue"}, below={"color": ["red", "green"]}, **given)


def stacked(blocks):
    return judges.stacked(state(blocks), (), what=BLOCKS)


def line(blocks):
    return judges.line(state(blocks), (), what=BLOCKS)


def line_of_three(blocks):
    return judges.line(state(blocks), (), what=BLOCKS, count=3)


def touching(blocks):
    return judges.touching(state(blocks), (), what=BLOCKS)


def still(blocks):
    return judges.still(state(blocks), ())


def packed(blocks):
    return judges.within(state(blocks), (), what=BLOCKS, centre=[0, 0], reach=0.06, count=2)


def near(blocks):
    return judges.within(state(blocks), (), what=BLOCKS, centre=[0, 0], reach=0.06, measure="distance")


def in_bowl(blocks):
    return judges.in_(state(blocks, bowl=(0, 0)), (), what=BLOCKS, inside={"category": "bowl"})


def grid(blocks):
    rows = [{"color": ["red", "green"]}, {"color": ["blue", "yellow"]}]
    return formations.grid(state(blocks), (), rows=rows, most_along=0.08, most_across=0.12)


def ordered(blocks):
    what = [{"color": color} for color in ("red", "green", "blue")]
    return formations.ordered(state(blocks), (), what=what, most=0.08)


GOALS = {
    on_one: [(0, 0, 0.02), (0, 0, 0.06)],
    on_two: [(-0.025, 0, 0.02), (0.025, 0, 0.02), (0, 0, 0.06)],
    stacked: [(0, 0, 0.02), (0, 0, 0.06), (0, 0, 0.1)],
    line: [(0, 0, 0.02), (0.1, 0, 0.02), (0.2, 0, 0.02)],
    line_of_three: [(0, 0, 0.02), (0.1, 0, 0.02), (0.2, 0, 0.02), (0.15, 0.01, 0.02)],
    touching: [(0, 0, 0.02), (0.03, 0, 0.02), (0.03, 0.03, 0.02)],
    still: [(0, 0, 0.02), (0, 0, 0.06), (0.2, 0, 0.02)],
    packed: [(0.04, 0.04, 0.02), (-0.05, 0, 0.02), (0.05, -0.05, 0.02)],
    near: [(0.04, 0, 0.02), (-0.05, 0, 0.02)],
    in_bowl: [(0.05, 0, 0.03)],
    grid: [(-0.03, 0, 0.02), (0.04, 0, 0.02), (-0.03, 0.1, 0.02), (0.04, 0.1, 0.02)],
    ordered: [(-0.05, 0, 0.02), (0.02, 0, 0.02), (0.06, 0, 0.02)],
}
goals = pytest.mark.parametrize("judge", GOALS, ids=lambda judge: judge.__name__)


def placed(judge, data):
    """The blocks of a goal, each a little off."""
    spots = [(x + data.draw(OFF), y + data.draw(OFF), z) for x, y, z in GOALS[judge]]
    return [(*spot, data.draw(ANGLE)) for spot in spots]


@goals
@given(data=st.data())
def test_a_margin_is_negative_where_the_goal_is_missed_and_only_there(judge, data):
    score = judge(placed(judge, data))
    if score.margin is not None:
        assert score.reached == (score.margin >= 0)


@goals
@settings(suppress_health_check=[HealthCheck.filter_too_much])
@given(data=st.data())
def test_a_goal_stays_reached_when_one_object_is_shifted_by_less_than_the_margin(judge, data):
    blocks = placed(judge, data)
    score = judge(blocks)
    assume(score.reached and score.margin is not None)
    k, way, angle = (
        data.draw(st.integers(0, len(blocks) - 1)),
        data.draw(SHARE) * score.margin,
        data.draw(ANGLE),
    )
    x, y, z, yaw = blocks[k]
    blocks[k] = (x + way * np.cos(angle), y + way * np.sin(angle), z, yaw)
    assert judge(blocks).reached, (score.margin, k, way)


@goals
def test_the_goals_have_margins_that_more_than_rounding_uses_up(judge):
    score = judge([(*spot, 0.0) for spot in GOALS[judge]])
    assert score.reached
    assert score.margin is not None
    assert abs(score.margin) > 1e-3


@pytest.mark.parametrize(
    ("score", "margin"),
    [
        (on_one([(0, 0, 0.02, 0), (0.015, 0, 0.06, 0)]), 0.005),  # 20 mm to the edge, past which it tips
        (on_one([(0, 0, 0.02, 0), (0.045, 0, 0.06, 0)]), -0.006),  # 5 mm beside, and 1 mm to overlap
        (on_two([(-0.025, 0, 0.02, 0), (0.025, 0, 0.02, 0), (0, 0, 0.06, 0)]), 0.01),  # the gap
        (on_two([(-0.02, 0, 0.02, 0), (0.02, 0, 0.02, 0), (0.016, 0, 0.06, 0)]), 0.003),  # the overlap
        (stacked([(0, 0, 0.02, 0), (0.012, 0, 0.06, 0), (0, 0, 0.1, 0)]), 0.008),
        (line([(0, 0, 0.02, 0), (0.1, 0.008, 0.02, 0), (0.2, 0, 0.02, 0)]), 0.006),
        (touching([(0, 0, 0.02, 0), (0.0405, 0, 0.02, 0)]), 0.0015),
        (still([(0, 0, 0.02, 0), (0.3, 0, 0.02, 0)]), None),
        (judges.upright(state([(0, 0, 0.02, 0.3)]), ()), None),
    ],
)
def test_margins_are_distances(score, margin):
    assert score.margin == (margin if margin is None else pytest.approx(margin, abs=1e-6))


def test_a_lean_counts_40_mm_a_rad_once_it_is_one():
    final = state([(0, 0, 0.02, 0)])
    final.objects["object_0"].pose.roll = 0.06
    assert judges.upright(final, ()).margin == pytest.approx(0.04 * (0.10 - 0.06))
    final.objects["object_0"].pose.roll = 0.2
    assert judges.upright(final, ()).margin == pytest.approx(0.04 * (0.10 - 0.2))


def square(x, y, turn, side=0.04):
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * side / 2
    c, s = np.cos(turn), np.sin(turn)
    return corners @ np.array([[c, s], [-s, c]]) + (x, y)


@given(OFF, OFF, ANGLE, ANGLE, st.integers(0, 2**32 - 1))
def test_points_are_in_what_two_outlines_have_in_common_if_they_are_in_both(x, y, turn, other_turn, seed):
    a, b = square(0, 0, turn), square(x, y, other_turn)
    shared = common(a, b)
    assert (len(shared) == 0) == (gap(a, b) > 0) or abs(gap(a, b)) < 1e-9
    for point in np.random.default_rng(seed).uniform(-0.04, 0.04, (20, 2)):
        in_both = min(inside(a, *point), inside(b, *point))
        if len(hull(shared)) > 2 and abs(in_both) > 1e-7:
            assert (inside(hull(shared), *point) > 0) == (in_both > 0)
