"""Shapes as MuJoCo takes them: geoms of a body, one for every convex part."""

import functools
from typing import Any

import mujoco
import numpy as np

from proc3s import FloatArray
from proc3s_mujoco.bits import Kind, mark
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.objects.hulls import grown
from proc3s_tabletop.objects.shapes import MARGIN, Bowl, Box, Cylinder, Mesh, Shape
from proc3s_tabletop.robot.settings import ReferenceSettings

GROUP = 1
"""Of the geoms of objects; rays between the pads look for these only."""
SOLREF, SOLIMP = (0.005, 1.0), (0.95, 0.99, 0.001, 0.5, 2.0)
"""How stiff contacts are: as those of the pads of the hand, so that hardly anything sinks in (measured)."""

THING = "thing/"
"""Begins the names of the bodies, which a user may have given: no other name does."""


def add(spec: Any, name: str, body: Body, settings: ReferenceSettings) -> None:
    """Put a body into a specification, free to move, with the inertia of the box around it."""
    made = spec.worldbody.add_body(name=THING + name)
    made.add_freejoint()
    made.mass, made.ipos = body.mass, [0.0, 0.0, 0.0]
    made.inertia = _inertia(body)
    made.explicitinertial = True
    for geom in _geoms(body.shape, spec, made):
        rub(geom, body, settings)
        mark(geom, Kind.OBJECT)
        geom.mass, geom.group = 0.0, GROUP


def _inertia(body: Body) -> FloatArray:
    """Moments (3,) of the box around a body, kg m2."""
    x, y, z = np.ptp(body.shape.corners(), axis=0) ** 2
    return body.mass / 12 * np.array([y + z, x + z, x + y])


def rub(geom: Any, body: Body, settings: ReferenceSettings) -> None:
    """Give a geom friction: MuJoCo takes the larger of two coefficients, PyBullet their product.

    The table has none of its own here, and what lies on it the product of both; of two objects the rougher
    counts.
    """
    geom.friction = [
        body.friction * settings.table_friction,
        body.spinning_friction,
        body.rolling_friction,
    ]
    geom.condim = 6 if body.rolling_friction or body.spinning_friction else 3
    geom.solref, geom.solimp = SOLREF, SOLIMP


@functools.singledispatch
def _geoms(shape: Shape, spec: Any, body: Any) -> list[Any]:
    """The geoms of a shape, added to a body."""
    raise TypeError(f"no geoms are known for a {type(shape).__name__}")


@_geoms.register
def _(shape: Box, spec: Any, body: Any) -> list[Any]:
    return [body.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=np.array(shape.size) / 2)]


@_geoms.register
def _(shape: Cylinder, spec: Any, body: Any) -> list[Any]:
    size = [shape.radius, shape.height / 2, 0.0]
    return [body.add_geom(type=mujoco.mjtGeom.mjGEOM_CYLINDER, size=size)]


@_geoms.register(Bowl)
@_geoms.register(Mesh)
def _(shape: Bowl | Mesh, spec: Any, body: Any) -> list[Any]:
    return [hull(spec, body, f"{body.name}/{k}", corners) for k, corners in enumerate(surface(shape))]


@functools.lru_cache(64)
def surface(shape: Bowl | Mesh) -> list[FloatArray]:
    """The corners (n, 3) of every convex part: PyBullet surrounds them with a margin, MuJoCo does not."""
    return [grown(corners, MARGIN) for corners in shape.parts()]


def hull(spec: Any, body: Any, name: str, corners: FloatArray) -> Any:
    """Add a geom to a body, the hull of corners (n, 3) in its frame."""
    mesh = spec.add_mesh(name=name)
    mesh.uservert = corners.ravel()
    mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_CONVEX
    return body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=name)
