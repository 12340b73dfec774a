"""A table with blocks and a bowl, as the box sees it."""

from proc3s.domain.plan_batch import Parameter, Signature

PRELUDE = """
from dataclasses import dataclass, field
from typing import Any, Dict, List
import numpy as np

CATEGORIES = ["block", "bowl"]
TABLE_BOUNDS = [[-0.3, 0.3], [-0.8, -0.2], [0.0, 0.0]]
TABLE_CENTER = (0.0, -0.5, 0.0)
BLOCK_SIZE = 0.04

@dataclass
class ArrangePose:
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0

    @property
    def point(self):
        return np.array([self.x, self.y, self.z])

    def __iter__(self):
        return iter((self.x, self.y, self.z, self.roll, self.pitch, self.yaw))

@dataclass
class ArrangeObject:
    category: str
    color: str
    pose: ArrangePose

@dataclass
class ArrangeBelief:
    objects: Dict[str, ArrangeObject] = field(default_factory=dict)

    def __getitem__(self, name):
        return self.objects[name]

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
SCENE = (
    ("object_0", "block", "red", 0.1),
    ("object_1", "block", "blue", -0.1),
    ("object_2", "bowl", "green", 0.2),
)
OBJECTS = ", ".join(
    f"{name!r}: ArrangeObject(category={kind!r}, color={color!r}, pose=ArrangePose(x={x!r}, y=-0.5, z=0.02))"
    for name, kind, color, x in SCENE
)
INITIAL = f"ArrangeBelief(objects={{{OBJECTS}}})"
NAMES = tuple(name for name, *_ in SCENE)
SIGNATURES = (
    Signature("pick", (Parameter("o", "object", choices=NAMES), Parameter("g", "grasp"))),
    Signature(
        "place",
        (Parameter("o", "object", choices=NAMES), Parameter("g", "grasp"), Parameter("p", "pose")),
    ),
    Signature("push", tuple(Parameter(n, "float", -1, 1) for n in ("x", "y", "z"))),
    Signature("move", (Parameter("to", "point"),)),
)
TABLETOP = {"prelude": PRELUDE, "initial": INITIAL, "signatures": SIGNATURES}
