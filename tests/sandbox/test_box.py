import numpy as np
import pytest

from proc3s.domain.samplers import ContinuousSampler
from proc3s.domain.values import Action, Pose
from proc3s.errors import Proc3sError
from proc3s.sandbox import (
    BoxedSketch,
    Limits,
    SketchCrash,
    SketchError,
    SketchRuntimeError,
    SketchSyntaxError,
)

from .conftest import INITIAL, LINE, cube, program


def single(box, source, **options):
    """The plan of a program without parameters."""
    return box(source, "program", **options).plans(np.empty((1, 0))).plan(0)


def test_a_sketch_becomes_plans(box):
    sketch = box(LINE)
    u = cube(700, 2)
    batch = sketch.plans(u)
    assert list(sketch.space.samplers.items()) == [
        ("x", ContinuousSampler(0, 100)),
        ("y", ContinuousSampler(20, 40)),
    ]
    assert len(batch) == 700
    assert not batch.errors
    assert batch.plan(699) == (Action("draw_line", (50.0, 50.0, 100 * u[699, 0], 20 + 20 * u[699, 1])),)


def test_several_batches_of_odd_sizes_equal_one(box):
    u = cube(600, 2)
    sketch = box(LINE)
    parts = [sketch.plans(part) for part in (u[:1], u[1:1], u[1:258], u[258:])]
    assert [len(part) for part in parts] == [1, 0, 257, 342]
    whole = box(LINE).plans(u)
    assert np.array_equal(np.concatenate([part.values for part in parts]), whole.values)


def test_u_must_fit_the_space(box):
    with pytest.raises(ValueError, match=r"shape \(n, 2\), not \(3, 1\)"):
        box(LINE).plans(cube(3, 1))


def test_discrete_choices_keep_their_types_and_parameters_their_order(box):
    sketch = box("""
        def gen_plan(state, first, *, last, mode="far"):
            assert isinstance(last, bool)
            assert mode in ("near", "far")
            return [Action("look", [(first, last + 0, 3), mode])]

        def gen_domain(state):
            return {"mode": DiscreteSampler(["near", "far"]), "last": DiscreteSampler([True, False]),
                    "first": DiscreteSampler(np.arange(3))}
    """)
    assert list(sketch.space.samplers) == ["first", "last", "mode"]
    batch = sketch.plans(np.array([[0.99, 0.0, 0.0], [0.0, 0.6, 0.6]]))
    assert batch.plan(0) == (Action("look", ((2.0, 1.0, 3.0), "near")),)
    assert batch.plan(1) == (Action("look", ((0.0, 0.0, 3.0), "far")),)


def test_a_parameter_may_be_left_to_its_default(box):
    sketch = box("""
        def gen_plan(state, a, b=7, c=0):
            return [Action("draw_line", [a, b, c, 0])]

        def gen_domain(state):
            return {"a": ContinuousSampler(1, 1), "c": ContinuousSampler(3, 3)}
    """)
    assert list(sketch.space.samplers) == ["a", "c"]
    assert sketch.plans(cube(1, 2)).plan(0)[0].args == (1.0, 7.0, 3.0, 0.0)


def test_numpy_and_python_values_of_every_type(box):
    plan = single(
        box,
        """
        def gen_plan(state):
            return (
                Action("draw_line", [np.float32(1), np.array([2]), np.array(3.5), np.int64(4)]),
                Action("draw_line", np.array([1, 2, 3, 4])),
                Action("repeat", (np.int8(3),)),
                Action("pick", [state.obstacles[1].name, Pose(1, 2, 3)]),
                Action("pick", [np.str_("object_0"), np.arange(6)]),
                Action("look", [np.array([1.5, 2, 3]), "far"]),
            )
        """,
    )
    assert [action.args for action in plan] == [
        (1.0, 2.0, 3.5, 4.0),
        (1.0, 2.0, 3.0, 4.0),
        (3,),
        ("object_1", Pose(1.0, 2.0, 3.0)),
        ("object_0", Pose(0.0, 1.0, 2.0, 3.0, 4.0, 5.0)),
        ((1.5, 2.0, 3.0), "far"),
    ]
    assert type(plan[2].args[0]) is int


def test_a_literal_plan(box):
    source = """
        gen_plan = [
            Action("draw_line", [1, 2, 3, 4]),
            Action(name="repeat", params=(2,)),
            Action("draw_line", 5, 6, 7, 8),
        ]
    """
    batch = box(source, "plan").plans(np.empty((2, 0)))
    assert batch.plan(0) == batch.plan(1)
    assert [str(a) for a in batch.plan(0)] == [
        "draw_line(1, 2, 3, 4)",
        "repeat(2)",
        "draw_line(5, 6, 7, 8)",
    ]


def test_programs_may_be_ordinary_python(box):
    plan = single(
        box,
        """
        from __future__ import annotations
        import numpy.linalg, json, collections.abc
        from functools import lru_cache
        from dataclasses import dataclass as data
        from typing import NamedTuple

        @data
        class Point:
            x: float
            y: float = field(default=0.0)

        class Pair(NamedTuple):
            a: int
            b: int

        @lru_cache
        def fib(n: int) -> int:
            return n if n < 2 else fib(n - 1) + fib(n - 2)

        def corners(size: Optional[float]) -> Iterator[Tuple[float, float]]:
            for x in (0, size):
                match x:
                    case 0: yield (x, math.sqrt(size))
                    case _: yield (numpy.linalg.norm([3, 4]), Point(1).y)

        def gen_plan(state: Scene):
            (a, b), (c, d) = corners(4.0)
            yield Action("draw_line", [a, b, c, json.loads("[9]")[0]])
            yield Action("repeat", [fib(Pair(6, 0).a)])
        """,
    )
    assert [action.args for action in plan] == [(0.0, 2.0, 5.0, 9.0), (8,)]


def test_programs_may_repeat_the_classes_of_the_prompt(box):
    redefined = """
from dataclasses import dataclass

@dataclass
class ContinuousSampler:
    min: float
    max: float

@dataclass
class Action:
    name: str
    params: list
"""
    assert not box(redefined + LINE).plans(cube(5, 2)).errors


def test_the_state_is_new_for_every_call(box):
    sketch = box("""
        def gen_plan(state, x):
            state.obstacles[0].x += 1
            state.obstacles.append(None)
            return [Action("draw_line", [state.obstacles[0].x, len(state.obstacles), 0, 0])]

        def gen_domain(state):
            state.obstacles.clear()
            return {"x": ContinuousSampler(0, 1)}
    """)
    batch = sketch.plans(cube(3, 1))
    assert {batch.plan(i)[0].args for i in range(3)} == {(51.0, 3.0, 0.0, 0.0)}


RANDOM = """
def gen_plan(state, x):
    rng = np.random.default_rng()
    return [Action("draw_line", [random.random(), np.random.rand(), rng.random(), x])]

def gen_domain(state):
    return {"x": ContinuousSampler(0, 1)}
"""


def test_random_numbers_of_a_program_repeat(box):
    u = cube(20, 1)
    first = box(RANDOM, seed=5).plans(u)
    assert np.array_equal(first.values, box(RANDOM, seed=5).plans(u).values)
    assert not np.array_equal(first.values, box(RANDOM, seed=6).plans(u).values)
    assert len({first.plan(i)[0].args[:3] for i in range(20)}) == 20
    alone = box(RANDOM, seed=5).plans(u[17:18], first=17)
    assert alone.plan(0) == first.plan(17)


def test_what_a_program_prints_is_kept_and_cut(box):
    sketch = box("""
        print("loading \\x1b[2J")
        def gen_plan(state, x):
            if x > 50:
                print("x" * 9999)
            return [Action("draw_line", [x, 0, 0, 0])]

        def gen_domain(state):
            return {"x": ContinuousSampler(0, 100)}
    """)
    assert sketch.log == "loading ?[2J\n"
    batch = sketch.plans(np.array([[0.1], [0.9]]))
    assert batch.logs == {1: "x" * 4096}
    assert not batch.errors


def test_a_sample_that_raises_is_only_a_failed_sample(box):
    sketch = box("""
        def helper(x):
            return [1, 2][int(x)]

        def gen_plan(state, x):
            helper(x)
            return [Action("draw_line", [x, 0, 0, 0])]

        def gen_domain(state):
            return {"x": ContinuousSampler(0, 4)}
    """)
    batch = sketch.plans(np.array([[0.1], [0.9], [0.2]]))
    assert list(batch.errors) == [1]
    error = batch.errors[1]
    assert isinstance(error, SketchRuntimeError)
    assert str(error) == "line 2: IndexError: list index out of range"
    assert error.source == "return [1, 2][int(x)]"
    assert batch.plan(2)[0].args[0] == pytest.approx(0.8)
    with pytest.raises(SketchRuntimeError):
        batch.plan(1)


@pytest.mark.parametrize(
    ("source", "text"),
    [
        ("def gen_plan(state:\n  pass", r"line 1: SyntaxError: "),
        ("x = 1\n  y = 2", "line 2: IndentationError: unexpected indent"),
        ("x = 1\0", "source code string cannot contain null bytes"),
        ("x = '\ud800'", "surrogates not allowed"),
        ("return 5", "line 1: SyntaxError: 'return' outside function"),
        ("(" * 5000, "SyntaxError: too many nested parentheses"),
    ],
)
def test_syntax_errors(box, source, text):
    with pytest.raises(SketchSyntaxError, match=text):
        box(source)


@pytest.mark.parametrize(
    ("source", "text"),
    [
        ("x = 1\nfoo()", "line 2: NameError: name 'foo' is not defined"),
        ("import os", "line 1: ImportError: 'os' cannot be imported here; available: .*math, .*numpy"),
        ("from . import x", "cannot be imported here"),
        ("open('/etc/passwd')", "NameError: name 'open' is not defined"),
        ("raise SystemExit(3)", "SystemExit: 3"),
        ("def f(n): return f(n)\nf(1)", "line 1: RecursionError: maximum recursion"),
        ("raise ValueError('\\ud800\\x1b\\u202e')", r"ValueError: \?\?\?"),
        (f"{LINE}\nclass Bad(Exception):\n  def __str__(self): return 1/0\nraise Bad", "cannot be shown"),
        ("def gen_plan(s): pass\ndef gen_domain(s):\n  return s.nothing", "line 3: AttributeError"),
    ],
)
def test_errors_while_loading(box, source, text):
    with pytest.raises(SketchRuntimeError, match=text):
        box(source)


def test_a_broken_prelude_is_not_the_programs_fault(box):
    with pytest.raises(Proc3sError, match="initial state do not run: NameError: name 'Sceen'"):
        box(LINE, initial="Sceen()")


def test_a_closed_box_says_so(box):
    sketch = box(LINE)
    sketch.close()
    sketch.close()
    with pytest.raises(SketchCrash, match="has ended"):
        sketch.plans(cube(1, 2))


def test_too_long_a_source_is_refused():
    with pytest.raises(SketchError, match="has 70000 bytes, at most 65536"):
        BoxedSketch(program("#" * 70000))


def test_values_out_of_range_are_found_per_sample(box):
    sketch = box("""
        def gen_plan(state, x):
            other = 0 if x < 150 else float("nan")
            return [Action("repeat", [1])] * 2 + [Action("draw_line", [0, x, 0, other])]

        def gen_domain(state):
            return {"x": ContinuousSampler(-50, 200)}
    """)
    batch = sketch.plans(np.array([[0.1], [0.3], [0.75], [0.9], [0.3]]))
    assert {i: str(error) for i, error in batch.errors.items()} == {
        0: "step 2, draw_line: y1 must lie between 0 and 100",
        2: "step 2, draw_line: y1 must lie between 0 and 100",
        3: "step 2, draw_line: y1 must lie between 0 and 100",
    }
    assert len(batch.plan(4)) == 3


BREACHES = {
    "[]": "the plan is empty",
    "None": "gen_plan returned None",
    "5": "the plan is 5, expected a list of actions",
    "[5]": "step 0 is 5, expected an Action",
    "[good, Action('jump', [])]": "step 1: unknown skill 'jump'; there is draw_line, repeat, pick, look",
    "[good] * 501": "more than 500 actions",
    "[Action('repeat', [1.5])]": "step 0, repeat: times must be a whole number",
    "[Action('repeat', [10**400])]": "times is a huge integer",
    "[Action('repeat', [True])]": "times is True, expected a number",
    "[Action('repeat', 3)]": "step 0, repeat: the values are 3, expected a list",
    "[Action('repeat', [np.zeros(2)])]": "times is of type ndarray, expected a number",
    "[Action('look', [(1, 2, 1e7), 'far'])]": r"at must be a finite number below 1e\+06",
    "[Action('look', [(1, 2), 'far'])]": "at has 2 numbers, expected 3",
    "[Action('pick', ['object_5', Pose(1, 2, 3)])]": "'object_5', .*name of an object; there is object_0",
    "[Action('pick', ['object_1', 'top'])]": "grasp is 'top', expected a grasp",
}


def test_a_breach_in_one_sample_is_that_samples_error(box):
    plans = ", ".join(f"lambda: {plan}" for plan in BREACHES)
    sketch = box(f"""
        good = Action("draw_line", [1, 2, 3, 4])
        plans = [{plans}]
        def gen_plan(state, k, other):
            return plans[k]() if other else [good]

        def gen_domain(state):
            return {{"k": DiscreteSampler(range({len(BREACHES)})), "other": DiscreteSampler([True, False])}}
    """)
    k = (np.arange(len(BREACHES)) + 0.5) / len(BREACHES)
    batch = sketch.plans(np.stack([k, np.zeros_like(k)], axis=1))
    for i, text in enumerate(BREACHES.values()):
        with pytest.raises(SketchError, match=text) as caught:
            batch.plan(i)
        assert caught.value.kind == "SketchContractError"
        assert "Unfit" not in str(caught.value)
    assert not sketch.plans(np.stack([k, np.ones_like(k) * 0.9], axis=1)).errors


def test_limits_are_settings(box):
    source = LINE.replace("return [", "return 3 * [")
    with pytest.raises(SketchError, match="more than 2 actions"):
        box(source, limits=Limits(actions=2))
    assert len(box(source, limits=Limits(actions=3)).plans(cube(1, 2)).plan(0)) == 3


def test_the_state_can_be_any_expression(box):
    state = INITIAL.replace("obstacles=[", "obstacles=[Obstacle(name='z', x=CANVAS, y=1e-3), ")
    assert box(LINE, initial=state).plans(cube(1, 2)).plan(0)[0].args[:2] == (100.0, 0.001)
