"""A batch of plans in columns, and a choice of its samples."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from proc3s import PlanBatch
from proc3s.state import Parameter, Signature

WIDE = Signature("wide", (Parameter("a", "float"), Parameter("p", "point")))
NARROW = Signature("narrow", (Parameter("n", "int"),))
NONE = Signature("wait", ())
SIGNATURES = (WIDE, NARROW, NONE)

skills = st.lists(st.integers(0, 2), max_size=4)


@st.composite
def batches(draw):
    """Plans of several skills, some of them empty, some samples with an error instead."""
    plans = draw(st.lists(skills, max_size=6))
    actions = [k for plan in plans for k in plan]
    widths = [SIGNATURES[k].width for k in actions]
    bad = draw(st.sets(st.integers(0, max(len(plans) - 1, 0)))) if plans else set()
    return PlanBatch(
        SIGNATURES,
        np.cumsum([0, *map(len, plans)]),
        np.array(actions, np.uint8),
        np.cumsum([0, *widths]),
        np.arange(sum(widths), dtype=float),
        errors={i: ValueError(f"sample {i}") for i in bad},
        logs={i: f"log {i}" for i in bad},
    )


@given(batches(), st.data())
def test_a_choice_has_the_plans_errors_and_logs_of_its_samples(batch, data):
    rows = sorted(data.draw(st.sets(st.integers(0, len(batch) - 1)))) if len(batch) else []
    chosen = batch.select(np.array(rows, np.intp))
    assert len(chosen) == len(rows)
    assert {rows[k]: error for k, error in chosen.errors.items()} == {
        i: error for i, error in batch.errors.items() if i in rows
    }
    assert {rows[k]: log for k, log in chosen.logs.items()} == {
        i: log for i, log in batch.logs.items() if i in rows
    }
    for k, i in enumerate(rows):
        if i not in batch.errors:
            assert chosen.plan(k) == batch.plan(i)
