"""How hard things press one another while time passes: contacts that carry a force, by name."""

import numpy as np

from proc3s_mujoco.contacts import force, of_thing
from proc3s_mujoco.simulation import TableScene


def on_hand(scene: TableScene, held: str | None) -> float:
    """How hard everything but its load presses the hand, newtons."""
    parts, pairs = scene.parts, scene.state.data.contact.geom
    pressed = parts.hand[pairs].sum(axis=1) == 1
    if held:
        pressed &= (parts.owner[pairs] != parts.things[held].number).all(axis=1)
    return sum(force(scene.state, k) for k in np.flatnonzero(pressed).tolist())


def presses(scene: TableScene, name: str) -> dict[str, float]:
    """The bodies that press an object, the robot apart, and the upward part of how hard they do, newtons."""
    forces: dict[str, float] = {}
    for contact in of_thing(scene, name):
        pressed = force(scene.state, contact.index)
        if pressed > 0:
            forces[contact.other] = forces.get(contact.other, 0.0) + pressed * abs(contact.normal[2])
    return forces
