"""Modules that programs of ordinary habits import, and names that look alike."""

import pytest

from proc3s.sandbox import SketchContractError, SketchRuntimeError

from .conftest import LINE, cube

USES = {
    "cmath": "cmath.rect(1.0, 0.0).real",
    "contextlib": "float(contextlib.nullcontext(3).enter_result)",
    "decimal": "decimal.Decimal('1.5')",
    "enum": "enum.IntEnum('E', 'A B').B",
    "fractions": "fractions.Fraction(1, 2)",
    "graphlib": "[*graphlib.TopologicalSorter({2: {1}}).static_order()][0]",
    "numbers": "3.0 if isinstance(3, numbers.Real) else 0",
    "operator": "operator.add(1, 2)",
    "pprint": "len(pprint.pformat([1]))",
    "string": "len(string.ascii_lowercase)",
    "sys": "min(sys.maxsize, sys.float_info.dig, sys.getrecursionlimit())",
    "textwrap": "len(textwrap.dedent(' a'))",
    "time": "time.perf_counter()",
    "types": "types.SimpleNamespace(a=2).a",
    "warnings": "warnings.warn('careful') or 4.0",
}


@pytest.mark.parametrize("module", USES)
def test_pure_modules_can_be_imported(box, module):
    source = f"import {module}\n" + LINE.replace("o.x, o.y, x, y", f"{USES[module]}, o.y, x, y")
    assert not box(source).plans(cube(3, 2)).errors


@pytest.mark.parametrize(
    ("module", "hint"),
    [
        ("os", "a program has no files"),
        ("pathlib", "a program has no files"),
        ("threading", "a program has no processes or threads"),
        ("urllib.request", "a program has no network"),
        ("datetime", "a program has no clock"),
        ("logging", "print what you want to have logged"),
        ("scipy.optimize", "numpy does arithmetic here"),
    ],
)
def test_others_are_refused_with_what_to_do_instead(box, module, hint):
    with pytest.raises(SketchRuntimeError, match=rf"cannot be imported here; available: .* \({hint}\)$"):
        box(f"import {module}\n{LINE}")


CLOCK = """
import sys, time
from time import sleep
sys.setrecursionlimit(10**6)
print("loaded", file=sys.stderr)

def gen_plan(state, x):
    began = time.time()
    sleep(3600)
    while time.monotonic() - began < 1:
        x += 0
    return [Action("draw_line", [began, time.perf_counter_ns() / 1e9, x, 4])]

def gen_domain(state):
    return {"x": ContinuousSampler(0, 1 + time.time())}
"""


def test_time_counts_how_often_it_is_asked_anew_in_every_sample(box):
    sketch = box(CLOCK)
    batch = sketch.plans(cube(3, 1))
    assert sketch.log == "loaded\n"
    assert {batch.plan(i)[0].args[:2] for i in range(3)} == {(0.001, 1.003)}


def test_the_stand_ins_change_nothing_outside_the_program(box):
    source = LINE.replace("    o = state", "    import sys\n    sys.maxsize = 3\n    o = state")
    sketch = box(f"import numpy.linalg\n{source}")
    assert not sketch.plans(cube(50, 2)).errors


def test_fractions_and_decimals_are_numbers(box):
    source = """
        from decimal import Decimal
        from fractions import Fraction
        def gen_plan(state, x, y):
            return [Action("draw_line", [Decimal("1.5"), Fraction(1, 2), x, y])]
        def gen_domain(state):
            return {
                "x": ContinuousSampler(Fraction(1, 2), Decimal(2)),
                "y": DiscreteSampler([Fraction(1, 4), Decimal("0.5")]),
            }
    """
    plan = box(source).plans(cube(1, 2)).plan(0)
    assert plan[0].args[:2] == (1.5, 0.5)
    assert plan[0].args[3] in (0.25, 0.5)


ALIKE = [
    ("\u00e9", "e\u0301"),
    ("\ufb01rst", "first"),
    ("\uff58", "x"),
    ("\u00b5", "\u03bc"),
    ("v\u1d62", "vi"),
]


@pytest.mark.parametrize(("one", "other"), [*ALIKE, *((b, a) for a, b in ALIKE)])
@pytest.mark.parametrize("form", ["dict({1}=S)", "{{'{1}': S}}"])
def test_names_that_python_takes_for_one_are_one(box, one, other, form):
    domain = form.format(one, other).replace("S", "ContinuousSampler(0, 9)")
    source = f'def gen_plan(state, {one}):\n    return [Action("draw_line", [1, 2, 3, {other}])]\n'
    sketch = box(f"{source}\ndef gen_domain(state):\n    return {domain}")
    assert sketch.space.dim == 1
    assert not sketch.plans(cube(3, 1)).errors


def test_what_is_wrong_with_such_a_name_has_its_line(box):
    source = "def gen_plan(state, \ufb01rst):\n    return [Action('repeat', [1])]\n\n"
    source += "def gen_domain(state):\n    return {\n        '\ufb01rst': 3,\n    }"
    with pytest.raises(SketchContractError, match="line 6: gen_domain: first is 3"):
        box(source)


def test_random_by_another_spelling_is_seeded(box):
    source = LINE.replace("o.y, x, y", "o.y, x, 9 * \uff52andom.random()")
    plans = [box(source).plans(cube(4, 2)).plan(3) for _ in range(2)]
    assert plans[0] == plans[1]
