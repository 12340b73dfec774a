"""Six numbers and matrices: the same transforms, composed the same."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from proc3s.domain.transforms import compose, matrices, numbers

LENGTH, TURN = st.floats(-2, 2), st.floats(-math.pi, math.pi)
POSES = st.tuples(LENGTH, LENGTH, LENGTH, TURN, TURN, TURN).map(np.array)


@given(POSES)
def test_the_numbers_of_a_matrix_make_that_matrix(pose):
    assert matrices(numbers(matrices(pose))) == pytest.approx(matrices(pose), abs=1e-6)


@given(POSES, POSES, POSES)
def test_composing_is_associative_and_that_of_matrices(a, b, c):
    left, right = compose(compose(a, b), c), compose(a, compose(b, c))
    assert matrices(left) == pytest.approx(matrices(right), abs=1e-6)
    assert matrices(left) == pytest.approx(matrices(a) @ matrices(b) @ matrices(c), abs=1e-6)


def test_roll_pitch_and_yaw_turn_about_the_fixed_axes_in_this_order():
    quarter = math.pi / 2
    x, z = np.array([1.0, 0, 0, 1]), np.array([0, 0, 1.0, 1])
    assert matrices(np.array([0, 0, 0, 0, 0, quarter])) @ x == pytest.approx([0, 1, 0, 1])
    assert matrices(np.array([0, 0, 0, 0, quarter, 0])) @ z == pytest.approx([1, 0, 0, 1])
    assert matrices(np.array([0, 0, 0, quarter, 0, quarter])) @ z == pytest.approx([1, 0, 0, 1])
    assert matrices(np.array([1, 2, 3, 0, quarter, quarter])) @ z == pytest.approx([1, 3, 3, 1])


def test_many_at_once_are_as_one_by_one():
    rng = np.random.default_rng(0)
    a, b = rng.uniform(-1, 1, (2, 7, 6))
    assert compose(a, b) == pytest.approx(np.array([compose(x, y) for x, y in zip(a, b, strict=True)]))
