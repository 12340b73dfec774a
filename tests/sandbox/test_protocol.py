"""Whatever bytes a worker sends, the trusted side ends up with checked data or one typed error."""

import json
import struct
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from proc3s.domain.plan_batch import Parameter, PlanBatch, Signature
from proc3s.sandbox.boxed.wire import ERROR, LOADED, LOG, PLAN, READY, REPLY
from proc3s.sandbox.columns import Columns
from proc3s.sandbox.errors import SketchContractError, SketchError, SketchMemoryError
from proc3s.sandbox.limits import Limits
from proc3s.sandbox.protocol import CONTENTS, FAULT, PROBLEMS, TEXT, Malformed, Replies, frame_of, parse
from proc3s.sandbox.text import Source

from .conftest import SIGNATURES

COLUMNS = Columns(SIGNATURES)
SOURCE = Source("a\nb")
FRAME = 2000
LIMITS = Limits(frame=FRAME, actions=20)


def frame(sample, kind, body, actions=0):
    return REPLY.pack(sample, kind, actions, len(body)) + body


def plan(sample, skills, values):
    return frame(sample, PLAN, bytes(skills) + struct.pack(f"<{len(values)}d", *values), len(skills))


def fault(kind="runtime", message="boom", line=2):
    return json.dumps({"kind": kind, "message": message, "line": line}).encode()


numbers = st.one_of(st.floats(), st.integers(-9, 9).map(float))


@st.composite
def frames(draw, sample):
    """One frame for a sample: mostly one that an honest worker might send."""
    shape = draw(st.integers(0, 9))
    if shape < 6:
        skills = draw(st.lists(st.integers(0, 3), max_size=4))
        width = sum(SIGNATURES[k].width for k in skills)
        return plan(sample, skills, draw(st.lists(numbers, min_size=width, max_size=width)))
    if shape == 6:
        return frame(sample, ERROR, fault(message=draw(st.text(max_size=9)), line=draw(st.integers(1, 9))))
    if shape == 7:
        return frame(sample, LOG, json.dumps(draw(st.text(max_size=9))).encode())
    if shape == 8:
        return plan(
            sample, draw(st.lists(st.integers(0, 255), max_size=4)), draw(st.lists(numbers, max_size=9))
        )
    return draw(st.binary(max_size=40))


@st.composite
def streams(draw):
    return [draw(frames(i)) for i in range(draw(st.integers(0, 8)))]


def is_sound(batch: PlanBatch):
    """What everyone behind the box relies on."""
    assert batch.start[0] == 0
    assert len(batch.skill) == batch.start[-1] == len(batch.offset) - 1
    assert len(batch.values) == batch.offset[-1]
    assert set(batch.errors) | set(batch.logs) <= set(range(len(batch)))
    for i in range(len(batch)):
        if i in batch.errors:
            assert isinstance(batch.errors[i], SketchError)
            continue
        assert batch.plan(i)
        values = batch.values[batch.offset[batch.start[i]] : batch.offset[batch.start[i + 1]]]
        assert np.all(np.abs(values) < 1e6)
        for action in batch.plan(i):
            params = next(s.params for s in SIGNATURES if s.skill == action.skill)
            for value, param in zip(action.args, params, strict=True):
                assert value in param.choices if param.choices else True
                assert param.low <= value <= param.high if param.type in ("float", "int") else True


@settings(max_examples=150, deadline=None)
@given(streams(), st.lists(st.integers(0, 400), max_size=4), st.integers(0, 8))
def test_any_stream_ends_in_a_sound_batch_or_one_error(stream, cuts, count):
    data = b"".join(stream)
    replies = Replies(0, count, SOURCE, LIMITS)
    edges = [0, *sorted(cuts), len(data)]
    try:
        for a, z in pairwise(edges):
            replies.feed(data[a:z])
    except (Malformed, SketchContractError, SketchMemoryError):
        assert replies.done <= count
    batch = COLUMNS.batch(replies)
    assert len(batch) <= replies.done <= count
    is_sound(batch)


@settings(max_examples=100, deadline=None)
@given(st.binary(max_size=80))
def test_any_bytes_are_no_frame_or_a_bounded_one(data):
    for kinds in ((READY,), (LOADED, ERROR)):
        try:
            found = frame_of(data, kinds, LIMITS)
        except Malformed:
            continue
        assert found is None or (found[0] in kinds and len(found[1]) <= FRAME)


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=9), inner, max_size=4),
    max_leaves=12,
)


@settings(max_examples=100, deadline=None)
@given(st.one_of(st.binary(max_size=60), JSON.map(lambda value: json.dumps(value).encode())))
def test_any_json_is_parsed_or_malformed(body):
    for adapter in (CONTENTS, FAULT, PROBLEMS, TEXT):
        try:
            parse(adapter, body)
        except Malformed:
            continue


@pytest.mark.parametrize("cut", range(1, 80, 7))
def test_frames_may_arrive_in_pieces(cut):
    data = plan(5, [0], [1, 2, 3, 4]) + frame(6, LOG, b'"hi"') + frame(6, ERROR, fault()) + plan(7, [1], [3])
    replies = Replies(5, 3, SOURCE, LIMITS)
    replies.feed(data[:cut])
    replies.feed(data[cut:])
    batch = COLUMNS.batch(replies)
    assert [str(action) for action in batch.plan(0) + batch.plan(2)] == [
        "draw_line(1, 2, 3, 4)",
        "repeat(3)",
    ]
    assert batch.logs == {1: "hi"}
    assert (str(batch.errors[1]), batch.errors[1].source) == ("line 2: boom", "b")


@pytest.mark.parametrize(
    "forged",
    [
        plan(1, [1], [3]),
        plan(0, [1] * 21, [3] * 21),
        frame(0, PLAN, bytes(9), 2),
        frame(0, PLAN, bytes(8), 9),
        REPLY.pack(0, PLAN, 0, 2**31),
        frame(0, 99, b""),
        frame(0, READY, b'""'),
        frame(0, ERROR, fault(), actions=1),
        frame(0, ERROR, fault(line=float("nan"))),
        frame(0, ERROR, fault().replace(b"2", b"1e999")),
        frame(0, ERROR, fault().replace(b"2", b"9" * 1500)),
        frame(0, ERROR, fault(line=-5)),
        frame(0, ERROR, fault(line=True)),
        frame(0, ERROR, fault(message="\ud800")),
        frame(0, ERROR, fault().replace(b"boom", b"\xff")),
        frame(0, ERROR, fault("prelude")),
        frame(0, ERROR, fault("os")),
        frame(0, ERROR, b"[" * 1900),
        frame(0, ERROR, b"{}"),
        frame(0, LOG, b"[]"),
        frame(0, LOG, b'""') * 2,
        plan(0, [1], [3]) + plan(0, [1], [3]),
        plan(0, [1], [3]) + b"\0",
    ],
)
def test_forged_frames(forged):
    with pytest.raises(Malformed):
        Replies(0, 1, SOURCE, LIMITS).feed(forged)


def test_a_line_that_the_program_does_not_have_is_dropped():
    replies = Replies(0, 1, SOURCE, LIMITS)
    replies.feed(frame(0, ERROR, fault(line=3)))
    assert (replies.errors[0].line, replies.errors[0].source) == (None, None)


def test_memory_ends_the_batch_and_keeps_what_came_before():
    replies = Replies(0, 3, SOURCE, LIMITS)
    with pytest.raises(SketchMemoryError):
        replies.feed(plan(0, [1], [3]) + frame(1, ERROR, fault("memory")))
    assert len(COLUMNS.batch(replies)) == 1


def test_the_batch_ends_before_a_plan_that_does_not_fit_its_skills():
    for dishonest in (plan(1, [0], [1, 2, 3]), plan(1, [9], [1]), plan(1, [0, 200], [1, 2, 3, 4])):
        replies = Replies(0, 3, SOURCE, LIMITS)
        replies.feed(plan(0, [1], [3]) + dishonest + plan(2, [1], [3]))
        assert (replies.done, len(COLUMNS.batch(replies))) == (3, 1)


@pytest.mark.parametrize(
    ("low", "high", "value", "text"),
    [
        (0, 1, 2.0, "x must lie between 0 and 1"),
        (0, 100, 100.00000001, "x must lie between 0 and 100"),
        (-np.inf, 1, 2.5, "x must be at most 1"),
        (0, np.inf, -0.25, "x must be at least 0"),
        (-np.inf, np.inf, -2e6, "x must be a finite number below 1e+06"),
        (-np.inf, np.inf, np.nan, "x must be a finite number below 1e+06"),
    ],
)
def test_ranges(low, high, value, text):
    replies = Replies(0, 1, SOURCE, LIMITS)
    replies.feed(plan(0, [0], [value]))
    batch = Columns((Signature("go", (Parameter("x", "float", low, high),)),)).batch(replies)
    assert str(batch.errors[0]) == f"step 0, go: {text}"


def test_only_the_first_illegal_value_of_a_sample_is_named():
    replies = Replies(0, 2, SOURCE, LIMITS)
    replies.feed(plan(0, [1, 0], [1, 0, 500, 600, 0]) + plan(1, [1, 1], [2.5, 99]))
    assert [str(error) for error in COLUMNS.batch(replies).errors.values()] == [
        "step 1, draw_line: y1 must lie between 0 and 100",
        "step 0, repeat: times must be a whole number",
    ]


def test_names_are_indices_into_our_own_table():
    for index in (-1.0, 2.0, 0.5, np.nan):
        replies = Replies(0, 1, SOURCE, LIMITS)
        replies.feed(plan(0, [3], [1, 2, 3, index]))
        assert "look: mode must be " in str(COLUMNS.batch(replies).errors[0])
