"""Samplers that make objects of a type: their numbers cross, the program gets the object."""

import dataclasses

import numpy as np
import pytest

from proc3s.domain.values import Pose
from proc3s.sandbox import BoxedSketch, SketchContractError
from proc3s.specs.domain import SamplerSpec

from .conftest import PRELUDE, program, samplers


@dataclasses.dataclass(frozen=True)
class Straight:
    """Poses along x, two of whose numbers are drawn."""

    far: float
    dim = 2

    def decode(self, u):
        """Shape (n, 2) to (n, 6)."""
        return np.stack([self.far * u[:, 0], *(0 * u[:, 0],) * 4, u[:, 1]], axis=1)


STRAIGHT = SamplerSpec(
    name="StraightSampler",
    summary="A pose along x.",
    params={"far": "float"},
    gives="Pose",
    target=f"{__name__}:Straight",
)
CLASSES = (
    PRELUDE
    + """
@dataclass
class StraightSampler:
    far: float
"""
)


def box(source):
    return BoxedSketch(program(source, prelude=CLASSES, samplers=(*samplers(), STRAIGHT)))


SOURCE = """
def gen_plan(initial, times, grasp, mode, spot=None):
    return [
        Action("repeat", [times]),
        Action("pick", ["object_0", grasp]),
        Action("look", [[grasp.x, grasp.yaw, 1], mode]),
    ]

def gen_domain(initial):
    return {
        "times": DiscreteSampler([3, 7]),
        "grasp": StraightSampler(far=4.0),
        "mode": DiscreteSampler(["near", "far"]),
    }
"""


def test_the_program_gets_an_object_and_its_neighbours_keep_their_places():
    with box(SOURCE) as sketch:
        assert sketch.space.dim == 4
        u = np.array([[0.9, 0.25, 0.5, 0.1], [0.1, 0.5, 0.125, 0.9]])
        batch = sketch.plans(u)
        assert [a.args for a in batch.plan(0)] == [
            (7,),
            ("object_0", Pose(1.0, 0, 0, 0, 0, 0.5)),
            ((1.0, 0.5, 1.0), "near"),
        ]
        assert batch.plan(1)[1].args[1] == Pose(2.0, 0, 0, 0, 0, 0.125)
        assert batch.plan(1)[2].args[1] == "far"


def test_what_the_parameter_does_is_checked_before_sampling():
    with pytest.raises(SketchContractError, match="unknown skill 'pik'") as raised:
        box(SOURCE.replace('"pick"', '"pik"'))
    assert raised.value.line == 4


def test_an_objects_numbers_may_also_cross_as_a_numpy_array():
    with box(SOURCE.replace('"object_0", grasp', '"object_0", np.array([*vars(grasp).values()])')) as sketch:
        pose = sketch.plans(np.array([[0.0, 0.25, 0.5, 0.0]])).plan(0)[1].args[1]
        assert pose == Pose(1.0, 0, 0, 0, 0, 0.5)
