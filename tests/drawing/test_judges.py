"""Drawings that a person would accept or refuse, and transformations that change no verdict."""

import math
from collections.abc import Sequence
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from proc3s_drawing.judges import encloses, is_arrow, is_letter_m, is_star

Line = tuple[float, float, float, float]
Lines = list[Line]


# How drawings are made


def path(*points) -> Lines:
    return [(*map(float, a), *map(float, b)) for a, b in pairwise(points)]


def ring(points) -> Lines:
    return path(*points, points[0])


def polar(radius, degrees, centre=(50.0, 50.0)):
    angle = math.radians(degrees)
    return centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)


def polygon(n, radius=30.0, centre=(50.0, 50.0), turn=90.0):
    return [polar(radius, turn + 360 * i / n, centre) for i in range(n)]


def strokes_star(n, k, radius=30.0) -> Lines:
    """{n/k}: every point joined to the k-th next one; several polygons where n and k share a factor."""
    points = polygon(n, radius)
    return [(*points[i], *points[(i + k) % n]) for i in range(n)]


def outline(n, ratio, radius=30.0, centre=(50.0, 50.0)):
    return [polar(radius * (1, ratio)[i % 2], 90 + 180 * i / n, centre) for i in range(2 * n)]


def jittered(points, amount, seed):
    rng = np.random.default_rng(seed)
    return [tuple(np.asarray(p) + rng.uniform(-amount, amount, 2)) for p in points]


def shaky(lines, amount, seed) -> Lines:
    """Every stroke moved by itself, so that no two ends meet exactly."""
    return [
        tuple(row)
        for row in np.asarray(lines) + np.random.default_rng(seed).uniform(-amount, amount, (len(lines), 4))
    ]


def longer(lines, amount) -> Lines:
    """Every stroke overshoots at both ends."""
    found = []
    for x1, y1, x2, y2 in lines:
        ux, uy = np.array([x2 - x1, y2 - y1]) / math.hypot(x2 - x1, y2 - y1) * amount
        found.append((x1 - ux, y1 - uy, x2 + ux, y2 + uy))
    return found


def split(lines, pieces) -> Lines:
    return [
        line
        for x1, y1, x2, y2 in lines
        for line in path(*zip(np.linspace(x1, x2, pieces + 1), np.linspace(y1, y2, pieces + 1), strict=True))
    ]


def mapped(lines, matrix, shift=(0.0, 0.0)) -> Lines:
    ends = np.asarray(lines).reshape(-1, 2) @ np.asarray(matrix, dtype=float).T + np.asarray(shift)
    return [tuple(row) for row in ends.reshape(-1, 4)]


def rotation(degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([[c, -s], [s, c]])


def turned(lines, degrees) -> Lines:
    return mapped(np.asarray(lines) - 50, rotation(degrees), (50, 50))


def arrow(lean=30.0, barb=8.0, other_lean=None, other_barb=None) -> Lines:
    """From (20, 50) to its tip (60, 50)."""
    left = polar(barb, 180 - lean, (60, 50))
    right = polar(other_barb or barb, 180 + (lean if other_lean is None else other_lean), (60, 50))
    return [(20, 50, 60, 50), (60, 50, *left), (60, 50, *right)]


def by_hand(seed) -> Lines:
    tail, tip, left, right = jittered([(20, 50), (60, 50), (52, 55), (52, 44.5)], 1.0, seed)
    return [(*tail, *tip), (*left, *tip), (*tip, *right)]


def closing(lines) -> Line:
    return (*lines[1][2:], *lines[2][2:])


def circle(name, x, y, radius):
    return SimpleNamespace(name=name, x_pos=x, y_pos=y, radius=radius, color=name)


TARGETS = [
    circle("red", 85, 50, 10),
    circle("green", 30, 80, 5),
    circle("blue", 30, 20, 4),
    circle("cyan", 75, 85, 7),
]
PAIR = [
    circle("red", 40, 50, 6),
    circle("green", 60, 50, 5),
    circle("blue", 90, 90, 4),
    circle("cyan", 10, 10, 9),
]


def drawing(lines: Sequence[Line], obstacles=()):
    drawn = [SimpleNamespace(p1_x=a, p1_y=b, p2_x=c, p2_y=d) for a, b, c, d in lines]
    return SimpleNamespace(obstacles=list(obstacles), drawn_lines=drawn)


def table(cases):
    return pytest.mark.parametrize("lines", [pytest.param(lines, id=name) for name, lines in cases.items()])


def refusals(cases):
    return pytest.mark.parametrize(
        ("lines", "says"), [pytest.param(*case, id=name) for name, case in cases.items()]
    )


# Star

PENTAGRAM = strokes_star(5, 2)
OUTLINE = ring(outline(5, 0.4))
STARS = {
    **{f"{{{n}/{k}}}": strokes_star(n, k) for n, k in [(5, 2), (7, 2), (7, 3), (8, 3), (9, 4), (12, 5)]},
    **{f"{{{n}/{k}}}": strokes_star(n, k) for n, k in [(6, 2), (8, 2), (9, 3), (10, 4), (12, 4), (15, 6)]},
    **{f"outline 5, inner {r}": ring(outline(5, r)) for r in (0.12, 0.25, 0.4, 0.55, 0.65, 0.7)},
    **{
        f"outline {n}, inner {r}": ring(outline(n, r))
        for n, r in [(6, 0.3), (6, 0.7), (8, 0.5), (10, 0.6), (16, 0.6), (20, 0.7)]
    },
    **{f"outline by hand {seed}": ring(jittered(outline(5, 0.45), 2.5, seed)) for seed in range(6)},
    **{
        f"pentagram by hand {seed}": ring([jittered(polygon(5), 3.5, seed)[i * 2 % 5] for i in range(5)])
        for seed in range(6)
    },
    **{f"shaky pentagram {seed}": shaky(PENTAGRAM, 0.15, seed) for seed in range(4)},
    **{f"shaky outline in pieces {seed}": shaky(split(OUTLINE, 3), 0.15, seed) for seed in range(4)},
    "two triangles of unequal size": [*ring(polygon(3, 30)), *ring(polygon(3, 25, turn=-90))],
    "compass rose": ring([polar([30, 8, 18, 8][i % 4], 22.5 * i) for i in range(16)]),
    "squashed": mapped(PENTAGRAM, [[1.0, 0], [0, 0.6]], (0, 20)),
    "sheared": mapped(OUTLINE, [[1.0, 0.3], [0, 1.0]], (-15, 0)),
    "pieces": split(PENTAGRAM, 5),
    "drawn twice": PENTAGRAM + [line[2:] + line[:2] for line in PENTAGRAM],
    "drawn twice, not quite the same": PENTAGRAM + shaky(PENTAGRAM, 0.2, 0),
    "pentagram and its core pentagon": PENTAGRAM + ring(polygon(5, 30 * 0.381966, turn=-90)),
    "facets": OUTLINE + [(50, 50, *p) for p in outline(5, 0.4)],
    "a star within a star": OUTLINE + ring(outline(5, 0.4, 15)),
    "overshooting strokes": longer(PENTAGRAM, 0.5),
    "strokes too short": longer(PENTAGRAM, -0.25),
    "gap": path(*outline(5, 0.4), (50.0, 79.5)),
    "dots": [*PENTAGRAM, (5, 5, 5, 5), (95, 50, 95, 50), (50, 80, 50, 80)],
    "tiny": mapped(PENTAGRAM, np.eye(2) * 0.03, (10, 80)),
    "one stroke partly drawn twice": [*PENTAGRAM, *path(PENTAGRAM[0][:2], (43.5, 60))],
}
PLUS = [tuple(50 + 5 * rotation(-90 * arm) @ p) for arm in range(4) for p in ((-1, 3), (1, 3), (1, 1))]
CROWN = [(20, 20), (80, 20), (85, 60), (65, 40), (57, 65), (50, 40), (43, 65), (35, 40), (15, 60)]
NO_STARS = {
    "nothing": ([], "nothing is drawn"),
    "a dot": ([(5, 5, 5, 5)], "nothing is drawn"),
    "one line": ([(5, 5, 50, 5)], "not closed"),
    "pentagram without its last stroke": (PENTAGRAM[:4], "not closed: 57.1 units between"),
    "outline without a side": (OUTLINE[:-1], "not closed"),
    "outline with a gap of 4 %": (
        path(*outline(5, 0.4), (50, 80 - 2.6)),
        "not closed: 2.6 units between (50.0, 77.4) and (50.0, 80.0)",
    ),
    "asterisk": ([(*polar(30, a), *polar(30, a + 180)) for a in (0, 36, 72, 108, 144)], "not closed"),
    "overshooting by a tenth": (longer(PENTAGRAM, 6), "not closed"),
    "pentagon": (ring(polygon(5)), "closed convex polygon with 5 corners"),
    "pentagon in pieces": (shaky(split(ring(polygon(5)), 4), 0.1, 0), "closed convex polygon with 5 corners"),
    "pentagon and a diagonal": (ring(polygon(5)) + PENTAGRAM[:1], "closed convex polygon with 5 corners"),
    "pentagon, barely dented": (ring(outline(5, 0.78)), "convex"),
    "hexagon": (ring(polygon(6)), "closed convex polygon with 6 corners"),
    "triangle": (ring(polygon(3)), "closed convex polygon with 3 corners"),
    "square with diagonals": (
        ring(polygon(4)) + strokes_star(4, 2)[:2],
        "closed convex polygon with 4 corners",
    ),
    "circle": (ring(polygon(60)), "convex"),
    "fine circle": (ring(polygon(360)), "convex"),
    "three points": (ring(outline(3, 0.25)), "3 points only"),
    "four points": (ring(outline(4, 0.4)), "4 points only"),
    "plus sign": (ring(PLUS), "8 points and 4 inner corners"),
    "cog": (ring([polar([30, 30, 20, 20][i % 4], 9 * i) for i in range(40)]), "exactly one inner corner"),
    "crown": (ring(CROWN), "exactly one inner corner"),
    "pentagram with a point cut off": (
        ring([outline(5, 0.4)[i] for i in range(1, 10)]),
        "exactly one inner corner",
    ),
    "house": (ring([(20, 20), (60, 20), (60, 50), (40, 70), (20, 50)]), "closed convex polygon"),
    "bow tie": (ring([(20, 20), (60, 60), (60, 20), (20, 60)]), "2 separate closed shapes"),
    "two stars": (
        ring(outline(5, 0.4, 15, (25, 25))) + ring(outline(5, 0.4, 15, (70, 70))),
        "2 separate closed shapes",
    ),
    "star with a tail": ([*OUTLINE, (50, 80, 50, 95)], "ends loose at (50.0, 95.0)"),
    "star and a line": ([*PENTAGRAM, (5, 5, 5, 40)], "not closed"),
    "comet": (
        ring([(50, 95) if i == 0 else p for i, p in enumerate(outline(5, 0.4, 10, (50, 20)))]),
        "zigzag|shortest",
    ),
    "saw-toothed moon": (
        ring([polar(30, a) if i % 2 else polar(22, a) for i, a in enumerate(range(0, 181, 15))] + [(50, 52)]),
        "star",
    ),
    "letter M": (path((20, 20), (20, 60), (40, 40), (60, 60), (60, 20)), "not closed"),
}


@table(STARS)
def test_star(lines):
    score = is_star(drawing(lines), ())
    assert score.reached, score.reason
    assert "star with" in score.reason


@refusals(NO_STARS)
def test_no_star(lines, says):
    score = is_star(drawing(lines), ())
    assert not score.reached, score.reason
    assert any(part in score.reason for part in says.split("|")), score.reason


@pytest.mark.parametrize("percent", [0.5, 0.9, 3, 5, 10])
@pytest.mark.parametrize("lines", [OUTLINE, PENTAGRAM, ring(outline(5, 0.2))])
@pytest.mark.parametrize("at", [0, 1])
def test_star_with_a_gap_of_some_percent_of_its_size(percent, lines, at):
    size = np.linalg.norm(np.ptp(np.reshape(lines, (-1, 2)), axis=0))
    start, end = np.reshape(lines[at], (2, 2))
    short = end - (end - start) / np.linalg.norm(end - start) * size * percent / 100
    score = is_star(drawing([*lines[:at], (*start, *short), *lines[at + 1 :]]), ())
    assert score.reached is (percent < 1), score.reason
    assert score.reached or "not closed" in score.reason


def test_scribble_is_refused_in_time():
    lines = np.random.default_rng(0).uniform(0, 100, (500, 4))
    assert "too tangled to read" in is_star(drawing(lines.tolist()), ()).reason


@pytest.mark.parametrize(("n", "k"), [(5, 2), (6, 2), (7, 2), (7, 3), (12, 5)])
def test_star_points_are_counted(n, k):
    assert is_star(drawing(strokes_star(n, k)), ()).reason == f"a closed star with {n} points"


# Arrow

ARROW = arrow()
CLOSED = [*ARROW, closing(ARROW)]
BASE = [(20, 50, 60 - 8 * math.cos(math.radians(30)), 50), *CLOSED[1:]]
ARROWS = {
    **{f"head at {lean} degrees": arrow(lean) for lean in (12, 20, 30, 45, 60, 70)},
    **{f"head of length {barb}": arrow(35, barb) for barb in (3, 5, 10, 20, 30)},
    **{f"by hand {seed}": by_hand(seed) for seed in range(5)},
    **{f"shaky {seed}": shaky(split(ARROW, 3), 0.1, seed) for seed in range(5)},
    **{f"shaky, closed {seed}": shaky(CLOSED, 0.1, seed) for seed in range(5)},
    **{f"shaky triangle on a shaft {seed}": shaky(BASE, 0.1, seed) for seed in range(5)},
    "a little lopsided": arrow(25, 8, 42, 10),
    "closed": CLOSED,
    "triangle on a shaft": BASE,
    "closed in two pieces": [
        *ARROW,
        *path(ARROW[1][2:], (60 - 8 * math.cos(math.radians(30)), 50), ARROW[2][2:]),
    ],
    "big triangle": [*arrow(30, 30), closing(arrow(30, 30))],
    "shaft in pieces, one twice": [*split(ARROW[:1], 7), (30, 50, 45, 50), *ARROW[1:]],
    "overshooting": longer(ARROW, 0.35),
    "strokes too short": longer(ARROW, -0.2),
    "dots": [*ARROW, (5, 5, 5, 5), (20, 50, 20, 50)],
    "from below, off centre": turned(mapped(ARROW, np.eye(2)), 5),
}
NO_ARROWS = {
    "nothing": ([], "nothing is drawn"),
    "a line": (ARROW[:1], "no head"),
    "shaft and one barb": (ARROW[:2], "no head"),
    "head without a shaft": (ARROW[1:], "no head"),
    "no shaft, closed head": (CLOSED[1:], "0 loose ends"),
    "letter L": (path((20, 50), (60, 50), (60, 70)), "no head"),
    "T": ([(20, 50, 60, 50), (60, 40, 60, 60)], "90 and 90 degrees"),
    "Y": (arrow(150), "lead off at 150 and 150 degrees"),
    "Y, wide": (arrow(120), "lead off at 120 and 120"),
    "nearly a T": (arrow(82), "lead off at 82 and 82"),
    "both barbs on one side": ([*ARROW[:2], (60, 50, *polar(8, 180 - 60, (60, 50)))], "on the same side"),
    "head at the wrong end": (
        turned(mapped(ARROW, np.eye(2), (10, 0)), 180),
        "does not point at the biggest obstacle red (radius 10.0): its centre lies 180 degrees",
    ),
    "heads at both ends": ([*ARROW, (20, 50, 27, 54), (20, 50, 27, 46)], "4 loose ends and 2 points"),
    "fletched": ([*ARROW, (24, 50, 20, 54), (24, 50, 20, 46)], "5 loose ends"),
    "cross": ([(20, 50, 60, 50), (40, 30, 40, 70)], "4 loose ends"),
    "two arrows": (ARROW + mapped(ARROW, np.eye(2), (0, 30)), "6 loose ends"),
    "arrow and a line": ([*ARROW, (5, 5, 5, 40)], "5 loose ends"),
    "arrow and a square": (ARROW + ring([(5, 5), (5, 15), (15, 15), (15, 5)]), "corners"),
    "arrow and a triangle": (ARROW + ring([(5, 5), (5, 15), (15, 15)]), "loose ends outside"),
    "three barbs": ([*ARROW, (60, 50, 50, 52)], "4 loose ends"),
    "lopsided angles": (arrow(15, 8, 60), "lopsided"),
    "lopsided lengths": (arrow(30, 4, 30, 12), "lopsided"),
    "head longer than the shaft": (arrow(30, 60), "on the same side"),
    "head nearly as long as the arrow": (arrow(12, 30), "how far the head leads back"),
    "head that nobody sees": (arrow(40, 1.5), "too short to see|no head"),
    "head hugs the shaft": (arrow(5, 30), "lead off at 5 and 5"),
    "bent shaft": (path((20, 30), (40, 50), (60, 50)) + ARROW[1:], "bends at (40.0, 50.0)"),
    "bent barb": ([*ARROW[:2], *path((60, 50), (52, 45), (45, 48))], "bends"),
    "triangle the wrong way round": ([(20, 50, 53, 50), *ring([(53, 50), (62, 45), (62, 55)])], "corner"),
    "triangle reversed, shaft through it": (
        [(20, 50, 62, 50), *ring([(53, 50), (62, 45), (62, 55)])],
        "corner",
    ),
    "flag": ([(20, 50, 60, 50), *ring([(60, 50), (50, 50), (60, 60)])], "side|corner|shaft|lopsided"),
    "lollipop": (
        [(20, 50, 52, 50), *ring([polar(6, a, (58, 50)) for a in range(0, 360, 12)])],
        "corners, a triangle",
    ),
    "square on a shaft": (
        [(20, 50, 52, 50), *ring([(52, 45), (52, 55), (62, 55), (62, 45)])],
        "4 corners, a triangle",
    ),
    "head apart from the shaft": ([(20, 50, 55, 50), *ARROW[1:]], "no head"),
    "line in the head": ([*arrow(30, 30), closing(arrow(30, 30)), (40, 56, 48, 53)], "belongs neither"),
    "line across the head": ([*CLOSED, (50, 53, 58, 40)], "corners|loose ends"),
    "letter M": (path((20, 20), (20, 60), (40, 40), (60, 60), (60, 20)), "no head"),
}


@table(ARROWS)
def test_arrow(lines):
    score = is_arrow(drawing(lines, TARGETS), ())
    assert score.reached, score.reason
    assert "points at the biggest obstacle red" in score.reason


@refusals(NO_ARROWS)
def test_no_arrow(lines, says):
    score = is_arrow(drawing(lines, TARGETS), ())
    assert not score.reached, score.reason
    assert any(part in score.reason for part in says.split("|")), score.reason


def test_arrow_past_the_biggest_obstacle():
    score = is_arrow(drawing(turned(ARROW, 30), TARGETS), ())
    assert not score.reached
    assert "does not point at the biggest obstacle red" in score.reason
    assert "degrees to the right, seen from the tip" in score.reason


def test_arrow_at_a_smaller_obstacle_in_front():
    score = is_arrow(drawing(ARROW, [*TARGETS, circle("grey", 68, 52, 4)]), ())
    assert not score.reached
    assert "meets grey (radius 4.0) before the biggest obstacle red (radius 10.0)" in score.reason


def test_arrow_ignores_obstacles_behind_it_and_behind_the_target():
    others = [circle("grey", 10, 50, 5), circle("pink", 99, 50, 1)]
    assert is_arrow(drawing(ARROW, [*others, *TARGETS]), ()).reached


def test_arrow_may_meet_either_of_two_equal_obstacles():
    assert is_arrow(drawing(ARROW, [*TARGETS, circle("grey", 30, 90, 10)]), ()).reached


def test_arrow_grazes_the_biggest_obstacle():
    assert is_arrow(drawing(ARROW, [circle("red", 85, 59.9, 10)]), ()).reached
    assert not is_arrow(drawing(ARROW, [circle("red", 85, 60.1, 10)]), ()).reached


def test_arrow_needs_an_obstacle():
    assert is_arrow(drawing(ARROW), ()).reason == "there is no obstacle to point at"


# Letter M


def letter(width=30.0, height=40.0, lean=0.0, depth=0.6, middle=0.5) -> Lines:
    """`lean`: how far each foot stands outside its top; `depth`, `middle`: shares of height and width."""
    left, right, base = 50 - width / 2, 50 + width / 2, 50 - height / 2
    top = base + height
    return path(
        (left - lean, base),
        (left, top),
        (left + middle * width, top - depth * height),
        (right, top),
        (right + lean, base),
    )


M = letter()
W = mapped(M, [[1, 0], [0, -1]], (0, 100))
MS = {
    **{f"middle down to {depth}": letter(depth=depth) for depth in (0.4, 0.5, 0.75, 1.0)},
    **{f"{width} wide": letter(width) for width in (16, 20, 40, 60, 75)},
    **{f"feet out by {lean}": letter(lean=lean) for lean in (-2, 2, 5, 10)},
    **{f"tilted by {angle}": turned(M, angle) for angle in (-20, -15, 10, 20)},
    **{
        f"by hand {seed}": path(*jittered([(35, 30), (36, 70), (50, 45), (64, 70), (65, 30)], 1.5, seed))
        for seed in range(6)
    },
    **{f"shaky {seed}": shaky(split(M, 3), 0.15, seed) for seed in range(5)},
    "upright": M,
    "italic": mapped(M, [[1, 0.25], [0, 1]], (-12, 0)),
    "peaked": letter(20, 40, 9, 1.0),
    "middle off centre": letter(middle=0.4),
    "small": mapped(M, np.eye(2) * 0.1, (80, 5)),
    "overshooting": longer(M, 0.5),
    "strokes too short": longer(M, -0.25),
    "drawn twice, dots": [*M, *M[::-1], (5, 5, 5, 5)],
    "legs of unequal length": path((35, 30), (35, 70), (50, 50), (65, 70), (65, 36)),
}
NO_MS = {
    "nothing": ([], "nothing is drawn"),
    "W": (W, "upside down, more like a W"),
    "W tilted by 20": (turned(W, 20), "upside down"),
    "W tilted by -20": (turned(W, -20), "upside down"),
    "W with slanted sides": (mapped(letter(20, 40, 9, 1.0), [[1, 0], [0, -1]], (0, 100)), "upside down"),
    "N": (path((30, 30), (30, 70), (60, 30), (60, 70)), "3 straight strokes"),
    "N tilted": (turned(path((30, 30), (30, 70), (60, 30), (60, 70)), 20), "3 straight strokes"),
    "H": ([(30, 30, 30, 70), (60, 30, 60, 70), (30, 50, 60, 50)], "branch or cross"),
    "A": ([*path((30, 30), (45, 70), (60, 30)), (37.5, 50, 52.5, 50)], "branch or cross"),
    "V": (path((30, 70), (45, 30), (60, 70)), "2 straight strokes"),
    "I": ([(30, 30, 30, 70)], "1 straight strokes"),
    "U": (path((30, 70), (30, 30), (60, 30), (60, 70)), "3 straight strokes"),
    "E": ([*path((60, 70), (30, 70), (30, 30), (60, 30)), (30, 50, 55, 50)], "branch"),
    "sigma": (turned(M, 90), "tilted by 90 degrees"),
    "three": (turned(M, -90), "tilted by 90 degrees"),
    "tilted by 30": (turned(M, 30), "tilted by 30 degrees"),
    "tilted by 45": (turned(M, 45), "tilted by 45 degrees"),
    "flat zigzag": (path((10, 40), (30, 60), (50, 40), (70, 60), (90, 40)), "zigzag"),
    "steeper zigzag": (path((20, 30), (35, 60), (50, 30), (65, 60), (80, 30)), "zigzag"),
    "very wide": (letter(95, 20), "the width of the M"),
    "very narrow": (letter(8, 60), "the width of the M"),
    "notch too shallow": (
        letter(depth=0.15),
        "how far down the middle of the M reaches as a share of its height: 0.15",
    ),
    "middle below the feet": (letter(depth=1.4), "share of its height: 1.40"),
    "pentagon without its base": (letter(depth=-0.4), "share of its height: -0.40"),
    "flat top": (path((35, 30), (35, 70), (65, 70), (65, 30)), "3 straight strokes"),
    "middle at the left leg": (letter(middle=0.05), "stands: 0.05"),
    "one short leg": (path((35, 30), (35, 70), (50, 50), (65, 70), (65, 55)), "shorter leg"),
    "closed at the foot": ([*M, (35, 30, 65, 30)], "close a loop"),
    "underlined": ([*M, (30, 20, 70, 20)], "2 separate lines"),
    "crossed out": ([*M, (30, 50, 70, 50)], "branch or cross"),
    "M and a triangle": (M + ring(polygon(3, 5, (10, 10))), "closed loop besides"),
    "gap of 4 %": (
        path((35, 30), (35, 70), (50, 46)) + path((52, 46), (65, 70), (65, 30)),
        "2 separate lines",
    ),
    "one stroke too many": (
        path((20, 30), (20, 70), (35, 46), (50, 70), (50, 30), (70, 30)),
        "5 straight strokes",
    ),
    "legs that fall over": (letter(30, 30, 20), "zigzag"),
    "stairs": (
        path((10, 10), (10, 30), (30, 30), (30, 50), (50, 50)),
        "side by side|zigzag|tilted|shorter|leg",
    ),
    "hook": (path((10, 10), (10, 50), (30, 50), (30, 20), (20, 20)), "tilted by 25 degrees"),
    "one leg higher": (path((35, 30), (35, 70), (50, 58), (65, 95), (65, 55)), "how much higher one leg"),
}


@table(MS)
def test_letter_m(lines):
    score = is_letter_m(drawing(lines), ())
    assert score.reached, score.reason
    assert "a letter M" in score.reason


@refusals(NO_MS)
def test_no_letter_m(lines, says):
    score = is_letter_m(drawing(lines), ())
    assert not score.reached, score.reason
    assert any(part in score.reason for part in says.split("|")), score.reason


# Enclosure: red and green stand side by side in the middle, blue and cyan in opposite corners

BOX = [(28, 40), (70, 40), (70, 60), (28, 60)]
ENCLOSURES = {
    "box": ring(BOX),
    "triangle": ring([(10, 35), (90, 35), (50, 95)]),
    "fine ellipse": mapped(ring(polygon(400, 1, (0, 0))), [[24, 0], [0, 14]], (50, 50)),
    "everything": ring([(0.5, 0.5), (99, 0.5), (99, 99), (0.5, 99)]),
    "pentagram, both in its core": ring([polygon(5, 70)[i * 2 % 5] for i in range(5)]),
    "box with a wall between": [*ring(BOX), (50, 40, 50, 60)],
    "box with a tail and a line elsewhere": [*ring(BOX), (70, 60, 80, 70), (5, 90, 20, 95)],
    "box of overshooting lines": longer(ring(BOX), 5),
    "box with gaps": longer(ring(BOX), -0.15),
    "box beside a triangle": ring(BOX) + ring([(10, 70), (20, 70), (15, 80)]),
    "box with a triangle hung on a string": [
        *ring(BOX),
        (70, 60, 80, 70),
        *ring([(80, 70), (85, 70), (80, 75)]),
    ],
    "box in a box": ring(BOX) + ring([(20, 35), (80, 35), (80, 65), (20, 65)]),
    "box with a room inside": [*ring(BOX), *ring([(49, 42), (52, 42), (52, 45)])],
    "bent": ring([(28, 40), (70, 40), (70, 60), (50, 57), (28, 60)]),
    "pieces, some twice": split(ring(BOX), 6) + ring(BOX)[:2],
    **{f"shaky {seed}": shaky(split(ring(BOX), 2), 0.15, seed) for seed in range(5)},
}
OPEN = {
    "nothing": ([], "nothing is drawn"),
    "open box": (path(*BOX), "not closed: 20.0 units between"),
    "gap of 4 %": (path(*BOX, (28, 41.9)), "not closed: 1.9 units between"),
    "cuts green": (
        ring([(28, 40), (64.5, 40), (64.5, 60), (28, 60)]),
        "1 of 2 obstacles wholly inside: red; it cuts green",
    ),
    "grazes green": (ring([(28, 40), (64.9, 40), (64.9, 60), (28, 60)]), "it cuts green"),
    "one inside": (ring([(28, 40), (50, 40), (50, 60), (28, 60)]), "1 of 2 obstacles wholly inside: red"),
    "none inside": (ring([(5, 70), (20, 70), (20, 90)]), "0 of 2 obstacles wholly inside"),
    "one in each box": (
        ring([(28, 40), (50, 40), (50, 60), (28, 60)]) + ring([(52, 40), (70, 40), (70, 60), (52, 60)]),
        "there are 2 curves",
    ),
    "one in each loop of a bow tie": (ring([(28, 35), (76, 65), (76, 35), (24, 65)]), "there are 2 curves"),
    "dumb-bell": (
        [
            *ring([(30, 40), (48, 40), (48, 60), (30, 60)]),
            (48, 50, 53, 50),
            *ring([(53, 40), (70, 40), (70, 60), (53, 60)]),
        ],
        "there are 2 curves",
    ),
    "there and back": (path((20, 70), (80, 70), (20, 70)), "not closed"),
    "notch keeps green out": (ring([(28, 40), (50, 40), (50, 58), (70, 58), (70, 62), (28, 62)]), "1 of 2"),
    "circle in the inner corner is cut": (
        ring([(28, 40), (70, 40), (70, 60), (56, 52), (28, 60)]),
        "it cuts green",
    ),
}


@table(ENCLOSURES)
def test_encloses(lines):
    score = encloses(drawing(lines, PAIR), ())
    assert score.reached, score.reason
    assert "red, green" in score.reason


@refusals(OPEN)
def test_does_not_enclose(lines, says):
    score = encloses(drawing(lines, PAIR), ())
    assert not score.reached, score.reason
    assert says in score.reason, score.reason


@pytest.mark.parametrize(("count", "reached"), [(1, True), (2, True), (3, False)])
def test_encloses_a_given_number(count, reached):
    assert encloses(drawing(ring(BOX), PAIR), (), count=count).reached is reached


# How much room there is


def test_the_margin_of_an_enclosure_is_the_clearance_of_the_obstacles_that_it_needs():
    box = drawing(ring(BOX), PAIR)  # (28, 40) to (70, 60)
    assert encloses(box, (), count=2).margin == pytest.approx(10 - 6)
    assert encloses(box, (), count=1).margin == pytest.approx(10 - 5)
    near = [*PAIR, circle("grey", 75, 50, 4)]
    assert encloses(drawing(ring(BOX), near), (), count=2).margin == pytest.approx(4)
    assert encloses(drawing(ring(BOX), near), (), count=2, exact=True).margin == pytest.approx(1)


@pytest.mark.parametrize(
    ("obstacles", "margin"),
    [
        ([circle("red", 85, 57, 10)], 3 * 40 / 65),  # the tip of the arrow is 40 from its tail, the red 65
        ([circle("red", 85, 50, 10), circle("grey", 70, 54, 3)], 1 * 40 / 50),
    ],
)
def test_the_margin_of_an_aim_is_how_far_the_tip_may_move_aside(obstacles, margin):
    def moved(by):
        return is_arrow(drawing(mapped(ARROW, [[1, 0], [by / 40, 1]], (0, -by / 2)), obstacles), ())

    assert moved(0).margin == pytest.approx(margin)
    side = -1 if len(obstacles) == 1 else 1
    assert moved(side * 0.95 * margin).reached
    assert not moved(side * 1.05 * margin).reached


def test_the_margin_of_a_tilt_is_the_way_of_the_top_of_the_letter():
    upright, tilted = (is_letter_m(drawing(turned(M, degrees)), ()).margin for degrees in (0, 20))
    assert tilted < upright
    assert tilted == pytest.approx(math.radians(4) * 40, rel=0.15)


# What changes no verdict


def by_name(accepted, refused, obstacles=()):
    return accepted, {name: lines for name, (lines, _) in refused.items()}, obstacles


CASES = {
    is_star: by_name(STARS, NO_STARS),
    is_arrow: by_name(ARROWS, NO_ARROWS, TARGETS),
    is_letter_m: by_name(MS, NO_MS),
    encloses: by_name(ENCLOSURES, OPEN, PAIR),
}
judges = pytest.mark.parametrize("judge", list(CASES), ids=lambda judge: judge.__name__)


def pick(data, judge):
    accepted, refused, obstacles = CASES[judge]
    expected = data.draw(st.booleans(), label="accepted")
    cases = accepted if expected else refused
    return cases[data.draw(st.sampled_from(list(cases)), label="drawing")], obstacles, expected


@judges
@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_order_direction_repetition_and_splitting_change_nothing(judge, data):
    lines, obstacles, expected = pick(data, judge)
    seed = data.draw(st.integers(0, 2**32 - 1))
    rng = np.random.default_rng(seed)
    changed = []
    for x1, y1, x2, y2 in lines:
        cuts = [0.0, *np.sort(rng.uniform(0, 1, rng.integers(0, 3))), 1.0]
        pieces = path(*[(x1 + t * (x2 - x1), y1 + t * (y2 - y1)) for t in cuts])
        changed += pieces + [pieces[i] for i in np.flatnonzero(rng.random(len(pieces)) < 0.2)]
    changed = [line[2:] + line[:2] if rng.random() < 0.5 else line for line in changed]
    rng.shuffle(changed)
    score = judge(drawing([tuple(line) for line in changed], obstacles), ())
    assert score.reached is expected, score.reason


@judges
@settings(max_examples=60, deadline=None)
@given(
    data=st.data(),
    degrees=st.floats(-180, 180),
    scale=st.floats(0.01, 10),
    shift=st.tuples(st.floats(-50, 50), st.floats(-50, 50)),
)
def test_turning_scaling_and_moving_change_nothing(judge, data, degrees, scale, shift):
    lines, obstacles, expected = pick(data, judge)
    matrix = scale * (np.eye(2) if judge is is_letter_m else rotation(degrees))
    centres = [matrix @ (o.x_pos, o.y_pos) + shift for o in obstacles]
    moved = [circle(o.name, *c, o.radius * scale) for o, c in zip(obstacles, centres, strict=True)]
    score = judge(drawing(mapped(lines, matrix, shift) if lines else [], moved), ())
    assert score.reached is expected, score.reason


@settings(max_examples=60, deadline=None)
@given(
    degrees=st.floats(-20, 20),
    width=st.floats(20, 60),
    lean=st.floats(0, 6),
    depth=st.floats(0.45, 1.0),
    middle=st.floats(0.4, 0.6),
)
def test_letter_m_and_its_mirror_image_w(degrees, width, lean, depth, middle):
    lines = letter(width, 40.0, lean, depth, middle)
    upright, over = turned(lines, degrees), turned(lines, 180 + degrees)
    assert is_letter_m(drawing(upright), ()).reached
    assert not is_letter_m(drawing(over), ()).reached


@settings(max_examples=60, deadline=None)
@given(n=st.integers(5, 14), data=st.data(), ratio=st.floats(0.15, 0.6), degrees=st.floats(0, 360))
def test_every_star_is_one_and_its_hull_is_none(n, data, ratio, degrees):
    k = data.draw(st.integers(2, (n - 1) // 2))
    for lines in (strokes_star(n, k), ring(outline(n, ratio))):
        assert is_star(drawing(turned(lines, degrees)), ()).reason == f"a closed star with {n} points"
    assert not is_star(drawing(turned(ring(polygon(n)), degrees)), ()).reached


@settings(max_examples=60, deadline=None)
@given(data=st.data(), seed=st.integers(0, 1000))
def test_a_star_without_one_stroke_is_open(data, seed):
    n = data.draw(st.integers(5, 9))
    lines = data.draw(st.sampled_from([strokes_star(n, 2), ring(outline(n, 0.4))]))
    del lines[seed % len(lines)]
    assert "not closed" in is_star(drawing(lines), ()).reason


@judges
@settings(max_examples=30, deadline=None)
@given(n=st.integers(0, 25), jitter=st.sampled_from([0.0, 0.05, 0.3]), seed=st.integers(0, 2**32 - 1))
def test_every_scribble_gets_a_verdict(judge, n, jitter, seed):
    rng = np.random.default_rng(seed)
    lines = rng.integers(0, 6, (n, 4)) * 20 + rng.normal(0, 1, (n, 4)) * jitter
    assert judge(drawing(lines.tolist(), PAIR), ()).reason


@judges
def test_margins_are_negative_where_a_drawing_is_refused_and_only_there(judge):
    accepted, refused, obstacles = CASES[judge]
    for lines in accepted.values():
        assert judge(drawing(lines, obstacles), ()).margin > 0
    for lines in refused.values():
        assert (judge(drawing(lines, obstacles), ()).margin or -1) < 0


@judges
def test_state_is_left_alone_and_scores_repeat(judge):
    accepted, refused, obstacles = CASES[judge]
    for lines in [*accepted.values()][:5] + [*refused.values()][:5]:
        state = drawing(lines, obstacles)
        before = repr(state)
        assert judge(state, ()) == judge(state, ())
        assert repr(state) == before
