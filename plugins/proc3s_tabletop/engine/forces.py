"""What presses on what while time passes, from forces that an engine measures: the same in all of them."""

from collections.abc import Mapping
from typing import Protocol

from proc3s_tabletop.objects.body import Body

GUARD = 2.0
"""A force that stops a guarded descent, newtons: three times the weight of a block."""


class Pressing(Protocol):
    """What an engine measures of contacts, newtons."""

    @property
    def shapes(self) -> Mapping[str, Body]:
        """The bodies by name."""

    def grip_force(self, name: str) -> float:
        """Normal force of the side of the hand that presses an object less."""

    def presses(self, name: str) -> dict[str, float]:
        """The bodies that press an object, the robot apart, and the upward part of how hard they do."""

    def on_hand(self, held: str | None) -> float:
        """How hard everything but its load presses the hand."""


def between_pads(scene: Pressing) -> str | None:
    """The object that both sides of the hand press, the hardest first."""
    forces = {name: scene.grip_force(name) for name in scene.shapes}
    return hardest({name: force for name, force in forces.items() if force > 0})


def hardest(forces: Mapping[str, float]) -> str | None:
    """The name with the largest force, if there is one."""
    return max(forces, key=lambda name: forces[name], default=None)


class Guard:
    """Says when a descent has met something, as a wrist would feel it.

    `support` is then what the load has met, if it was the load.
    """

    def __init__(self, scene: Pressing, held: str | None) -> None:
        self._scene, self._held = scene, held
        self.support: str | None = None

    def __call__(self) -> bool:
        """Whether anything presses the hand or what it holds, each other apart."""
        force = self._scene.on_hand(self._held)
        loads = self._scene.presses(self._held) if self._held else {}
        if force + sum(loads.values()) <= GUARD:
            return False
        self.support = hardest(loads)
        return True
