"""What presses on what while time passes: contacts that carry a force, by name."""

from proc3s_tabletop.bullet.contacts import BODY_B, FORCE, LINK_A, NORMAL, grip_force
from proc3s_tabletop.bullet.simulation import TableScene

GUARD = 2.0
"""A force that stops a guarded descent, newtons: three times the weight of a block."""


def between_pads(scene: TableScene) -> str | None:
    """The object that both sides of the hand press, the hardest first."""
    forces = {name: grip_force(scene, name) for name in scene.bodies}
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
        scene, hand = self._scene, self._scene.robot.hand_links
        points = [p for p in scene.client.getContactPoints(scene.robot.id) if p[LINK_A] in hand]
        force = sum(p[FORCE] for p in points if scene.named.get(p[BODY_B]) != self._held)
        loads = _presses(scene, self._held)
        if force + sum(loads.values()) <= GUARD:
            return False
        self.support = _hardest(loads)
        return True


def support(scene: TableScene, name: str) -> str | None:
    """What pushes an object up hardest."""
    return _hardest(_presses(scene, name))


def _hardest(forces: dict[str, float]) -> str | None:
    return max(forces, key=lambda n: forces[n], default=None)


def _presses(scene: TableScene, name: str | None) -> dict[str, float]:
    """The bodies that press an object, the robot apart, and the upward part of how hard they do, newtons."""
    forces: dict[str, float] = {}
    for point in scene.client.getContactPoints(scene.bodies[name]) if name else ():
        if point[BODY_B] in scene.named and point[FORCE] > 0:
            other = scene.named[point[BODY_B]]
            forces[other] = forces.get(other, 0.0) + point[FORCE] * abs(point[NORMAL][2])
    return forces
