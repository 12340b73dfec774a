"""States, poses, actions and plans: the plain data that everything else passes around."""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

from proc3s.wording import number

FloatArray: TypeAlias = NDArray[np.float64]


@dataclass(frozen=True)
class Pose:
    """A rigid pose in the world frame: metres, and roll, pitch, yaw in radians (fixed axes x, y, z)."""

    x: float
    y: float
    z: float
    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0


Value: TypeAlias = float | int | str | tuple[float, ...] | Pose


@dataclass(frozen=True)
class Action:
    """A ground action: the name of a skill and one value for each of its parameters."""

    skill: str
    args: tuple[Value, ...]

    def __str__(self) -> str:
        return f"{self.skill}({', '.join(number(_plain(value)) for value in self.args)})"

    def to_json(self) -> dict[str, Any]:
        """The action as it stands in a summary; a pose becomes its six numbers."""
        return {"skill": self.skill, "args": [_plain(value) for value in self.args]}

    @classmethod
    def from_json(cls, action: Mapping[str, Any]) -> "Action":
        """The action again: six numbers are a pose, other lists points."""
        return cls(action["skill"], tuple(_value(arg) for arg in action["args"]))


Plan: TypeAlias = tuple[Action, ...]


def _plain(value: Value) -> Any:
    return list(dataclasses.astuple(value)) if isinstance(value, Pose) else value


def _value(plain: Any) -> Value:
    if not isinstance(plain, list):
        return cast(Value, plain)
    return Pose(*plain) if len(plain) == len(dataclasses.fields(Pose)) else tuple(plain)
