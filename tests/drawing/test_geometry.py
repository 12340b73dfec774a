"""The planar graph of a drawing, and the geometry that the judges read from it."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from proc3s_drawing.geometry import (
    TangledError,
    angle_between,
    corners,
    inside,
    nearest_on_segment,
    outlines,
    ray_to_circle,
    segment_distance,
    simplify,
    stroke_graph,
    turns,
)

SQUARE = [(0, 0, 10, 0), (10, 0, 10, 10), (10, 10, 0, 10), (0, 10, 0, 0)]


def graph_of(*lines):
    return stroke_graph(np.array(lines, dtype=float).reshape(-1, 4))


def degrees_of(graph):
    """How many nodes there are of each degree."""
    counts = [len(others) for others in graph.neighbours.values()]
    return {degree: counts.count(degree) for degree in sorted(set(counts))}


def area(polygon):
    x, y = polygon.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


# Nodes and edges


def test_no_lines_make_an_empty_graph():
    graph = graph_of()
    assert not graph.edges
    assert outlines(graph) == []


def test_dots_are_dropped():
    assert degrees_of(graph_of((0, 0, 10, 0), (5, 5, 5, 5), (0, 0, 0, 0))) == {1: 2}


def test_tolerance_is_one_percent_of_the_diagonal_of_a_square():
    assert graph_of(*SQUARE).tolerance == pytest.approx(0.01 * math.hypot(10, 10) * math.sqrt(2))


@pytest.mark.parametrize(
    ("lines", "degrees"),
    [
        pytest.param([(0, 0, 10, 10), (0, 10, 10, 0)], {1: 4, 4: 1}, id="crossing"),
        pytest.param([(0, 0, 10, 0), (5, 0, 5, 8)], {1: 3, 3: 1}, id="T"),
        pytest.param([(0, 0, 10, 0), (5, 0.1, 5, 8)], {1: 3, 3: 1}, id="T with a gap"),
        pytest.param([(0, 0, 10, 0), (5, -0.1, 5, 8)], {1: 3, 3: 1}, id="T that overshoots"),
        pytest.param([(0, 0, 10, 0), (5, 0.5, 5, 8)], {1: 4}, id="T too short"),
        pytest.param([(0, 0, 10, 0), (5, -0.5, 5, 8)], {1: 4, 4: 1}, id="T too long"),
        pytest.param([(0, 0, 10, 0), (10, 0, 10, 10)], {1: 2}, id="corner"),
        pytest.param([(0, 0, 9.9, 0), (10, 0.05, 10, 10)], {1: 2}, id="corner with a gap"),
        pytest.param([(0, 0, 10.1, 0), (10, -0.1, 10, 10)], {1: 2}, id="corner that overshoots"),
        pytest.param([(0, 0, 6, 0), (4, 0, 10, 0)], {1: 2}, id="overlap"),
        pytest.param([(0, 0, 10, 0), (10, 0, 0, 0)], {1: 2}, id="there and back"),
        pytest.param([(0, 0, 10, 0), (0, 0.05, 10, -0.05)], {1: 2}, id="drawn twice, shaky"),
        pytest.param([(0, 0, 10, 0), (3, 0, 5, 0)], {1: 2}, id="part drawn twice"),
        pytest.param([(0, 0, 10, 0), (0, 3, 10, 3)], {1: 4}, id="parallels"),
    ],
)
def test_loose_ends_and_forks(lines, degrees):
    found = degrees_of(graph_of(*lines))
    assert {degree: count for degree, count in found.items() if degree != 2} == degrees


def test_three_shaky_strokes_that_meet_make_one_fork():
    graph = graph_of((0, 0, 10.02, 0.01), (9.97, 0.05, 6, 3), (10.05, -0.03, 6, -3))
    assert len(graph.of_degree(3)) == 1
    assert len(graph.chains) == 3


def test_acute_corner_is_not_zipped_up():
    graph = graph_of((0, 0, 1, 0), (1, 0, 10, 0), (0, 0, 10, 1), (10, 0, 10, 1))
    assert degrees_of(graph) == {2: len(graph.neighbours)}
    assert len(outlines(graph)) == 1


@settings(deadline=None)
@given(st.permutations([*SQUARE, (0, 0, 10, 10), (5, 5, 20, 5)]), st.integers(0, 2**6 - 1))
def test_graph_does_not_depend_on_order_and_direction(lines, flips):
    graph = graph_of(*(line[2:] + line[:2] if flips >> i & 1 else line for i, line in enumerate(lines)))
    expected = graph_of(*SQUARE, (0, 0, 10, 10), (5, 5, 20, 5))
    assert graph.edges == expected.edges
    assert np.array_equal(graph.nodes, expected.nodes)


def test_chains_run_from_fork_to_end():
    graph = graph_of((0, 0, 5, 0), (5, 0, 10, 0), (10, 0, 14, 3), (10, 0, 14, -3))
    ends = [{tuple(graph.nodes[node].tolist()) for node in (chain[0], chain[-1])} for chain in graph.chains]
    assert sorted(map(sorted, ends)) == [[(0, 0), (10, 0)], [(10, 0), (14, -3)], [(10, 0), (14, 3)]]
    assert graph.length(max(graph.chains, key=graph.length)) == pytest.approx(10)
    assert graph_of(*SQUARE).chains == []


def test_too_many_crossings_are_refused():
    hatch = [(i, 0, i, 40) for i in range(40)] + [(0, i, 40, i) for i in range(40)]
    with pytest.raises(TangledError, match="too tangled to read: the strokes cross at 1600 points"):
        graph_of(*hatch)


# Outlines


def test_outline_of_a_square_runs_counter_clockwise():
    (found,) = outlines(graph_of(*SQUARE))
    assert area(found) == pytest.approx(100)
    assert {tuple(point) for point in found.tolist()} == {(0, 0), (10, 0), (10, 10), (0, 10)}


@pytest.mark.parametrize(
    ("extra", "areas"),
    [
        pytest.param([(0, 0, 10, 10)], [100], id="wall inside"),
        pytest.param([(10, 10, 15, 15)], [100], id="tail outside"),
        pytest.param([(0, 0, 4, 5)], [100], id="tail inside"),
        pytest.param([(2, 2, 4, 2), (4, 2, 4, 4), (4, 4, 2, 2)], [100], id="island inside"),
        pytest.param([(12, 2, 14, 2), (14, 2, 14, 4), (14, 4, 12, 2)], [2, 100], id="island outside"),
        pytest.param([(10, 10, 12, 10), (12, 10, 12, 12), (12, 12, 10, 10)], [2, 100], id="touching corner"),
        pytest.param(
            [(10, 10, 12, 12), (12, 12, 14, 12), (14, 12, 14, 14), (14, 14, 12, 12)],
            [2, 100],
            id="on a string",
        ),
        pytest.param([(10, 2, 14, 2), (14, 2, 14, 6), (14, 6, 10, 6)], [116], id="annex"),
        pytest.param([(5, 5, 15, 5), (15, 5, 15, 15), (15, 15, 5, 15), (5, 15, 5, 5)], [175], id="overlap"),
    ],
)
def test_outlines_of_a_square_and_more(extra, areas):
    assert sorted(map(area, outlines(graph_of(*SQUARE, *extra)))) == pytest.approx(areas)


def test_open_strokes_have_no_outline():
    assert outlines(graph_of(*SQUARE[:3])) == []
    assert outlines(graph_of((0, 0, 10, 0), (5, -5, 5, 5))) == []


@settings(deadline=None)
@given(st.integers(3, 40), st.floats(0, 360), st.floats(0.01, 1000))
def test_outline_of_a_regular_polygon_has_its_area(n, turn, radius):
    angles = np.radians(turn) + 2 * np.pi * np.arange(n) / n
    ring = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    (found,) = outlines(graph_of(*np.concatenate([ring, np.roll(ring, -1, axis=0)], axis=1)))
    assert area(found) == pytest.approx(area(ring))


# Points, segments, rays


def test_angle_between_is_signed():
    east, north = np.array([1.0, 0.0]), np.array([0.0, 2.0])
    assert angle_between(east, north) == pytest.approx(90)
    assert angle_between(north, east) == pytest.approx(-90)
    assert abs(angle_between(east, -east)) == pytest.approx(180)


@pytest.mark.parametrize(
    ("point", "nearest"),
    [((3, 4), (3, 0)), ((-3, 4), (0, 0)), ((13, -4), (10, 0)), ((5, 0), (5, 0))],
)
def test_nearest_point_of_a_segment(point, nearest):
    point, a, b = np.array(point, dtype=float), np.zeros(2), np.array([10.0, 0.0])
    assert tuple(nearest_on_segment(point, a, b)) == nearest
    assert segment_distance(point, a, b) == pytest.approx(math.dist(point, nearest))


def test_segment_distance_takes_many_points_or_many_segments():
    ends = np.array([[0.0, 0.0], [10.0, 0.0]])
    assert segment_distance(np.array([[5.0, 2.0], [12.0, 0.0]]), *ends).tolist() == [2, 2]
    assert segment_distance(np.array([5.0, 2.0]), ends, ends).tolist() == pytest.approx([29**0.5, 29**0.5])


def test_simplify_keeps_what_stands_out():
    path = np.array([[0, 0], [2, 0.1], [4, 0], [5, 3], [6, 0], [10, 0]], dtype=float)
    assert simplify(path, 0.5).tolist() == [[0, 0], [4, 0], [5, 3], [6, 0], [10, 0]]
    assert simplify(path, 5.0).tolist() == [[0, 0], [10, 0]]
    assert simplify(path, 0.0).tolist() == path.tolist()


def test_corners_leave_out_flat_ones():
    ring = np.array([[0, 0], [5, 0.01], [10, 0], [10, 10], [5, 10.3], [0, 10]], dtype=float)
    assert sorted(corners(ring, 0.1).tolist()) == [[0, 0], [0, 10], [10, 0], [10, 10]]


def test_turns_add_up_to_a_full_one():
    ring = np.array([[0, 0], [10, 0], [10, 10], [5, 2], [0, 10]], dtype=float)
    assert turns(ring).sum() == pytest.approx(360)
    assert (turns(ring) < 0).tolist() == [False, False, False, True, False]
    assert turns(ring)[0] == pytest.approx(90)


@pytest.mark.parametrize(
    ("point", "is_in"),
    [((1, 1), True), ((9.8, 9), True), ((5, 8), False), ((-1, 5), False), ((11, 5), False), ((5, 1), True)],
)
def test_inside_a_polygon_with_a_notch(point, is_in):
    ring = np.array([[0, 0], [10, 0], [10, 10], [5, 2], [0, 10]], dtype=float)
    assert inside(np.array(point, dtype=float), ring) is is_in
    assert inside(np.array(point, dtype=float), ring[::-1]) is is_in


@pytest.mark.parametrize(
    ("direction", "way"),
    [
        ((1, 0), 3),
        ((2, 0), 3),
        ((-1, 0), math.inf),
        ((0, 1), math.inf),
        ((24, 7), 4.8 - 2.04**0.5),
    ],
)
def test_ray_meets_a_circle(direction, way):
    found = ray_to_circle(np.zeros(2), np.array(direction, dtype=float), np.array([5.0, 0.0]), 2.0)
    assert found == pytest.approx(way)


def test_ray_from_inside_a_circle_meets_it_at_once():
    assert ray_to_circle(np.array([4.0, 1.0]), np.array([0.0, 1.0]), np.array([5.0, 0.0]), 2.0) == 0
