"""What presses on what while time passes: contacts that carry a force, by name."""

import numpy as np

from proc3s_mujoco.contacts import force, grip_force, of_thing
from proc3s_mujoco.simulation import TableScene

GUARD = 2.0
"""A force that stops a guarded descent, newtons: three times the weight of a block."""


def between_pads(scene: TableScene) -> str | None:
    """The object that both sides of the hand press, the hardest first."""
    forces = {name: grip_force(scene, name) for name in scene.shapes}
    return _hardest({name: force for name, force in forces.items() if force > 0})


class Guard:
    """Says when a descent has met something, as a wrist would feel it.

    `support` is then what the load has met, if it was the load.
    """

    def __init__(self, scene: TableScene, held: str | None) -> None:
        self._scene, self._held = scene, held
        self.support: str | None = None

    def __call__(self) -> bool:
        """Whether anything presses the hand or what it holds, each other apart."""
        loads = _presses(self._scene, self._held)
        if self._on_hand() + sum(loads.values()) <= GUARD:
            return False
        self.support = _hardest(loads)
        return True

    def _on_hand(self) -> float:
        """How hard everything but its load presses the hand, newtons."""
        scene, parts = self._scene, self._scene.parts
        pairs = scene.state.data.contact.geom
        on_hand = parts.hand[pairs].sum(axis=1) == 1
        if self._held:
            on_hand &= (parts.owner[pairs] != parts.things[self._held].number).all(axis=1)
        return sum(force(scene.state, k) for k in np.flatnonzero(on_hand).tolist())


def support(scene: TableScene, name: str) -> str | None:
    """What pushes an object up hardest."""
    return _hardest(_presses(scene, name))


def _hardest(forces: dict[str, float]) -> str | None:
    return max(forces, key=lambda n: forces[n], default=None)


def _presses(scene: TableScene, name: str | None) -> dict[str, float]:
    """The bodies that press an object, the robot apart, and the upward part of how hard they do, newtons."""
    forces: dict[str, float] = {}
    for contact in of_thing(scene, name) if name else ():
        pressed = force(scene.state, contact.index)
        if pressed > 0:
            forces[contact.other] = forces.get(contact.other, 0.0) + pressed * abs(contact.normal[2])
    return forces
