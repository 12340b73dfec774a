"""The judge of a stack that has to stay: it lets time pass."""

import dataclasses
import re

import pytest

from proc3s.plugins.registry import open_registry
from proc3s_tabletop.bullet.engine import BulletEngine
from proc3s_tabletop.catalogue.body_specs import bodies_of
from proc3s_tabletop.robot import frames as poses
from proc3s_tabletop.robot.settings import ReferenceSettings
from proc3s_tabletop.tasks.standing import on_another

YCB = open_registry().domain("ycb")
BODIES = YCB.spec.world.args["bodies"]
START = YCB.scene(YCB.spec.tasks["stacking"], 0)
CAN, BERRY, APPLE = "object_2", "object_3", "object_4"
LID, BERRY_LOW, APPLE_LOW = 0.0427, 0.0216, 0.0370


def moved(name, **pose):
    """The first scene with one object elsewhere."""
    thing = START.objects[name]
    thing = dataclasses.replace(thing, pose=dataclasses.replace(thing.pose, **pose))
    return dataclasses.replace(START, objects={**START.objects, name: thing})


def over_can(name, low, x=0.0, up=0.0):
    """An object on the lid of the can, aside by x, or above it."""
    can = START.objects[CAN].pose
    return moved(name, x=can.x + x, y=can.y, z=can.z + LID + low + up)


@pytest.fixture(scope="module")
def stacked():
    """The strawberry where it comes to rest on the can."""
    bodies = bodies_of(BODIES)
    names, start = (CAN, BERRY), over_can(BERRY, BERRY_LOW)
    bench = BulletEngine().grips(
        {name: bodies[START.objects[name].category] for name in names}, ReferenceSettings()
    )
    lies = [(bodies[start.objects[n].category], poses.frame(start.objects[n].pose)) for n in names]
    rest = bench.rest(tuple(lies))
    bench.close()
    return moved(BERRY, **poses.numbers(rest.frames[1]))


def test_a_berry_on_a_can_stays(stacked):
    score = on_another(stacked, (), bodies=BODIES)
    assert score.reached
    assert score.reason == "object_3 (the red strawberry) rests on object_2 (the blue meat_can)"


@pytest.mark.parametrize(
    ("final", "why"),
    [
        (START, "everything lies on the table"),
        (over_can(BERRY, BERRY_LOW, up=0.03), "moves by .* mm when it is let go"),
        (over_can(APPLE, APPLE_LOW, x=0.05), "moves by .* mm when it is let go"),
        (moved(BERRY, x=0.29, y=-0.79, z=0.2), "object_3 .* moves by .* mm"),
    ],
    ids=["nothing moved", "in the air", "over the edge", "high above the table"],
)
def test_what_does_not_stay_is_no_stack(final, why):
    score = on_another(final, (), bodies=BODIES)
    assert not score.reached
    assert re.search(why, score.reason), score.reason


def test_what_is_meant_may_be_chosen(stacked):
    only_apples = on_another(stacked, (), what={"category": "apple"}, bodies=BODIES)
    assert (only_apples.reached, only_apples.reason) == (False, "everything lies on the table")
    on_apples = on_another(stacked, (), below={"category": "apple"}, bodies=BODIES)
    assert (on_apples.reached, on_apples.reason) == (False, "object_3 (the red strawberry) rests on nothing")
