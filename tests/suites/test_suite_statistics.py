"""The statistics of the tables against scipy's, and against published values."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from proc3s.suites.statistics import mean_std, paired_means, paired_proportions, wilson, worse

COUNTS = st.integers(1, 60).flatmap(lambda n: st.tuples(st.integers(0, n), st.just(n)))


@given(COUNTS)
def test_wilsons_interval_is_scipys(counts):
    share = wilson(*counts)
    theirs = stats.binomtest(*counts).proportion_ci(0.95, "wilson")
    assert (share.low, share.high) == pytest.approx((theirs.low, theirs.high), abs=1e-9)
    assert share.low <= share.value <= share.high


def test_wilsons_interval_of_a_textbook():
    """Newcombe 1998, table I: 81 of 263, and 15 of 148."""
    assert wilson(81, 263)[1:] == pytest.approx((0.2553, 0.3662), abs=5e-5)
    assert wilson(15, 148)[1:] == pytest.approx((0.0624, 0.1605), abs=5e-5)


@given(COUNTS, COUNTS)
def test_the_z_test_is_half_of_the_chi_square_test(one, other):
    """The square of z is chi-square of the 2 x 2 table (without continuity correction)."""
    (a, n), (b, m) = one, other
    table = np.array([[a, n - a], [b, m - b]])
    p = worse(a, n, b, m)
    if (table.sum(axis=0) == 0).any():
        assert p == 0.5
        return
    two_sided = stats.chi2_contingency(table, correction=False).pvalue
    assert min(p, 1 - p) == pytest.approx(two_sided / 2, abs=1e-9)
    assert (p < 0.5) == (a * m < b * n) or p == pytest.approx(0.5)


def test_four_of_ten_are_worse_than_eight_of_ten_at_a_tenth_and_seven_are_not():
    assert worse(4, 10, 8, 10) == pytest.approx(0.0339, abs=1e-4)
    assert worse(7, 10, 8, 10) > 0.1


@given(st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=30))
def test_mean_and_deviation_are_numpys(values):
    assert mean_std(values) == pytest.approx((np.mean(values), np.std(values, ddof=1)), abs=1e-6, rel=1e-9)


def test_one_value_does_not_deviate():
    assert mean_std([3.0]) == (3.0, 0.0)


def test_a_paired_difference_by_hand():
    """4 won, 1 lost, 5 alike: (5 - 2)/12 = 0.25 with a half-width of 1.96 sqrt((7/12 - 1/16)/12)."""
    pairs = [(False, True)] * 4 + [(True, False)] + [(True, True)] * 5
    found = paired_proportions(pairs)
    assert found == pytest.approx((0.3, 0.25 - 0.4083, 0.25 + 0.4083), abs=1e-4)


def test_the_interval_of_a_paired_difference_covers_the_truth():
    rng = np.random.default_rng(0)
    covered = 0
    for _ in range(400):
        first = rng.random(20) < 0.4
        second = first ^ (rng.random(20) < np.where(first, 0.1, 0.4))
        truth = 0.6 * 0.4 - 0.4 * 0.1
        found = paired_proportions(list(zip(first.tolist(), second.tolist(), strict=True)))
        covered += found.low <= truth <= found.high
    assert covered / 400 > 0.92


def test_the_interval_of_a_mean_is_about_that_of_students_t():
    values = np.random.default_rng(1).normal(2.0, 1.0, 200).tolist()
    found = paired_means(values)
    theirs = stats.t.interval(0.95, len(values) - 1, np.mean(values), stats.sem(values))
    assert found == pytest.approx((np.mean(values), *theirs), abs=0.02)
    assert paired_means(values) == found


def test_nothing_has_no_statistics():
    with pytest.raises(ValueError, match="trials"):
        wilson(0, 0)
    with pytest.raises(ValueError, match="pairs"):
        paired_proportions([])
