"""Pictures of snapshots, drawn by rays: they need neither a display nor a graphics library."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from proc3s import FloatArray
from proc3s_mujoco import shapes, specs
from proc3s_mujoco.arm import Robot
from proc3s_mujoco.hand import State
from proc3s_mujoco.parts import Parts
from proc3s_tabletop.engine import looks
from proc3s_tabletop.engine.snapshot import Snapshot
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.objects.shapes import Mesh, Surface
from proc3s_tabletop.robot.settings import TABLE_BOUNDS, ReferenceSettings

if TYPE_CHECKING:
    from PIL.Image import Image

SEEN = np.array([1, 1, 1, 0, 0, 0], np.uint8)
"""The groups of geoms that are drawn: the table, the objects, and what the robot looks like."""
HIDDEN = 4
"""A group that is not."""
CORNERS = np.array([(-0.25, -0.25), (0.25, -0.25), (-0.25, 0.25), (0.25, 0.25)])
"""Where in a pixel at an edge rays are cast, in pixels from its middle."""
CREASE = 0.9
"""Cosine between normals beyond which two pixels have an edge between them."""
NEAR, FAR = 0.002, 100.0
"""What the light meets less than this before a point is the point, and how far rays go, m."""
SHADE = 0.45
"""Share of the light that reaches the shade."""


class Studio:
    """The table, the robot and named bodies as they look, and a camera; colours are names."""

    def __init__(self, bodies: Mapping[str, Body], colors: Mapping[str, str]) -> None:
        settings = ReferenceSettings()
        spec = specs.empty(settings)
        _add_top(spec)
        specs.add_robot(spec, settings, visuals=True)
        for name, body in bodies.items():
            shapes.add(spec, name, body, settings)
            if isinstance(body.shape, Mesh):
                _dress(spec, name, body.shape.surface)
        self._state = State(spec.compile())
        self._robot = Robot(self._state, settings)
        self._parts = Parts(self._state.model, bodies)
        self._colors = _painted(self._state.model, self._parts, colors)

    def picture(self, snapshot: Snapshot) -> "Image":
        """How a snapshot looks."""
        self._robot.put_arm(np.array(snapshot.q))
        self._robot.put_fingers(snapshot.angle)
        if snapshot.linkage:
            self._robot.put_linkage(snapshot.linkage)
        for name, (position, (x, y, z, w)) in snapshot.frames:
            self._state.data.qpos[self._parts.things[name].position] = *position, w, x, y, z
        return self._shot()

    def close(self) -> None:
        """Nothing that would have to be released."""

    def _shot(self) -> "Image":
        from PIL import Image

        width, height = looks.SIZE
        pixels = np.moveaxis(np.mgrid[0:height, 0:width], 0, -1).reshape(-1, 2).astype(float)
        drawn, normals = self._seen(pixels)
        at = np.flatnonzero(_edges(normals.reshape(height, width, 3)))
        finer, _ = self._seen((pixels[at] + CORNERS[:, None]).reshape(-1, 2))
        drawn[at] = finer.reshape(len(CORNERS), -1, 3).mean(axis=0)
        return Image.fromarray((255 * drawn.clip(0, 1)).astype(np.uint8).reshape(height, width, 3))

    def _seen(self, pixels: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Colours (n, 3) from 0 to 1 and normals (n, 3) at rows and columns (n, 2); 0 for the background."""
        eye, ways = np.array(looks.EYE), _ways(*pixels.T)
        geoms, far, normals = self._cast(eye, ways)
        points = eye + ways * far[:, None]
        lamp = np.array(looks.LIGHT) / np.linalg.norm(looks.LIGHT)
        shade = looks.AMBIENT + looks.DIFFUSE * (normals @ lamp).clip(0) * self._lit(points)
        sky = looks.background(looks.SIZE[1])[pixels[:, 0].round().astype(int), 0] / 255
        hit = (geoms >= 0)[:, None]
        return np.where(hit, self._colors[geoms] * shade[:, None], sky), np.where(hit, normals, 0.0)

    def _lit(self, points: FloatArray) -> FloatArray:
        """How much of the light reaches points (n, 3): all, or what is left in the shade."""
        lamp = np.array(looks.LIGHT) / np.linalg.norm(looks.LIGHT) * looks.LIGHT_DISTANCE
        away = np.linalg.norm(points - lamp, axis=1)
        _, far, _ = self._cast(lamp, (points - lamp) / away[:, None])
        lit: FloatArray = np.where(far > away - NEAR, 1.0, SHADE)
        return lit

    def _cast(self, start: FloatArray, ways: FloatArray) -> tuple[Any, FloatArray, FloatArray]:
        """What rays along directions (n, 3) meet: geoms (n,) or -1, distances (n,) and normals (n, 3)."""
        state, n = self._state, len(ways)
        geoms, far, normals = np.full(n, -1, np.int32), np.zeros(n), np.zeros(3 * n)
        mujoco.mj_multiRay(
            state.model, state.placed(), start, ways.ravel(), SEEN, True, -1, geoms, far, normals, n, FAR
        )
        return geoms, far, normals.reshape(-1, 3)


def _add_top(spec: Any) -> None:
    """The table, a little beyond its bounds, and large enough for the robot to stand on."""
    (x0, x1), (y0, _) = TABLE_BOUNDS
    half = [(x1 - x0) / 2 + 0.05, (0.12 - y0 + 0.05) / 2, looks.THICKNESS / 2]
    middle = [(x0 + x1) / 2, 0.12 - half[1], -looks.THICKNESS / 2]
    top = spec.worldbody.add_geom(name=specs.TABLE, type=mujoco.mjtGeom.mjGEOM_BOX, size=half, pos=middle)
    top.rgba = looks.WOOD


def _dress(spec: Any, name: str, surface: Surface) -> None:
    """Let a body look like its mesh instead of the convex pieces that it is simulated by."""
    body = spec.body(shapes.THING + name)
    for piece in body.geoms:
        piece.group = HIDDEN
    mesh = spec.add_mesh(name=f"{body.name}/surface")
    mesh.uservert, mesh.userface = np.ravel(surface.vertices), np.ravel(surface.faces)
    mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname=mesh.name, group=shapes.GROUP, contype=0)


def _painted(model: Any, parts: Parts, colors: Mapping[str, str]) -> FloatArray:
    """The colours (n, 3) of all geoms: those of the robot are its makers'."""
    own = np.where(model.geom_matid[:, None] >= 0, model.mat_rgba[model.geom_matid], model.geom_rgba)
    for name, thing in parts.things.items():
        own[thing.geoms] = looks.color_of(colors[name])
    painted: FloatArray = own[:, :3].astype(float)
    return painted


def _ways(rows: FloatArray, columns: FloatArray) -> FloatArray:
    """Directions (n, 3) from the eye through points of the picture, given in pixels."""
    width, height = looks.SIZE
    ahead = np.subtract(looks.AIM, looks.EYE)
    ahead /= np.linalg.norm(ahead)
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    scale = 2 * np.tan(np.radians(looks.VIEW_ANGLE) / 2) / height
    x, y = (columns + 0.5 - width / 2) * scale, (rows + 0.5 - height / 2) * scale
    ways = ahead + x[:, None] * right - y[:, None] * np.cross(right, ahead)
    return np.ascontiguousarray(ways / np.linalg.norm(ways, axis=1, keepdims=True))


def _edges(normals: FloatArray) -> NDArray[np.bool_]:
    """Which pixels of normals (height, width, 3) differ from the next one to the right or below."""
    found: NDArray[np.bool_] = np.zeros(normals.shape[:2], bool)
    for axis in (0, 1):
        here = np.delete(normals, -1, axis=axis)
        after = np.delete(normals, 0, axis=axis)
        differ = ((here * after).sum(axis=2) < CREASE) & ((here != 0) | (after != 0)).any(axis=2)
        pad = [(0, 1) if a == axis else (0, 0) for a in (0, 1)]
        found |= np.pad(differ, pad)
        found |= np.pad(differ, [p[::-1] for p in pad])
    return found
