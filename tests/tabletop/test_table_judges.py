import re
from types import SimpleNamespace

import pytest

from proc3s import SpecError
from proc3s_tabletop.tasks import judges

UP = (0.0, 0.0, 0.0)


def thing(category, color, x, y, z, turned=UP):
    roll, pitch, yaw = turned
    pose = SimpleNamespace(x=x, y=y, z=z, roll=roll, pitch=pitch, yaw=yaw)
    return SimpleNamespace(category=category, color=color, pose=pose)


def state(*things):
    return SimpleNamespace(objects={f"object_{k}": o for k, o in enumerate(things)})


def block(x, y=-0.5, z=0.02, color="red", turned=UP):
    return thing("block", color, x, y, z, turned)


def bowl(x, y=-0.5, z=0.025, color="green", turned=UP):
    return thing("bowl", color, x, y, z, turned)


BLOCKS = {"category": "block"}


def pyramid(gap=0.01, top=0.0, z=0.06, y=-0.5):
    half = (0.04 + gap) / 2
    return state(block(-half), block(half), block(top, y, z))


def on_two(final, **options):
    given = {"supports": 2, "most_gap": 0.02, "count": 1, **options}
    return judges.on(final, (), what=BLOCKS, below=BLOCKS, **given)


def line_of(*offsets, width=0.01, count=5):
    blocks = [block(0.06 * k, -0.5 + off) for k, off in enumerate(offsets)]
    return judges.line(state(*blocks), (), what=BLOCKS, count=count, width=width)


def packed(x, y, **options):
    final = state(block(0.0), block(x, -0.5 + y))
    return judges.within(final, (), what=BLOCKS, centre=[0.0, -0.5], reach=0.06, **options)


def in_bowl(x=0.0, z=0.024, container=None, **options):
    final = state(container or bowl(0.0), block(x, z=z, color="green"))
    return judges.in_(final, (), what={"color": "green", **BLOCKS}, inside={"category": "bowl"}, **options)


def towers(*heights):
    blocks = [block(0.1 * k, z=0.02 + 0.04 * n) for k, h in enumerate(heights) for n in range(h)]
    return judges.stacked(state(*blocks), (), what=BLOCKS, high=3)


def touching(*places):
    return judges.touching(state(*(block(x, y) for x, y in places)), (), what=BLOCKS)


def lying(angle, **options):
    return judges.upright(state(block(0), block(0.1, turned=(angle, 0, 0.7))), (), **options)


def resting(*things):
    return judges.still(state(*things), ())


GOOD = {
    "bridge": lambda: on_two(pyramid()),
    "bridge over the widest gap": lambda: on_two(pyramid(gap=0.0199)),
    "bridge without any gap": lambda: on_two(pyramid(gap=0.0)),
    "bridge that just reaches": lambda: on_two(pyramid(gap=0.01, top=0.0135)),
    "bridge that sank a little": lambda: on_two(pyramid(z=0.0575)),
    "on one": lambda: on_two(state(block(0), block(0.01, z=0.06)), supports=1),
    "line": lambda: line_of(0, 0.0195, 0, 0.0195, 0),
    "slanted line": lambda: line_of(0, 0.05, 0.1, 0.15, 0.2),
    "line of five with a sixth elsewhere": lambda: line_of(0, 0.2, 0, 0, 0, 0),
    "packed along the axes": lambda: packed(0.0599, 0.0599),
    "packed as the crow flies": lambda: packed(0.04, 0.04, measure="distance"),
    "in the bowl": lambda: in_bowl(),
    "in the bowl, leaning on its wall": lambda: in_bowl(0.04, 0.035),
    "tower": lambda: towers(1, 3, 2),
    "chain": lambda: touching((0, -0.5), (0.0415, -0.5), (0.0415, -0.5415)),
    "upright": lambda: lying(0.09),
    "resting": lambda: resting(block(0), block(0.01, z=0.06), bowl(0.2), block(0.2, z=0.024)),
}


@pytest.mark.parametrize("name", GOOD)
def test_holds(name):
    score = GOOD[name]()
    assert score.reached, score.reason
    assert score.reason


BAD = {
    "gap too wide": (lambda: on_two(pyramid(gap=0.0205)), "gap of 20 mm|gap of 21 mm"),
    "only one support": (lambda: on_two(pyramid(gap=0.01, top=0.02)), "0 of 1"),
    "hovers over both": (lambda: on_two(pyramid(z=0.064)), "rests on nothing"),
    "beside both": (lambda: on_two(pyramid(y=-0.46)), "rests on nothing"),
    "bent line": (
        lambda: line_of(0, 0.021, 0, 0.021, 0),
        "within 10.5 mm of one straight line, more than 10",
    ),
    "four in a line": (lambda: line_of(0, 0, 0, 0), "4 of 5"),
    "stacked in a line": (
        lambda: judges.line(
            state(*(block(0.06 * k) for k in range(5)), block(0.0, z=0.06)), (), what=BLOCKS, count=5
        ),
        "4 of 5",
    ),
    "outside along y": (lambda: packed(0.0, 0.0605), "object_1 .* is 60 mm off|is 61 mm off"),
    "outside as the crow flies": (lambda: packed(0.05, 0.05, measure="distance"), "is 71 mm off"),
    "beside the bowl": (lambda: in_bowl(0.105, 0.02), "is 105 mm from the middle"),
    "on the rim": (lambda: in_bowl(0.07, 0.07), "lowest point at z = 0.050"),
    "above the bowl": (lambda: in_bowl(0.0, 0.15), "lowest point at z = 0.130"),
    "in a bowl on its head": (lambda: in_bowl(container=bowl(0.0, turned=(3.14159, 0, 0))), "0 of 1"),
    "no such block": (
        lambda: judges.in_(state(bowl(0)), (), what=BLOCKS, inside={"category": "bowl"}),
        "there is no block",
    ),
    "low tower": (lambda: towers(2, 2), "is 2 high, of 3"),
    "apart": (lambda: touching((0, -0.5), (0.043, -0.5)), "apart: object_1"),
    "corner to corner": (lambda: touching((0, -0.5), (0.0416, -0.4584)), "apart: object_1"),
    "leaning": (lambda: lying(0.11), "object_1 .* leans by 0.11 rad"),
    "in the hand": (lambda: resting(block(0), block(0.1, z=0.12)), "object_1 .* hangs in the air"),
}


@pytest.mark.parametrize("name", BAD)
def test_does_not_hold_and_says_why(name):
    judge, reason = BAD[name]
    score = judge()
    assert not score.reached, score.reason
    assert re.search(reason, score.reason), score.reason


def test_tolerances_are_arguments():
    assert not on_two(pyramid(z=0.0575), tolerance=0.002).reached
    assert not line_of(0, 0.0195, 0, 0.0195, 0, width=0.009).reached
    assert lying(0.11, most=0.12).reached
    assert not in_bowl(depth=0.047).reached


def test_other_bodies_than_blocks_and_bowls_can_be_judged():
    bodies = {"can": {"shape": "cylinder", "radius": 0.03, "height": 0.1, "mass": 0.2}}
    final = state(thing("can", "", 0, -0.5, 0.05), thing("can", "", 0.02, -0.5, 0.15))
    assert judges.stacked(final, (), what={"category": "can"}, bodies=bodies).reached
    assert (
        "object_1 (the can)"
        in judges.on(final, (), what={"name": "object_1"}, below={"name": "object_0"}, bodies=bodies).reason
    )


def test_a_strange_choice_is_an_error_that_names_the_field():
    with pytest.raises(SpecError, match=r"still\.what: colour: unknown key 'colour'; did you mean 'color'"):
        judges.still(state(block(0)), (), what={"colour": "red"})
