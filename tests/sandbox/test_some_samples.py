"""What fails in some samples is their failure; what fails in all of several draws is the program's."""

import numpy as np
import pytest

from proc3s.sandbox import Limits, SketchContractError, SketchCrash, SketchMemoryError, SketchTimeout

from .conftest import cube

SHORT = Limits(call=0.3)


def unless(condition, what, domain="ContinuousSampler(0, 100)"):
    """A sketch that draws a line where a condition on x holds, and else does something else."""
    return f"""
def gen_plan(state, x):
    if not ({condition}):
        {what}
    return [Action("draw_line", [1, 2, 3, 4])]

def gen_domain(state):
    return {{"x": {domain}}}
"""


FAULTS = {
    "return []": "the plan is empty",
    "return None": "gen_plan returned None",
    "return [Action('draw_line', [1, 2, 3, float('nan')])]": "finite number",
    "return [Action('hop', [])]": "unknown skill 'hop'",
    "return [Action('draw_line', [1])]": "draw_line takes 4 values",
    "return [Action('draw_line', [1, 2, 3, 4])] * 501": "more than 500 actions",
    "return 'up'": "the plan is 'up'",
    "return [3]": "is 3, expected an Action",
}


@pytest.mark.parametrize("what", FAULTS)
def test_a_fault_in_the_middle_alone_is_that_of_some_samples(box, what):
    sketch = box(unless("x < 40 or x > 60", what))
    batch = sketch.plans(np.linspace(0.05, 0.95, 10)[:, None])
    assert sorted(batch.errors) == [4, 5]
    assert FAULTS[what] in batch.errors[4].message


@pytest.mark.parametrize("what", FAULTS)
def test_a_fault_of_all_draws_is_the_programs(box, what):
    with pytest.raises(SketchContractError, match=FAULTS[what].replace("'", ".")):
        box(unless("False", what))


def test_the_middle_choice_is_one_of_several(box):
    source = unless("x != 'b'", "return []", "DiscreteSampler(['a', 'b', 'c'])")
    assert [*box(source).plans(np.array([[0.1], [0.5], [0.9]])).errors] == [1]


def test_a_fault_by_chance_is_that_of_some_samples(box):
    batch = box(unless("random.random() < 0.5", "return []")).plans(cube(40, 1))
    assert 5 < len(batch.errors) < 35


def test_numbers_in_a_message_make_no_other_fault(box):
    plan = "return [Action('draw_line', [1, 2, 3, 4])] * int(1 + x) + [Action('hop', [])]"
    with pytest.raises(SketchContractError, match="unknown skill 'hop'"):
        box(unless("False", plan, "ContinuousSampler(0, 30)"))


HANG = "while True: pass"
CRASH = "np.lib.stride_tricks.as_strided(np.zeros(1), (10**6,), (4096,)).sum()"
HOG = "hog = bytearray(10**12)"


@pytest.mark.parametrize(
    ("what", "kind"), [(HANG, SketchTimeout), (CRASH, SketchCrash), (HOG, SketchMemoryError)]
)
def test_a_sample_that_takes_its_process_with_it_fails_alone(box, what, kind):
    sketch = box(unless("x < 40 or x > 42", what), limits=SHORT)
    u = np.array([0.1, 0.41, 0.2, 0.3, 0.411, 0.7])[:, None]
    batch = sketch.plans(u)
    assert {i: type(error) for i, error in batch.errors.items()} == {1: kind, 4: kind}
    assert batch.errors[1].line == 3
    assert [len(batch.plan(i)) for i in (0, 2, 3, 5)] == [1, 1, 1, 1]


def test_a_hang_in_the_middle_alone_ends_nothing(box):
    sketch = box(unless("x < 40 or x > 60", HANG), limits=SHORT)
    assert not sketch.plans(np.array([[0.1], [0.9]])).errors


def test_the_samples_after_a_hang_are_what_they_were_without_it(box):
    source = unless("x != 50", HANG).replace("3, 4])", "3, random.random()])")
    u = cube(600, 1)
    hung = u.copy()
    hung[300] = 0.5
    one, other = box(source, limits=SHORT).plans(u), box(source, limits=SHORT).plans(hung)
    assert [*other.errors] == [300]
    assert all(one.plan(i) == other.plan(i) for i in range(600) if i != 300)


def test_a_program_that_always_hangs_is_refused_after_three_draws(box):
    with pytest.raises(SketchTimeout, match=r"longer than 0\.3 s, in all of 3 samples"):
        box(unless("False", HANG), limits=SHORT)


def test_a_program_that_hangs_often_is_given_up(box):
    sketch = box(unless("0.2 < x % 1 ", HANG), limits=SHORT)
    with pytest.raises(SketchTimeout, match="as 3 samples had before") as caught:
        sketch.plans(cube(1000, 1))
    assert len(caught.value.done.errors) == 3
    assert len(caught.value.done) < 30


@pytest.mark.slow
def test_one_in_twenty_may_hang_up_to_a_limit(box):
    sketch = box(
        unless("x % 10", HANG, "DiscreteSampler(range(1000))"),
        limits=Limits(call=0.05, restarts=5),
    )
    u = (np.arange(1, 1000)[:, None] + 0.5) / 1000
    with pytest.raises(SketchTimeout, match="as 3 samples had before"):
        sketch.plans(u)
    rare = unless("x % 100", HANG, "DiscreteSampler(range(1000))")
    with pytest.raises(SketchTimeout, match="as 5 samples had before") as caught:
        box(rare, limits=Limits(call=0.05, restarts=5)).plans(u)
    assert [*caught.value.done.errors] == [99, 199, 299, 399, 499]
    assert len(caught.value.done) == 599


def test_a_program_that_changes_its_mind_in_a_fresh_process_is_told_so(box):
    source = unless("x < 40 or x > 42", HANG, "ContinuousSampler(0, 100 + random.SystemRandom().random())")
    with pytest.raises(SketchContractError, match="gen_domain gave other samplers") as caught:
        box(source, limits=SHORT).plans(np.array([[0.1], [0.41], [0.5]]))
    assert [*caught.value.done.errors] == [1]
