"""The tasks of the suite `hard`: their judges, and that each has an answer that solves it."""

import dataclasses
import itertools
import math
from importlib.util import find_spec
from types import SimpleNamespace

import pytest

from proc3s.planning.options import RunOptions
from proc3s.planning.setup import make_problem
from proc3s.plugins.registry import open_registry
from proc3s.search.rollout import judge
from proc3s.specs.suite import SuiteSpec
from proc3s_drawing.shapes import is_spiral, spells_hi

REGISTRY = open_registry()
HARD = REGISTRY.get(SuiteSpec, "hard")
TABLETOP = find_spec("pybullet") is not None
TASKS = [task for task in HARD.tasks if TABLETOP or task.startswith("drawing/")]
"""Without the extra `tabletop` there is no simulator."""


def drawing(*strokes, obstacles=()):
    lines = [SimpleNamespace(**dict(zip(("p1_x", "p1_y", "p2_x", "p2_y"), s, strict=True))) for s in strokes]
    return SimpleNamespace(drawn_lines=lines, obstacles=list(obstacles))


def path(*points):
    return [(*a, *b) for a, b in itertools.pairwise(points)]


H = [(10, 10, 10, 30), (24, 10, 24, 30), (10, 20, 24, 20)]
I = [(32, 10, 32, 30)]  # noqa: E741 - its name


def moved(strokes, dx, dy=0.0):
    return [(a + dx, b + dy, c + dx, d + dy) for a, b, c, d in strokes]


def test_the_word_is_read():
    score = spells_hi(drawing(*H, *I), ())
    assert (score.reached, score.reason) == (True, "the letters H and I, in this order")


@pytest.mark.parametrize(
    ("strokes", "why"),
    [
        ([], "nothing is drawn"),
        (H, "here are 1 separate drawings"),
        ([*I, *moved(H, 30)], "the left letter is no H"),
        ([*H, *moved(I, 0, 15)], "unlevel"),
        ([*H, (32, 10, 32, 20)], "share of the higher"),
        ([*H, (32, 10, 46, 30)], "the I: degrees by which it leans"),
        ([*H[:2], (10, 29, 24, 29), *I], "the height of its bar"),
        ([*H[:2], *I], "3 separate drawings"),
        ([*H, *I, (28, 30, 36, 30)], "no I of one stroke"),
        ([*H, (24.9, 10, 24.9, 30)], "the gap between the letters"),
    ],
    ids=["nothing", "H", "IH", "a step", "a short I", "a slash", "a low bar", "no bar", "T", "too near"],
)
def test_what_is_no_word(strokes, why):
    score = spells_hi(drawing(*strokes), ())
    assert not score.reached
    assert why in score.reason


def spiral(turns, pitch=6.0, count=12, begin=3.0):
    angles = [2 * math.pi * k / count for k in range(round(turns * count) + 1)]
    radii = [begin + pitch * a / (2 * math.pi) for a in angles]
    return path(*((50 + r * math.cos(a), 50 + r * math.sin(a)) for a, r in zip(angles, radii, strict=True)))


def test_a_spiral_turns_on_and_on():
    assert is_spiral(drawing(*spiral(2.2)), (), turns=2, size=20).reached
    mirrored = [(100 - a, b, 100 - c, d) for a, b, c, d in spiral(2.2)]
    assert is_spiral(drawing(*mirrored), (), turns=2).reached


@pytest.mark.parametrize(
    ("strokes", "options", "why"),
    [
        (spiral(1.5), {}, "turns by 521 degrees"),
        (spiral(2.2), {"size": 60}, "units wide or high, 60 are wanted"),
        (spiral(2.2, pitch=0.0, begin=20.0), {}, ""),
        (path((10, 10), (20, 20), (30, 10), (40, 20)), {}, "turns back"),
        ([*spiral(2.2), (50, 50, 90, 50)], {}, "crosses or touches itself"),
        ([*spiral(2.2), (1, 1, 1, 9)], {}, "here are 2"),
    ],
    ids=["too few turns", "too small", "a circle", "a zigzag", "crossed", "two curves"],
)
def test_what_is_no_spiral(strokes, options, why):
    score = is_spiral(drawing(*strokes), (), turns=2, **options)
    assert not score.reached
    assert why in score.reason


def test_exactly_three_are_enclosed():
    from proc3s_drawing.judges import encloses

    circles = [
        SimpleNamespace(name=f"object_{k}", x_pos=x, y_pos=50, radius=4)
        for k, x in enumerate((20, 40, 60, 80))
    ]
    box = path((10, 30), (70, 30), (70, 70), (10, 70), (10, 30))
    assert encloses(drawing(*box, obstacles=circles), (), count=3, exact=True).reached
    wider = path((10, 30), (95, 30), (95, 70), (10, 70), (10, 30))
    assert encloses(drawing(*wider, obstacles=circles), (), count=3).reached
    assert not encloses(drawing(*wider, obstacles=circles), (), count=3, exact=True).reached
    cutting = path((10, 30), (80, 30), (80, 70), (10, 70), (10, 30))
    assert not encloses(drawing(*cutting, obstacles=circles), (), count=3, exact=True).reached


def block(name, color, x, y, z=0.02):
    pose = SimpleNamespace(x=x, y=y, z=z, roll=0.0, pitch=0.0, yaw=0.0)
    return name, SimpleNamespace(category="block", color=color, pose=pose)


def blocks(*changes):
    """Nine blocks in a grid, some of them elsewhere."""
    made = {}
    for k, color in enumerate(("red", "green", "blue")):
        made |= dict(block(f"{color}{n}", color, 0.06 * n, -0.5 + 0.1 * k) for n in range(3))
    return SimpleNamespace(objects=made | dict(changes))


ROWS = [{"color": color} for color in ("red", "green", "blue")]


@pytest.mark.parametrize(
    ("state", "why"),
    [
        (blocks(), None),
        (blocks(block("red1", "red", 0.06, -0.48)), "the row of red object is crooked"),
        (blocks(block("red1", "red", 0.085, -0.5)), "a column is crooked"),
        (blocks(block("red1", "red", 0.0, -0.5, 0.06)), "not flat on the table"),
        (blocks(block("red1", "green", 0.06, -0.5)), "not equally long"),
        (
            blocks(
                *(block(f"{c}2", c, 0.15, -0.5 + 0.1 * k) for k, c in enumerate(("red", "green", "blue")))
            ),
            "neighbours in a row are apart",
        ),
    ],
    ids=["a grid", "crooked row", "crooked column", "stacked", "a wrong colour", "far apart"],
)
def test_a_grid(state, why):
    from proc3s_tabletop.tasks.formations import grid

    score = grid(state, (), rows=ROWS, most_along=0.08, most_across=0.12)
    assert score.reached == (why is None), score.reason
    assert why is None or why in score.reason


@pytest.mark.parametrize(
    ("xs", "ys", "why"),
    [
        ((0.0, 0.1, 0.2), (-0.5, -0.49, -0.5), None),
        ((0.0, 0.2, 0.1), (-0.5, -0.5, -0.5), "green block) is not further along x"),
        ((0.0, 0.1, 0.3), (-0.5, -0.5, -0.5), "200 mm apart"),
        ((0.0, 0.1, 0.2), (-0.5, -0.4, -0.5), "67 mm off the line"),
    ],
)
def test_an_order_along_x(xs, ys, why):
    from proc3s_tabletop.tasks.formations import ordered

    colors = ("red", "blue", "green")
    state = SimpleNamespace(objects=dict(block(c, c, x, y) for c, x, y in zip(colors, xs, ys, strict=True)))
    score = ordered(state, (), what=[{"color": c} for c in colors], most=0.16)
    assert score.reached == (why is None), score.reason
    assert why is None or why in score.reason


@pytest.mark.parametrize("task", TASKS)
def test_nothing_is_done_at_the_start_and_there_is_an_answer(task):
    domain, spec = REGISTRY.task(task)
    assert (domain.spec.folder / "answers" / f"{spec.name}.proc3s.md").is_file()
    for seed in range(5):
        problem = make_problem(REGISTRY, RunOptions(task=task, method="proc3s", seed=seed))
        score, reason = judge(problem, problem.initial, ())
        assert score is not None
        assert not score.reached, reason


def test_a_reversed_stack_is_told_from_one_that_is_not():
    problem = make_problem(REGISTRY, RunOptions(task="blocks/reverse", method="proc3s", seed=0))
    red, green, blue = (problem.initial.objects[f"object_{k}"] for k in range(3))
    swapped = {"object_0": (red, blue.pose), "object_1": (green, green.pose), "object_2": (blue, red.pose)}
    objects = {n: dataclasses.replace(o, pose=p) for n, (o, p) in swapped.items()}
    final = dataclasses.replace(problem.initial, objects={**problem.initial.objects, **objects})
    assert judge(problem, final, ())[0].reached
    assert not judge(problem, problem.initial, ())[0].reached


@pytest.mark.slow
@pytest.mark.parametrize("task", TASKS)
def test_the_bundled_program_solves_the_first_seeds(task, cli):
    for seed in range(3):
        summary = cli("run", task, "--seed", seed, "--json", "--out", f"run{seed}").json
        assert (summary["solved"], summary["goal_reached"]) == (True, True), summary
