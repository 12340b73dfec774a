"""How much of the pads an object covers."""

from proc3s_tabletop.bullet.simulation import TableScene
from proc3s_tabletop.engine.grasp_rays import rays


def cover(scene: TableScene) -> dict[str, float]:
    """The share of the grid of rays between the pads that meets each object, by name."""
    starts, ends = rays(scene.robot, *scene.robot.pads())
    hits = [hit[0] for hit in scene.client.rayTestBatch(starts.tolist(), ends.tolist())]
    return {name: hits.count(body) / len(hits) for name, body in scene.bodies.items()}
