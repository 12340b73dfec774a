"""How bodies look: what the renderer draws of them."""

import math
from itertools import pairwise
from pathlib import Path

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.bullet.client import Client
from proc3s_tabletop.bullet.collision_shapes import collision_shape, written
from proc3s_tabletop.engine.looks import Color
from proc3s_tabletop.objects.shapes import Bowl, Cylinder, Mesh, Shape, Surface

SEGMENTS = 48
"""Of a bowl around its axis."""


def create(shape: Shape, client: Client, folder: Path, color: Color) -> int:
    """The PyBullet id of a body that is only to be looked at; files that it is read from go to `folder`."""
    if isinstance(shape, Bowl | Cylinder):
        # A bowl's pieces have corners for a hull, not its faces; PyBullet draws a cylinder as a capsule.
        path = written(_turned(_profile(shape)), folder)
        surface = client.createVisualShape(client.GEOM_MESH, fileName=str(path), rgbaColor=color)
        return int(client.createMultiBody(0, -1, surface))
    if isinstance(shape, Mesh):
        path = written(_obj(shape.surface), folder)
        surface = client.createVisualShape(client.GEOM_MESH, fileName=str(path), rgbaColor=color)
        return int(client.createMultiBody(0, -1, surface))
    body = int(client.createMultiBody(0, collision_shape(shape, client, folder), -1))
    client.changeVisualShape(body, -1, rgbaColor=color)
    return body


def _profile(shape: Bowl | Cylinder) -> list[tuple[float, float]]:
    """Radii and heights around half of the cut, from the middle of the foot to the top or a bowl's floor."""
    if isinstance(shape, Cylinder):
        radius, half = shape.radius, shape.height / 2
        return [(0, -half), (radius, -half), (radius, half), (0, half)]
    bowl = shape
    low, high, floor = -bowl.height / 2, bowl.height / 2, bowl.wall - bowl.height / 2
    foot, rim, wall = bowl.foot_radius, bowl.rim_radius, bowl.wall
    return [(0, low), (foot, low), (rim, high), (rim - wall, high), (foot - wall, floor), (0, floor)]


def _turned(profile: list[tuple[float, float]]) -> str:
    """The surface of a profile turned about z as an OBJ file, every facet with its own normal."""
    turns = [2 * math.pi * k / SEGMENTS for k in range(SEGMENTS + 1)]
    facets = [_facet(*edge, *turn) for edge in pairwise(profile) for turn in pairwise(turns)]
    faces = ["f " + " ".join(f"{4 * k + i}//{k + 1}" for i in (1, 2, 3, 4)) for k in range(len(facets))]
    return "\n".join([*facets, *faces]) + "\n"


def _obj(surface: Surface) -> str:
    """Triangles as an OBJ file, shaded smoothly."""
    corners = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in surface.vertices]
    normals = [f"vn {x:.5f} {y:.5f} {z:.5f}" for x, y, z in _normals(surface)]
    faces = [" ".join(["f", *(f"{k + 1}//{k + 1}" for k in face)]) for face in surface.faces]
    return "\n".join([*corners, *normals, *faces]) + "\n"


def _normals(surface: Surface) -> FloatArray:
    """The unit normal (n, 3) at every corner: those of its triangles, by their area."""
    a, b, c = np.asarray(surface.vertices, float)[surface.faces].transpose(1, 0, 2)
    summed = np.zeros((len(surface.vertices), 3))
    for k in range(3):
        np.add.at(summed, surface.faces[:, k], np.cross(b - a, c - a))
    normals: FloatArray = summed / np.maximum(np.linalg.norm(summed, axis=1, keepdims=True), 1e-12)
    return normals


def _facet(low: tuple[float, float], high: tuple[float, float], start: float, end: float) -> str:
    """Four corners and their normal, from two points of a profile and two turns."""
    (r0, z0), (r1, z1) = low, high
    corners = [(r0, start, z0), (r0, end, z0), (r1, end, z1), (r1, start, z1)]
    lines = [f"v {r * math.cos(t):.6f} {r * math.sin(t):.6f} {z:.6f}" for r, t, z in corners]
    middle, length = (start + end) / 2, math.hypot(r1 - r0, z1 - z0)
    out, up = (z1 - z0) / length, (r0 - r1) / length
    return "\n".join([*lines, f"vn {out * math.cos(middle):.5f} {out * math.sin(middle):.5f} {up:.5f}"])
