"""How much of the pads an object covers."""

import mujoco
import numpy as np

from proc3s_mujoco.shapes import GROUP
from proc3s_mujoco.simulation import TableScene
from proc3s_tabletop.engine.grasp_rays import rays

ONLY_OBJECTS = np.array([group == GROUP for group in range(mujoco.mjNGROUP)], np.uint8)


def cover(scene: TableScene) -> dict[str, float]:
    """The share of the grid of rays between the pads that meets each object, by name."""
    starts, ends = rays(scene.robot, *scene.robot.pads())
    model, data = scene.state.model, scene.state.placed()
    met = np.zeros(len(scene.shapes), int)
    geom = np.zeros(1, np.int32)
    for start, way in zip(starts, ends - starts, strict=True):
        if 0 <= mujoco.mj_ray(model, data, start, way, ONLY_OBJECTS, True, -1, geom) <= 1:
            met[scene.parts.owner[geom[0]]] += 1
    return dict(zip(scene.shapes, (met / len(starts)).tolist(), strict=True))
