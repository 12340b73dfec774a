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
CHANGE = 0.04
"""Between the colours of two pixels, from 0 to 1, beyond which there is an edge between them."""
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
        """Every second pixel first, then all where colours change, those at edges four times."""
        from PIL import Image

        width, height = looks.SIZE
        pixels = np.moveaxis(np.mgrid[0:height, 0:width], 0, -1).astype(float)
        coarse = self._seen((pixels[::2, ::2] + 0.5).reshape(-1, 2)).reshape(height // 2, width // 2, 3)
        drawn = np.array(_image(coarse).resize(looks.SIZE, Image.Resampling.BILINEAR)) / 255
        changing = _edges(coarse).repeat(2, axis=0).repeat(2, axis=1)
        drawn[changing] = self._seen(pixels[changing])
        edges = _edges(drawn) & changing
        finer = self._seen((pixels[edges] + CORNERS[:, None]).reshape(-1, 2))
        drawn[edges] = finer.reshape(len(CORNERS), -1, 3).mean(axis=0)
        return _image(drawn)

    def _seen(self, pixels: FloatArray) -> FloatArray:
        """Colours (n, 3) from 0 to 1 at rows and columns (n, 2)."""
        eye, ways = np.array(looks.EYE), _ways(*pixels.T)
        geoms, far, normals = self._cast(eye, ways)
        hit = geoms >= 0
        rows = pixels[:, 0].round().astype(int).clip(0, looks.SIZE[1] - 1)
        colors: FloatArray = looks.background(looks.SIZE[1])[rows, 0] / 255
        lamp = np.array(looks.LIGHT) / np.linalg.norm(looks.LIGHT)
        lit = self._lit(eye + ways[hit] * far[hit, None])
        shade = looks.AMBIENT + looks.DIFFUSE * (normals[hit] @ lamp).clip(0) * lit
        colors[hit] = self._colors[geoms[hit]] * shade[:, None]
        return colors

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


def _edges(colors: FloatArray) -> NDArray[np.bool_]:
    """Which pixels of a picture (height, width, 3) differ from the next one to the right or below."""
    found: NDArray[np.bool_] = np.zeros(colors.shape[:2], bool)
    for axis in (0, 1):
        differ = np.abs(np.diff(colors, axis=axis)).max(axis=2) > CHANGE
        pad = [(0, 1) if a == axis else (0, 0) for a in (0, 1)]
        found |= np.pad(differ, pad)
        found |= np.pad(differ, [p[::-1] for p in pad])
    return found


def _image(colors: FloatArray) -> "Image":
    """Colours (height, width, 3) from 0 to 1 as a picture."""
    from PIL import Image

    return Image.fromarray((255 * colors.clip(0, 1)).round().astype(np.uint8))
