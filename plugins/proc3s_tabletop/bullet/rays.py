"""Rays between the fingers: how much of the pads an object covers."""

import numpy as np

from proc3s_tabletop.bullet.simulation import TableScene
from proc3s_tabletop.robot.settings import INSIDE


def cover(scene: TableScene) -> dict[str, float]:
    """The share of the grid of rays between the pads that meets each object, by name."""
    hits = [hit[0] for hit in scene.client.rayTestBatch(*_rays(scene))]
    return {name: hits.count(body) / len(hits) for name, body in scene.bodies.items()}


def _rays(scene: TableScene) -> tuple[list[list[float]], list[list[float]]]:
    """Where the rays between the pads start and end, each way over the pads' width and along the fingers."""
    settings, robot = scene.settings, scene.robot
    left, right = robot.pads()
    point, along = robot.grasp_point()
    middle = (left + right) / 2
    middle = middle + along * ((point - middle) @ along)
    across = np.cross(along, right - left)
    across /= np.linalg.norm(across)
    half = (left - right) / 2 * INSIDE
    grid = [middle + across * w + along * h for h in settings.cover_along for w in settings.cover_across]
    return [(x + half).tolist() for x in grid], [(x - half).tolist() for x in grid]
