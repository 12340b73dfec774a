import json
import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from PIL import Image

from proc3s import Action, Problem
from proc3s.domain.world import make_world
from proc3s.plugins.registry import open_registry
from proc3s.search.rollout import carry_out

TOLERANCE = 1e-6
anywhere = st.floats(-20, 120, allow_subnormal=False)
point = st.tuples(anywhere, anywhere)
discs = st.lists(st.tuples(st.floats(0, 100), st.floats(0, 100), st.floats(0.5, 30)), max_size=5)


@pytest.fixture(scope="module")
def drawing():
    return open_registry().domain("drawing")


@pytest.fixture(scope="module")
def world(drawing):
    made = make_world(drawing)
    yield made
    made.close()


def problem_of(drawing, circles):
    obstacles = [
        {"name": f"object_{i}", "x_pos": x, "y_pos": y, "radius": r, "color": "red"}
        for i, (x, y, r) in enumerate(circles)
    ]
    scene = json.dumps({"obstacles": obstacles})
    return Problem(domain=drawing, task=drawing.spec.tasks["star"], scene=scene, goal="", seed=0, samples=1)


def draw(drawing, world, circles, *lines, stop=False):
    plan = tuple(Action("draw_line", line) for line in lines)
    return carry_out(world, problem_of(drawing, circles), plan, stop)


def nearest_clearance(circles, p, q):
    """Clearance of a segment by projection onto its line, computed with complex numbers."""
    a, b = complex(*p), complex(*q)
    clearances = []
    for x, y, r in circles:
        c = complex(x, y)
        distance = min(abs(c - a), abs(c - b))
        if abs(b - a) > 1e-12:
            local = (c - a) / (b - a)  # in the frame of the segment, whose ends are 0 and 1
            if 0 < local.real < 1:
                distance = abs(local.imag) * abs(b - a)
        clearances.append(distance - r - 1)
    return min(clearances)


@settings(max_examples=300, deadline=None)
@given(circles=discs, p=point, q=point)
def test_verdicts_agree_with_geometry(drawing, world, circles, p, q):
    trial, final = draw(drawing, world, circles, (*p, *q))
    names = {v.constraint for v in trial.violations}
    inside = min(*p, *q, *(100 - v for v in (*p, *q)))
    assert trial.margins[0]["inside"] == pytest.approx(inside, abs=1e-9)
    assert ("inside" in names) == (inside < 0)
    assert len(final.drawn_lines) == 1
    if not circles:
        assert "collision" not in trial.margins[0]
        return
    clearance = nearest_clearance(circles, p, q)
    assert trial.margins[0]["collision"] == pytest.approx(clearance, abs=1e-4)
    assume(abs(clearance) > TOLERANCE)
    assert ("collision" in names) == (clearance < 0)


@pytest.mark.parametrize(
    ("line", "touches"),
    [
        ((50, 50, 90, 50), True),  # starts in the middle of the disc
        ((50, 59, 50, 95), True),  # starts inside, near the edge
        ((90, 50, 55, 50), True),  # ends inside
        ((48, 50, 52, 50), True),  # lies wholly inside
        ((50, 50, 50, 50), True),  # a point inside
        ((61.5, 50, 61.5, 50), False),  # a point outside
        ((60.9, 50, 60.9, 50), True),  # a point in the margin that the pen keeps
        ((10, 61.001, 90, 61.001), False),  # passes by a hair
        ((10, 60.999, 90, 60.999), True),  # grazes by a hair
        ((10, 10, 20, 90), False),
        ((62, 50, 90, 50), False),  # points away from the disc
        ((10, 50, 38, 50), False),  # would hit if it went on
        ((0, 50, 100, 50), True),
    ],
)
def test_single_lines_at_a_disc(drawing, world, line, touches):
    trial, _ = draw(drawing, world, [(50.0, 50.0, 10.0)], tuple(map(float, line)))
    assert [v.constraint for v in trial.violations] == (["collision"] if touches else [])
    if touches:
        assert trial.violations[0].text == "line touches object_0"


@settings(max_examples=60, deadline=None)
@given(st.floats(0, 2 * math.pi), st.floats(-1e-3, 1e-3))
def test_tangents_from_any_direction(drawing, world, angle, gap):
    assume(abs(gap) > TOLERANCE)
    normal = np.array([math.cos(angle), math.sin(angle)])
    along = np.array([-normal[1], normal[0]])
    foot = np.array([50.0, 50.0]) + (11 + gap) * normal
    p, q = foot - 20 * along, foot + 20 * along
    trial, _ = draw(drawing, world, [(50.0, 50.0, 10.0)], (*p.tolist(), *q.tolist()))
    assert bool(trial.violations) == (gap < 0)


def test_the_nearest_obstacle_is_named(drawing, world):
    trial, _ = draw(drawing, world, [(20.0, 50.0, 5.0), (70.0, 50.0, 10.0)], (0.0, 50.0, 100.0, 50.0))
    assert [v.text for v in trial.violations] == ["line touches object_1"]


def test_the_axis_that_leaves_the_canvas_is_named(drawing, world):
    trial, _ = draw(drawing, world, [], (5.0, 5.0, 5.0, 100.5))
    assert [(v.text, v.margin) for v in trial.violations] == [("the y coordinate leaves the canvas", -0.5)]


@pytest.mark.parametrize("line", [(0, 0, 100, 0), (0, 0, 0, 100), (100, 100, 100, 0)])
def test_the_border_belongs_to_the_canvas(drawing, world, line):
    trial, _ = draw(drawing, world, [], tuple(map(float, line)))
    assert trial.accepted


def test_lines_stay_in_the_order_in_which_they_were_drawn(drawing, world):
    _, final = draw(drawing, world, [], (1.0, 2.0, 3.0, 4.0), (5.0, 6.0, 7.0, 8.0))
    assert [(s.p1_x, s.p1_y, s.p2_x, s.p2_y) for s in final.drawn_lines] == [(1, 2, 3, 4), (5, 6, 7, 8)]


def test_a_world_forgets_earlier_plans(drawing, world):
    first = draw(drawing, world, [(50.0, 50.0, 10.0)], (10.0, 50.0, 90.0, 50.0))
    draw(drawing, world, [(20.0, 20.0, 3.0)], (10.0, 50.0, 90.0, 50.0))
    again = draw(drawing, world, [(50.0, 50.0, 10.0)], (10.0, 50.0, 90.0, 50.0))
    assert again == first
    fresh = make_world(drawing)
    assert draw(drawing, fresh, [(50.0, 50.0, 10.0)], (10.0, 50.0, 90.0, 50.0)) == first


def scene(drawing, seed, **options):
    return drawing.scene(drawing.spec.tasks["star"], seed, options)


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**32), count=st.integers(0, 9))
def test_scenes_are_as_the_paper_says(drawing, seed, count):
    obstacles = scene(drawing, seed, count=count).obstacles
    assert [o.name for o in obstacles] == [f"object_{i}" for i in range(count)]
    for o in obstacles:
        assert 4 <= o.radius <= 15
        assert o.radius < o.x_pos < 100 - o.radius
        assert o.radius < o.y_pos < 100 - o.radius
    for i, a in enumerate(obstacles):
        for b in obstacles[:i]:
            assert math.hypot(a.x_pos - b.x_pos, a.y_pos - b.y_pos) > a.radius + b.radius


def test_seeds_decide_the_scene(drawing):
    assert scene(drawing, 3) == scene(drawing, 3)
    assert scene(drawing, 3) != scene(drawing, 4)


@pytest.mark.parametrize(
    "options",
    [
        {"count": -1},
        {"smallest": 0},
        {"smallest": 20},
        {"largest": 50},
        {"smallest": math.nan},
        {"cuont": 5},
        {"count": "x"},
    ],
)
def test_scenes_that_cannot_be(drawing, options):
    from proc3s import UsageError

    with pytest.raises(UsageError):
        scene(drawing, 0, **options)


@pytest.mark.slow
def test_a_scene_without_room_is_given_up_in_time(drawing):
    import time

    from proc3s import UsageError

    begun = time.process_time()
    with pytest.raises(UsageError, match="no room"):
        scene(drawing, 0, count=60)
    assert time.process_time() - begun < 5


def test_a_picture_shows_obstacles_lines_and_what_is_marked(drawing, world, tmp_path):
    plan = (Action("draw_line", (10.0, 60.0, 90.0, 60.0)), Action("draw_line", (10.0, 90.0, 90.0, 90.0)))
    carry_out(world, problem_of(drawing, [(50.0, 20.0, 10.0)]), plan, False)
    path = tmp_path / "plan.png"
    world.render(plan, path)
    plain, at = picture_of(path)
    assert plain[at(53, 15)] == (255, 127, 127)  # half red, beside its name
    assert plain[at(30, 40)] == (255, 255, 255)
    assert plain[at(30, 90)] == (0, 0, 0)
    assert len(set(plain[at(30, 60)])) == 1
    assert 40 < plain[at(30, 60)][0] < 90  # earlier lines are lighter
    world.render_marked(plan, path, ["object_0"])
    marked, _ = picture_of(path)
    assert marked[at(50, 10.5)] == (255, 0, 0) != plain[at(50, 10.5)]
    assert marked[at(30, 90)] == (255, 0, 0)


def picture_of(path):
    """Its pixels, and where a point of the canvas is among them, found by the frame around the canvas."""
    image = Image.open(path).convert("RGB")
    dark = np.asarray(image).sum(2) < 300
    (left, right), (top, bottom) = (np.flatnonzero(dark.sum(axis) > 400)[[0, -1]] for axis in (0, 1))
    side = right - left
    assert abs(side - (bottom - top)) <= 1

    def at(x, y):
        return round(left + x / 100 * side), round(bottom - y / 100 * side)

    return image.load(), at
