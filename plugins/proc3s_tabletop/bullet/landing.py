"""A body that is let go a little above a table, until it has come to rest."""

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.bullet.client import Client
from proc3s_tabletop.bullet.collision_shapes import compound
from proc3s_tabletop.objects.shapes import MARGIN

DROP = 0.001
"""It is let go this far above the table, m."""
TICKS = 1200
"""Of 1/240 s, within which it comes to rest."""


def landed(pieces: Sequence[FloatArray], turn: FloatArray) -> FloatArray:
    """Which direction of the body is down when it has come to rest that was let go with a turn."""
    client = Client()
    turned = [piece @ turn.T for piece in pieces]
    try:
        slab = client.createCollisionShape(client.GEOM_BOX, halfExtents=[2.0, 2.0, 0.05])
        table = client.createMultiBody(0, slab, -1, [0, 0, -0.05])
        with TemporaryDirectory() as folder:
            shape = compound(turned, client, Path(folder))
        height = MARGIN + DROP - min(float(piece[:, 2].min()) for piece in turned)
        body = client.createMultiBody(0.2, shape, -1, [0, 0, height])
        client.changeDynamics(table, -1, lateralFriction=0.8)
        client.changeDynamics(body, -1, lateralFriction=0.8, rollingFriction=1e-4, angularDamping=0.3)
        client.setGravity(0, 0, -9.8)
        for _ in range(TICKS):
            client.stepSimulation()
        _, quaternion = client.getBasePositionAndOrientation(body)
        after = np.reshape(client.getMatrixFromQuaternion(quaternion), (3, 3)) @ turn
        return np.asarray(after.T @ [0.0, 0.0, -1.0])
    finally:
        client.close()
