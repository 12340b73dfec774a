"""How a body comes to rest on a table that it is let down on."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.engine.choice import engine

ATTEMPTS = 4
"""Where it does not lie still on the face that it seemed to rest on, it is let go from there again."""


def rest(pieces: Sequence[FloatArray]) -> FloatArray:
    """The turn (3, 3) from a body's frame, its origin the centre of mass, to one in which it lies at rest.

    It comes to rest as in the simulator when let go as it is; of all turns it is the least one: no yaw.
    """
    from scipy.spatial import ConvexHull

    hull = ConvexHull(np.vstack(pieces))
    down = np.array([0.0, 0.0, -1.0])
    for _ in range(ATTEMPTS):
        landed = _face_down(hull, engine().landed(pieces, _least_turn(down)))
        if np.allclose(landed, down, atol=1e-6):
            break
        down = landed
    return _least_turn(down)


def _face_down(hull: Any, down: FloatArray) -> FloatArray:
    """The normal of the face on which a hull comes to lie that rolls slowly on from where `down` is down."""
    normals, reach = hull.equations[:, :3], -hull.equations[:, 3]
    ahead = normals @ down
    face = int(np.where(ahead > 0, reach / np.maximum(ahead, 1e-9), np.inf).argmin())
    for _ in range(len(normals)):
        # Where the centre of mass is over the face, as shares of its corners.
        corners = np.vstack([hull.points[hull.simplices[face]].T, np.ones(3)])
        shares, *_ = np.linalg.lstsq(corners, np.append(normals[face] * reach[face], 1.0))
        if shares.min() >= -1e-6:
            break
        face = int(hull.neighbors[face, shares.argmin()])
    return np.asarray(normals[face])


def _least_turn(down: FloatArray) -> FloatArray:
    """The least turn that brings a direction down."""
    from scipy.spatial.transform import Rotation

    target = np.array([0.0, 0.0, -1.0])
    axis, cosine = np.cross(down, target), float(down @ target)
    if np.linalg.norm(axis) < 1e-9:
        return np.eye(3) if cosine > 0 else np.diag([1.0, -1.0, -1.0])
    angle = np.arctan2(np.linalg.norm(axis), cosine)
    return np.asarray(Rotation.from_rotvec(axis / np.linalg.norm(axis) * angle).as_matrix())
