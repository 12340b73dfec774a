"""Hulls of corners, moved in or out."""

import numpy as np

from proc3s import FloatArray


def grown(corners: FloatArray, by: float) -> FloatArray:
    """Corners (n, 3) of a hull, moved such that the planes around each move outwards by so much, m, by least
    squares; inwards where it is negative."""
    from scipy.spatial import ConvexHull

    hull = ConvexHull(corners)
    moved = corners.copy()
    for k in hull.vertices:
        normals = hull.equations[(hull.simplices == k).any(axis=1), :3]
        step, *_ = np.linalg.lstsq(normals, np.full(len(normals), by), rcond=0.1)
        moved[k] += step
    corners_of_hull: FloatArray = moved[hull.vertices]
    return corners_of_hull
