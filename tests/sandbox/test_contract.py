import pytest

from proc3s.sandbox import SketchContractError

from .conftest import LINE, cube


def issues(box, source, answer="sketch"):
    """(line, message) of everything that is wrong with a program."""
    with pytest.raises(SketchContractError) as caught:
        box(source, answer)
    error = caught.value
    assert error.done is None
    if len(error.issues) == 1:
        assert (error.message, error.line) == (error.issues[0].message, error.issues[0].line)
    return [(issue.line, issue.message) for issue in error.issues]


def with_sampler(expression):
    return f"""
def gen_plan(state, x):
    return [Action("draw_line", [1, 2, 3, 4])]

def gen_domain(state):
    domain = {{}}
    domain["x"] = {expression}
    return domain
"""


def test_all_problems_at_once_with_lines(box):
    source = """
        def gen_plan(state, a, b, size, *rest):
            plan = [Action("draw_lines", [a, b, 3, 4])]
            plan.append(
                Action("draw_line", [1, 2, 3]))
            plan.append(Action("pick", ["object_7", Pose(1, 2, 3)]))
            plan.append(Action("draw_line", [size, "1", math.inf, [0]]))
            return plan

        def gen_domain(state):
            return {
                "a": ContinuousSampler(5, 1),
                "bb": ContinuousSampler(0, 1),
                "size": DiscreteSampler([[1, 2], [3, 4]]),
            }
    """
    assert issues(box, source) == [
        (1, "gen_plan must name its parameters, *rest is not allowed"),
        (1, "parameter 'b' of gen_plan has no sampler in gen_domain"),
        (2, "step 0: unknown skill 'draw_lines'; did you mean 'draw_line'?"),
        (4, "step 1: draw_line takes 4 values (x1, y1, x2, y2), got 3"),
        (5, "step 2, pick: item is 'object_7', expected the name of an object; there is object_0, object_1"),
        (6, "step 3, draw_line: y1 is '1', expected a number"),
        (6, "step 3, draw_line: x2 is inf, expected a finite number"),
        (6, "step 3, draw_line: y2 is of type list, expected a number"),
        (11, "gen_domain: a: min 5 is above max 1"),
        (12, "gen_domain names 'bb', which is no parameter of gen_plan; did you mean 'b'?"),
        (13, "gen_domain: size has a list among its values, expected numbers, strings or True/False"),
    ]


def test_source_lines_are_quoted(box):
    with pytest.raises(SketchContractError) as caught:
        box(with_sampler("5"))
    assert caught.value.source == caught.value.issues[0].source == 'domain["x"] = 5'
    assert str(caught.value) == (
        "line 6: gen_domain: x is 5, expected a sampler (ContinuousSampler, DiscreteSampler)"
    )


def test_missing_functions(box):
    assert issues(box, "def make(state):\n    pass\ngen_domain = 3") == [
        (None, "the program does not define gen_plan"),
        (3, "gen_domain is 3, expected a function"),
    ]
    assert issues(box, "def genplan(s): pass\ndef gen_domain(s): return {}") == [
        (None, "the program does not define gen_plan; did you mean 'genplan'?")
    ]


SAMPLERS = {
    "ContinuousSampler(0, float('nan'))": " has max nan, expected a finite number",
    "ContinuousSampler('0', 1)": " has min '0', expected a number",
    "ContinuousSampler(0, 10**400)": " has max inf, expected a finite number",
    "ContinuousSampler([0], 1)": " has min a list, expected a number",
    "ContinuousSampler(2, 1)": ": min 2 is above max 1",
    "ContinuousSampler": " is the class ContinuousSampler itself, expected a sampler",
    "(0, 1)": " is a tuple, expected a sampler (ContinuousSampler, DiscreteSampler)",
    "DiscreteSampler([])": ": needs at least one value",
    "DiscreteSampler('abc')": " has values 'abc', expected a list",
    "DiscreteSampler([1, None])": " has None among its values, expected numbers, strings or True/False",
    "DiscreteSampler([1, float('inf')])": " has inf among its values, expected finite numbers",
    "DiscreteSampler(range(1001))": " has more than 1000 values",
    "DiscreteSampler([{}])": " has a dict among its values, expected numbers, strings or True/False",
    "DiscreteSampler(['x' * 201])": " has a text of more than 200 characters among its values",
    "DiscreteSampler([2**70])": " has a huge integer among its values",
}


def test_samplers(box):
    names = [f"p{i}" for i in range(len(SAMPLERS))]
    entries = "".join(f"        {name}={text},\n" for name, text in zip(names, SAMPLERS, strict=True))
    source = f"def gen_plan(state, {', '.join(names)}):\n    return 1/0\n\n"
    source += f"def gen_domain(state):\n    return dict(\n{entries}    )"
    for i, (found, text) in enumerate(zip(issues(box, source), SAMPLERS.values(), strict=True)):
        line, message = found
        assert line == 6 + i
        assert message.startswith(f"gen_domain: p{i}{text}")


@pytest.mark.parametrize(
    ("source", "line", "text"),
    [
        (
            LINE.replace('return {"x"', 'return [{"x"').replace("40)}", "40)}]"),
            5,
            "gen_domain returned a list",
        ),
        (
            "def gen_plan(): pass\ndef gen_domain(s): return {}",
            1,
            "must take the state as its first parameter",
        ),
        ("def gen_plan(s, x): pass\n\ndef gen_domain(): return {}", 3, "must take the state as its only"),
        ("def gen_plan(s, **k): pass\ndef gen_domain(s): return {}", 1, "**k is not allowed"),
        (
            "def gen_plan(s): pass\ndef gen_domain(s): return {}",
            1,
            "returned None (is `return plan` missing?)",
        ),
        ("def gen_plan(s): return ()\ndef gen_domain(s): return {}", 1, "the plan is empty"),
        ("def gen_plan(s): return 'up'\ndef gen_domain(s): return {1: 2}", 2, "gen_domain names 1, which"),
    ],
)
def test_sketches(box, source, line, text):
    assert any(found == line and text in message for found, message in issues(box, source))


def test_program_answers_take_the_state_alone(box):
    [(line, text)] = issues(box, "def gen_plan(state, x, y=1): return []", "program")
    assert (line, text) == (1, "gen_plan must take the state and nothing else, not x")


def test_plan_answers_are_lists(box):
    hint = "gen_plan must be a list of actions: gen_plan = [Action(...), ...]"
    assert issues(box, "def gen_plan(state): return []", "plan") == [(1, hint)]
    assert issues(box, "plan = []", "plan") == [(None, hint)]
    assert issues(box, "gen_plan = []", "plan") == [(1, "the plan is empty")]
    source = 'gen_plan = [\n  Action("draw_line", [1, 2, 3, 4]),\n  Action("draw_line", 1, 2),\n]'
    assert issues(box, source, "plan") == [(3, "step 1: draw_line takes 4 values (x1, y1, x2, y2), got 2")]


def test_problems_in_thousands_are_cut(box):
    many = "[Action('hop', [])] * 400"
    source = with_sampler("ContinuousSampler(0, 1)").replace('[Action("draw_line", [1, 2, 3, 4])]', many)
    assert len(issues(box, source)) == 20
    names = ", ".join(f"p{i}" for i in range(300))
    found = issues(box, f"def gen_plan(state, {names}): pass\ndef gen_domain(s): return {{}}")
    assert (1, "gen_plan has 300 parameters, at most 256 are possible") in found


def test_an_exception_in_the_probe_is_no_breach(box):
    source = LINE.replace("o = state", "assert x < 50\n    o = state")
    batch = box(source).plans(cube(200, 2))
    assert 50 < len(batch.errors) < 150
    assert {error.line for error in batch.errors.values()} == {2}


def test_what_the_probe_prints_is_in_no_log(box):
    sketch = box(LINE.replace("    o = state", "    print('called')\n    o = state"))
    assert sketch.log == ""
    assert sketch.plans(cube(2, 2)).logs == {0: "called\n", 1: "called\n"}


def test_too_large_a_domain_is_the_programs_fault(box):
    values = "DiscreteSampler(['x' * 199 + chr(65 + i % 26) for i in range(1000)])"
    source = f"def gen_plan(state, x, y): pass\ndef gen_domain(s): return dict(x={values}, y={values})"
    with pytest.raises(SketchContractError, match="gen_domain holds too many values"):
        box(source)
