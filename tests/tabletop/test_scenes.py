import itertools
import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from proc3s import SpecError
from proc3s_tabletop.objects.body import CATEGORIES
from proc3s_tabletop.objects.extents import extent, gap
from proc3s_tabletop.tasks.scenes import scene

BLOCKS = {"category": "block", "color": ["red", "blue"], "count": 6}
BOWLS = {"category": "bowl", "color": "green", "count": 2, "apart": 0.16}
STACKS = [
    {"category": "bowl", "color": "green", "apart": 0.16},
    {"category": "block", "color": "green"},
    {"category": "block", "color": "red", "on": {"color": "green", "category": "block"}},
    {"category": "block", "color": "blue", "count": 6, "on": {"category": "block"}, "chance": 0.4},
]


def made(seed, objects, **options):
    return scene(np.random.default_rng(seed), objects, **options)["objects"]


def at(thing):
    pose = thing["pose"]
    return pose["x"], pose["y"], pose["z"]


def distance(a, b):
    return math.dist(at(a)[:2], at(b)[:2])


SEEDS = st.integers(0, 10_000)


@settings(deadline=None, max_examples=40)
@given(seed=SEEDS)
def test_scattered_objects_keep_their_distance_and_lie_within_the_margin(seed):
    objects = made(seed, [BOWLS, BLOCKS])
    assert [*objects] == [f"object_{k}" for k in range(8)]
    assert [o["category"] for o in objects.values()] == ["bowl"] * 2 + ["block"] * 6
    for a, b in itertools.combinations(objects.values(), 2):
        assert distance(a, b) >= (0.16 if "bowl" in (a["category"], b["category"]) else 0.125)
    for thing in objects.values():
        x, y, z = at(thing)
        assert -0.2 <= x <= 0.2
        assert -0.7 <= y <= -0.3
        assert z == pytest.approx(0.025 if thing["category"] == "bowl" else 0.02)


@settings(deadline=None, max_examples=40)
@given(seed=SEEDS)
def test_stacked_objects_stand_on_one_another_and_nothing_else_touches(seed):
    objects = made(seed, STACKS)
    by_height = {}
    for thing in objects.values():
        x, y, z = at(thing)
        if thing["category"] == "block":
            by_height.setdefault((x, y), []).append(z)
    for heights in by_height.values():
        assert sorted(heights) == pytest.approx([0.02, 0.06, 0.10][: len(heights)], abs=1e-4)
    assert at(objects["object_2"])[2] == pytest.approx(0.06, abs=1e-4)
    assert distance(objects["object_1"], objects["object_2"]) == 0
    for a, b in itertools.combinations(objects.values(), 2):
        outlines = [extent(CATEGORIES[o["category"]], SimpleNamespace(**o["pose"])).outline for o in (a, b)]
        assert distance(a, b) == 0 or gap(*outlines) > 0.02


def test_a_seed_gives_one_scene():
    assert made(3, STACKS) == made(3, STACKS)
    assert made(3, STACKS) != made(4, STACKS)


def test_several_colours_are_drawn_from():
    colors = {o["color"] for seed in range(10) for o in made(seed, [BLOCKS]).values()}
    assert colors == {"red", "blue"}


def test_a_scene_that_jams_is_begun_again(monkeypatch):
    crowd = [{"category": "block", "count": 9}]
    assert all(len(made(seed, crowd)) == 9 for seed in range(20))
    monkeypatch.setattr("proc3s_tabletop.tasks.scenes.SCENES", 1)
    with pytest.raises(ValueError, match="in 1 attempts: no room"):
        [made(seed, crowd) for seed in range(20)]


def test_a_scene_without_room_is_given_up():
    with pytest.raises(
        ValueError, match=r"no such scene in 200 attempts: no room for object_\d+ \(a block\)"
    ):
        made(0, [{"category": "block", "count": 40}])
    with pytest.raises(ValueError, match=r"nothing is left for object_3 to stand on"):
        made(0, [{"category": "block"}, {"category": "block", "count": 3, "on": {"category": "block"}}])
    with pytest.raises(ValueError, match=r"object_0 and object_1 are in one another's place"):
        made(0, [{"category": "block", "at": [0, -0.5]}, {"category": "block", "at": [0.03, -0.5]}])


def test_fixed_poses_and_regions_are_kept():
    here = {"category": "block", "at": [0.1, -0.6], "yaw": 0.5}
    there = {"category": "block", "within": [[-0.05, 0.05], [-0.3, -0.25]], "count": 1}
    objects = made(1, [here, there])
    assert at(objects["object_0"]) == pytest.approx((0.1, -0.6, 0.02))
    assert objects["object_0"]["pose"]["yaw"] == 0.5
    x, y, _ = at(objects["object_1"])
    assert -0.05 <= x <= 0.05
    assert -0.3 <= y <= -0.25


def test_bodies_of_a_domain_decide_about_heights():
    can = {"can": {"shape": "cylinder", "radius": 0.03, "height": 0.1, "mass": 0.2}}
    objects = made(0, [{"category": "can"}, {"category": "can", "on": {}}], bodies=can)
    assert [at(o)[2] for o in objects.values()] == pytest.approx([0.05, 0.15], abs=1e-4)


MISTAKES = {
    "unknown key": ([{"category": "block", "colour": "red"}], r"objects\.0: colour: unknown key"),
    "at and several": ([{"category": "block", "at": [0, 0], "count": 2}], r"is one object"),
    "chance of nothing": ([{"category": "block", "chance": 0.5}], r"standing `on` something"),
    "a strange selector": ([{"category": "block", "on": {"size": 3}}], r"objects\.0: on\.size: unknown key"),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_mistakes_are_named(name):
    objects, message = MISTAKES[name]
    with pytest.raises(SpecError, match=message):
        made(0, objects)


def test_a_category_without_a_body_is_named():
    with pytest.raises(ValueError, match=r"no body for 'sofa'; there are block, bowl"):
        made(0, [{"category": "sofa"}])


BAD_BODIES = {
    "no shape": ({"mass": 1}, r"bodies\.cup: shape: is missing"),
    "unknown shape": ({"shape": "boxx", "mass": 1}, r"no shape 'boxx'; did you mean 'box'"),
    "no mass": ({"shape": "box", "size": [1, 1, 1]}, r"bodies\.cup: mass: is missing"),
    "a flat box": ({"shape": "box", "size": [1, 1, 0], "mass": 1}, r"size\.2: .*greater than 0"),
    "a solid bowl": ({"shape": "bowl", "wall": 0.06, "mass": 1}, r"wall < foot_radius"),
    "a mesh without path": ({"shape": "mesh", "mass": 1}, r"path: is missing"),
    "a mesh that is not there": (
        {"shape": "mesh", "path": "cup.obj", "mass": 1},
        r"path: .*no file cup\.obj",
    ),
}


@pytest.mark.parametrize("name", BAD_BODIES)
def test_mistakes_of_bodies_are_named(name):
    body, message = BAD_BODIES[name]
    with pytest.raises(SpecError, match=message):
        made(0, [{"category": "cup"}], bodies={"cup": body})


def test_objects_are_turned_by_chance_where_the_scene_says_so():
    entries = [{"category": "block", "count": 3, "yaw": "any"}, {"category": "block", "yaw": 0.4}]
    turns = [[o["pose"]["yaw"] for o in made(seed, entries).values()] for seed in (1, 1, 2)]
    assert turns[0] == turns[1] != turns[2]
    assert all(len({*some}) == 4 and some[3] == 0.4 for some in turns)
    assert all(-math.pi <= turn <= math.pi for some in turns for turn in some)


def test_a_yaw_is_a_number_or_any():
    with pytest.raises(SpecError, match="yaw"):
        made(0, [{"category": "block", "yaw": "some"}])
