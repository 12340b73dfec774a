"""A small drawing world, as the box sees it."""

import textwrap
from pathlib import Path

import numpy as np
import pytest

from proc3s.domain.plan_batch import Parameter, Signature
from proc3s.plugins.builtin import register_samplers
from proc3s.sandbox import BoxedSketch, Limits, Program

PRELUDE = """
from dataclasses import dataclass, field
from typing import Any, List

CANVAS = 100.0

@dataclass
class Obstacle:
    name: str
    x: float
    y: float

@dataclass
class Pose:
    x: float
    y: float
    z: float
    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0

@dataclass
class Scene:
    obstacles: List[Obstacle] = field(default_factory=list)

@dataclass
class ContinuousSampler:
    min: float
    max: float

@dataclass
class DiscreteSampler:
    values: List[Any]

@dataclass
class Action:
    name: str
    params: List[Any] = field(default_factory=list)
"""
INITIAL = (
    "Scene(obstacles=[Obstacle(name='object_0', x=50.0, y=50.0), Obstacle(name='object_1', x=20.0, y=70.0)])"
)
OBJECTS = ("object_0", "object_1")
SIGNATURES = (
    Signature("draw_line", tuple(Parameter(n, "float", 0, 100) for n in ("x1", "y1", "x2", "y2"))),
    Signature("repeat", (Parameter("times", "int", 1, 9),)),
    Signature("pick", (Parameter("item", "object", choices=OBJECTS), Parameter("grasp", "grasp"))),
    Signature("look", (Parameter("at", "point"), Parameter("mode", "str", choices=("near", "far")))),
)


def samplers():
    found = []
    register_samplers(found.append)
    return tuple(found)


def program(source, answer="sketch", **changes):
    data = {
        "source": textwrap.dedent(source).strip("\n"),
        "answer": answer,
        "prelude": PRELUDE,
        "initial": INITIAL,
        "signatures": SIGNATURES,
        "samplers": samplers(),
    }
    return Program(**(data | changes))


@pytest.fixture
def box():
    """Loads programs; closes all boxes in the end."""
    boxes = []

    def load(source, answer="sketch", limits=None, **changes):
        boxes.append(BoxedSketch(program(source, answer, **changes), limits or Limits()))
        return boxes[-1]

    yield load
    for opened in boxes:
        opened.close()


def cube(n, dim, seed=0):
    return np.random.default_rng(seed).random((n, dim))


LINE = """
def gen_plan(state, x, y):
    o = state.obstacles[0]
    return [Action("draw_line", [o.x, o.y, x, y])]

def gen_domain(state):
    return {"x": ContinuousSampler(0, 100), "y": ContinuousSampler(20, 40)}
"""


def descendants(process="self"):
    """Process ids of the children of all threads, and of their children, and so on."""
    tasks = Path(f"/proc/{process}/task").iterdir()
    own = {child for task in tasks for child in (task / "children").read_text().split()}
    return own.union(*map(descendants, own))
