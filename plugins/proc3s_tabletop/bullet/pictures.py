"""Pictures of snapshots, drawn without a display in a client of their own: no simulation ever notices."""

import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from proc3s_tabletop.bullet.arm import Robot
from proc3s_tabletop.bullet.client import Client
from proc3s_tabletop.bullet.visuals import create
from proc3s_tabletop.engine import looks
from proc3s_tabletop.engine.snapshot import Snapshot
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.settings import TABLE_BOUNDS, ReferenceSettings

if TYPE_CHECKING:
    from PIL.Image import Image

SAMPLES = 2
"""Pixels are drawn this many times finer each way, and averaged: smooth edges."""

STEEL, JOINT, DARK = (0.75, 0.77, 0.80, 1.0), (0.36, 0.55, 0.72, 1.0), (0.2, 0.21, 0.23, 1.0)
ARM_COLORS = {"base": DARK, "gripper": DARK, "shoulder": JOINT, "wrist": JOINT}
"""By the names that people give the parts; the others are of steel."""


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
                name: create(body.shape, client, Path(folder), looks.color_of(colors[name]))
                for name, body in bodies.items()
            }
        for link in self._robot.links:
            color = ARM_COLORS.get(self._robot.part(link), STEEL)
            client.changeVisualShape(self._robot.id, link, rgbaColor=color)

    def _table(self) -> None:
        """The top, a little beyond its bounds, and large enough for the robot to stand on."""
        client, thickness = self._client, looks.THICKNESS
        (x0, x1), (y0, _) = TABLE_BOUNDS
        half = [(x1 - x0) / 2 + 0.05, (0.12 - y0 + 0.05) / 2, thickness / 2]
        shape = client.createVisualShape(client.GEOM_BOX, halfExtents=half, rgbaColor=looks.WOOD)
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

        client, (width, height) = self._client, (looks.SIZE[0] * SAMPLES, looks.SIZE[1] * SAMPLES)
        _, _, pixels, _, bodies = client.getCameraImage(
            width,
            height,
            client.computeViewMatrix(looks.EYE, looks.AIM, [0, 0, 1]),
            client.computeProjectionMatrixFOV(looks.VIEW_ANGLE, width / height, 0.1, 5.0),
            renderer=client.ER_TINY_RENDERER,
            lightDirection=looks.LIGHT,
            lightDistance=looks.LIGHT_DISTANCE,
            lightAmbientCoeff=looks.AMBIENT,
            lightDiffuseCoeff=looks.DIFFUSE,
            lightSpecularCoeff=0.05,
            shadow=1,
        )
        drawn = np.reshape(pixels, (height, width, 4))[..., :3].astype(np.uint8)
        empty = np.reshape(bodies, (height, width, 1)) < 0
        pixels = np.where(empty, looks.background(height), drawn)
        return Image.fromarray(pixels).resize(looks.SIZE, Image.Resampling.BOX)

    def close(self) -> None:
        """Release the client."""
        self._client.close()
