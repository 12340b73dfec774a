"""The same program, state, parameters and seed give the same plan in a fresh worker."""

import numpy as np
import pytest

from proc3s.sandbox import BoxedSketch

from .conftest import cube, program

EVERY_RANDOMNESS = """
import copy

class Thing:
    pass

def gen_plan(state, x):
    own, rng = random.Random(), np.random.default_rng()
    values = [random.random(), random.uniform(0, 1), np.random.rand(), np.random.normal(0.5, 0.1),
              own.random(), rng.random(), np.random.Generator(np.random.PCG64()).random(),
              np.random.RandomState().rand(), random.choice([0.25, 0.5]), rng.choice([0.25, 0.5])]
    random.seed()
    np.random.seed()
    values += [random.random(), np.random.rand()]
    names = {"b", "a", "d", "c", "gamma", "beta"}
    order = [sorted(names).index(name) for name in names] + list({name: 1 for name in names}.values())
    order += [random.sample(range(9), 1)[0], hash("text") % 7, hash((1.5, "a")) % 7]
    values += [abs(v) % 10 for v in order]
    random.shuffle(values)
    return [Action("draw_line", [x, *values[i : i + 3]]) for i in range(0, len(values) - 2, 3)]

def gen_domain(state):
    return {"x": ContinuousSampler(0, 1)}
"""


def values(source, u, first=None):
    with BoxedSketch(program(source, seed=3)) as sketch:
        batch = sketch.plans(u, first)
        assert not batch.errors
        return batch.values


def test_random_numbers_and_orders_repeat():
    u = cube(40, 1)
    whole = values(EVERY_RANDOMNESS, u)
    assert np.array_equal(whole, values(EVERY_RANDOMNESS, u))
    assert len(np.unique(whole)) > 100
    # one sample of many, as the winner is run again
    alone = values(EVERY_RANDOMNESS, u[31:32], first=31)
    assert np.array_equal(alone, whole[31 * len(alone) : 32 * len(alone)])


@pytest.mark.parametrize(
    "number",
    ["id(object()) % 99991 / 1000", "random._os.sys.modules['time'].time_ns() % 99991 / 1000", "count / 100"],
)
def test_what_cannot_repeat_is_noticed_by_a_second_run(number):
    source = f"""
count = 0
def gen_plan(state):
    global count
    count += 1
    return [Action("draw_line", [{number}, 1, 1, 1])]
"""
    u = np.empty((20, 0))
    with BoxedSketch(program(source, "program")) as sketch:
        winner = sketch.plans(u).plan(17)
    plans = set()
    for _ in range(3):
        with BoxedSketch(program(source, "program")) as sketch:
            plans.add(sketch.plans(u[17:18], first=17).plan(0))
    assert plans != {winner}
