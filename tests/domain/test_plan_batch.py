"""Some plans of a batch, taken out of it, are the same plans."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from proc3s import Pose
from proc3s.domain.plan_batch import Parameter, Signature
from toy_world import columns

SIGNATURES = (
    Signature("wait", ()),
    Signature("slide", (Parameter("bead", "object", choices=("a", "b", "c")), Parameter("by", "float"))),
    Signature("turn", (Parameter("to", "pose"), Parameter("times", "int"))),
    Signature("touch", (Parameter("at", "point"), Parameter("how", "str", choices=("softly", "hard")))),
)

numbers = st.floats(-100, 100)
points = st.tuples(*[numbers] * 3)
poses = st.builds(Pose, *[numbers] * 6)
actions = st.one_of(
    st.tuples(st.just("wait")),
    st.tuples(st.just("slide"), st.sampled_from("abc"), numbers),
    st.tuples(st.just("turn"), poses, st.integers(0, 9)),
    st.tuples(st.just("touch"), points, st.sampled_from(["softly", "hard"])),
)
plans = st.lists(st.none() | st.lists(actions, max_size=5), max_size=8)


def batch_of(drawn):
    """A batch in which None is a sample that failed with an error of its own, and has a log."""
    failed = [i for i, plan in enumerate(drawn) if plan is None]
    batch = columns(SIGNATURES, drawn, {i: ValueError(f"sample {i}") for i in failed})
    return dataclasses.replace(batch, logs={i: f"log {i}" for i in range(0, len(drawn), 2)})


def outcome(batch, i):
    """The plan of a sample, or the very error that it raises."""
    try:
        return batch.plan(i)
    except ValueError as error:
        return error


def chosen(draw, drawn):
    rows = draw(st.lists(st.booleans(), min_size=len(drawn), max_size=len(drawn)))
    return np.flatnonzero(rows)


@given(st.data(), plans)
def test_selected_plans_are_those_of_the_batch(data, drawn):
    batch = batch_of(drawn)
    rows = chosen(data.draw, drawn)
    picked = batch.select(rows)
    assert len(picked) == len(rows)
    assert [outcome(picked, k) for k in range(len(rows))] == [outcome(batch, i) for i in rows.tolist()]


@given(st.data(), plans)
def test_errors_and_logs_go_with_their_samples(data, drawn):
    batch = batch_of(drawn)
    rows = chosen(data.draw, drawn).tolist()
    picked = batch.select(np.array(rows, dtype=np.intp))
    assert picked.errors == {k: batch.errors[i] for k, i in enumerate(rows) if i in batch.errors}
    assert picked.logs == {k: batch.logs[i] for k, i in enumerate(rows) if i in batch.logs}


@given(st.data(), plans)
def test_a_selection_of_a_selection_is_a_selection(data, drawn):
    batch = batch_of(drawn)
    first = chosen(data.draw, drawn)
    second = chosen(data.draw, first)
    twice, once = batch.select(first).select(second), batch.select(first[second])
    for name in ("start", "skill", "offset", "values"):
        np.testing.assert_array_equal(getattr(twice, name), getattr(once, name))
        assert getattr(twice, name).dtype.kind == getattr(batch, name).dtype.kind


@given(plans)
def test_all_of_a_batch_is_the_batch(drawn):
    batch = batch_of(drawn)
    assert batch.select(np.arange(len(batch))) is batch


@given(plans)
def test_none_of_a_batch_is_an_empty_batch(drawn):
    empty = batch_of(drawn).select(np.zeros(0, np.intp))
    assert (len(empty), len(empty.skill), len(empty.values)) == (0, 0, 0)
    assert empty.start.tolist() == empty.offset.tolist() == [0]
    assert (dict(empty.errors), dict(empty.logs)) == ({}, {})


def test_a_batch_of_plans_without_values_keeps_their_lengths():
    batch = batch_of([[("wait",)], [], [("wait",), ("wait",)]])
    picked = batch.select(np.array([1, 2]))
    assert [len(picked.plan(k)) for k in range(2)] == [0, 2]


def test_a_sample_that_failed_still_raises_its_error():
    picked = batch_of([[("wait",)], None]).select(np.array([1]))
    with pytest.raises(ValueError, match="sample 1"):
        picked.plan(0)
