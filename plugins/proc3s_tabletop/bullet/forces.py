"""How hard things press one another while time passes: contacts that carry a force, by name."""

from proc3s_tabletop.bullet.contacts import BODY_B, FORCE, LINK_A, NORMAL
from proc3s_tabletop.bullet.simulation import TableScene


def on_hand(scene: TableScene, held: str | None) -> float:
    """How hard everything but its load presses the hand, newtons."""
    hand = scene.robot.hand_links
    points = [p for p in scene.client.getContactPoints(scene.robot.id) if p[LINK_A] in hand]
    return float(sum(p[FORCE] for p in points if scene.named.get(p[BODY_B]) != held))


def presses(scene: TableScene, name: str) -> dict[str, float]:
    """The bodies that press an object, the robot apart, and the upward part of how hard they do, newtons."""
    forces: dict[str, float] = {}
    for point in scene.client.getContactPoints(scene.bodies[name]):
        if point[BODY_B] in scene.named and point[FORCE] > 0:
            other = scene.named[point[BODY_B]]
            forces[other] = forces.get(other, 0.0) + point[FORCE] * abs(point[NORMAL][2])
    return forces
