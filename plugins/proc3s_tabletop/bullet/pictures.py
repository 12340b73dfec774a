"""Pictures of snapshots, drawn without a display in a client of their own: no simulation ever notices."""

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.bullet.arm import Robot
from proc3s_tabletop.bullet.client import Client
from proc3s_tabletop.bullet.visuals import color_of, create
from proc3s_tabletop.engine.snapshot import Snapshot
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.objects.extents import rotation
from proc3s_tabletop.robot.frames import Frame, numbers
from proc3s_tabletop.robot.settings import TABLE_BOUNDS, ReferenceSettings

if TYPE_CHECKING:
    from PIL.Image import Image

SIZE = (480, 360)
"""Of a picture, pixels."""
SAMPLES = 2
"""Pixels are drawn this many times finer each way, and averaged: smooth edges."""

EYE, AIM = (0.36, -1.56, 0.90), (0.0, -0.44, 0.06)
"""The camera and what it looks at, metres: over the far edge of the table, towards the robot."""
VIEW_ANGLE = 36.0
"""Upwards, degrees."""
LIGHT, LIGHT_DISTANCE = (0.4, -0.9, 2.4), 5.0
"""Where the light comes from, and how far away it is, m: nearer, it leaves half of the table in the dark."""
RED, RIM = (220, 0, 0), 8
"""Of a mark, and how far it is around what it marks, pixels."""
SKY, GROUND = (236, 240, 245), (205, 212, 220)
"""The background at the top and at the bottom, RGB."""

WOOD = (0.80, 0.71, 0.58, 1.0)
STEEL, JOINT, DARK = (0.75, 0.77, 0.80, 1.0), (0.36, 0.55, 0.72, 1.0), (0.2, 0.21, 0.23, 1.0)
ARM_COLORS = {"base": DARK, "gripper": DARK, "shoulder": JOINT, "wrist": JOINT}
"""By the names that people give the parts; the others are of steel."""


def draw(bodies: Mapping[str, Body], colors: Mapping[str, str], film: Sequence[Snapshot], path: Path) -> None:
    """Write the last snapshot to `path`, and every one beside it with `-step0`, `-step1`, ... to its name."""
    studio = Studio(bodies, colors)
    try:
        for step, snapshot in enumerate(film):
            picture = studio.picture(snapshot)
            picture.save(path.with_name(f"{path.stem}-step{step}.png"))
            if step == len(film) - 1:
                picture.save(path)
    finally:
        studio.close()


def draw_marked(
    bodies: Mapping[str, Body],
    colors: Mapping[str, str],
    snapshot: Snapshot,
    path: Path,
    marked: Sequence[str],
) -> None:
    """Write a snapshot to `path`, with a ring and its name around each body that is marked."""
    studio = Studio(bodies, colors)
    try:
        picture = studio.picture(snapshot)
    finally:
        studio.close()
    for name, frame in snapshot.frames:
        if name in marked:
            _ring(picture, name, bodies[name].shape.corners(), frame)
    picture.save(path)


def _ring(picture: "Image", name: str, corners: FloatArray, frame: Frame) -> None:
    """An ellipse around corners (n, 3) of a body in its frame, and a name above it."""
    from PIL import ImageDraw

    pose = numbers(frame)
    turn = rotation(pose["roll"], pose["pitch"], pose["yaw"])
    x, y = _seen(corners @ turn.T + frame.position).T
    box = (x.min() - RIM, y.min() - RIM, x.max() + RIM, y.max() + RIM)
    pen = ImageDraw.Draw(picture)
    pen.ellipse(box, outline=RED, width=3)
    pen.text(((box[0] + box[2]) / 2, box[1] - 2), name, RED, anchor="mb", stroke_width=1, stroke_fill="white")


def _seen(points: FloatArray) -> FloatArray:
    """Where points (n, 3) in the world, m, are in a picture, pixels (n, 2)."""
    eye, ahead = np.array(EYE), np.subtract(AIM, EYE)
    ahead = ahead / np.linalg.norm(ahead)
    right = np.cross(ahead, [0, 0, 1])
    right = right / np.linalg.norm(right)
    away = points - eye
    scale = SIZE[1] / 2 / np.tan(np.radians(VIEW_ANGLE) / 2) / (away @ ahead)
    seen: FloatArray = np.stack(
        [SIZE[0] / 2 + scale * (away @ right), SIZE[1] / 2 - scale * (away @ np.cross(right, ahead))], axis=1
    )
    return seen


class Studio:
    """The table, the robot and named bodies as they look, and a camera; colours are names.

    Close it after use.
    """

    def __init__(self, bodies: Mapping[str, Body], colors: Mapping[str, str]) -> None:
        self._client = client = Client()
        with tempfile.TemporaryDirectory() as folder:
            self._table()
            self._robot = Robot(client, ReferenceSettings(), Path(folder), visuals=True)
            self._bodies = {
                name: create(body.shape, client, Path(folder), color_of(colors[name]))
                for name, body in bodies.items()
            }
        for link in self._robot.links:
            color = ARM_COLORS.get(self._robot.part(link), STEEL)
            client.changeVisualShape(self._robot.id, link, rgbaColor=color)

    def _table(self) -> None:
        """The top, a little beyond its bounds, and large enough for the robot to stand on."""
        client, thickness = self._client, 0.04
        (x0, x1), (y0, _) = TABLE_BOUNDS
        half = [(x1 - x0) / 2 + 0.05, (0.12 - y0 + 0.05) / 2, thickness / 2]
        shape = client.createVisualShape(client.GEOM_BOX, halfExtents=half, rgbaColor=WOOD)
        client.createMultiBody(0, -1, shape, [(x0 + x1) / 2, 0.12 - half[1], -thickness / 2])

    def picture(self, snapshot: Snapshot) -> "Image":
        """How a snapshot looks."""
        self._robot.put_arm(np.array(snapshot.q))
        self._robot.put_fingers(snapshot.angle)
        if snapshot.linkage:
            self._robot.put_linkage(snapshot.linkage)
        for name, frame in snapshot.frames:
            self._client.resetBasePositionAndOrientation(self._bodies[name], *frame)
        return self._shot()

    def _shot(self) -> "Image":
        from PIL import Image

        client, (width, height) = self._client, (SIZE[0] * SAMPLES, SIZE[1] * SAMPLES)
        _, _, pixels, _, bodies = client.getCameraImage(
            width,
            height,
            client.computeViewMatrix(EYE, AIM, [0, 0, 1]),
            client.computeProjectionMatrixFOV(VIEW_ANGLE, width / height, 0.1, 5.0),
            renderer=client.ER_TINY_RENDERER,
            lightDirection=LIGHT,
            lightDistance=LIGHT_DISTANCE,
            lightAmbientCoeff=0.6,
            lightDiffuseCoeff=0.5,
            lightSpecularCoeff=0.05,
            shadow=1,
        )
        drawn = np.reshape(pixels, (height, width, 4))[..., :3].astype(np.uint8)
        empty = np.reshape(bodies, (height, width, 1)) < 0
        return Image.fromarray(np.where(empty, _background(height), drawn)).resize(SIZE, Image.Resampling.BOX)

    def close(self) -> None:
        """Release the client."""
        self._client.close()


def _background(height: int) -> Any:
    """A column of pixels, (height, 1, 3)."""
    return np.linspace(SKY, GROUND, height).astype(np.uint8)[:, None]
