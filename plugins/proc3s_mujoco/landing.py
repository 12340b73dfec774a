"""A body that is let go a little above a table, until it has come to rest."""

import hashlib
from collections.abc import Sequence

import mujoco
import numpy as np

from proc3s import FloatArray
from proc3s_mujoco import shapes, specs
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.objects.shapes import MARGIN, Mesh, Surface
from proc3s_tabletop.robot.settings import ReferenceSettings

DROP = 0.001
"""It is let go this far above the table, m."""
SECONDS = 5.0
"""Within which it comes to rest."""
NAME = "body"


def landed(pieces: Sequence[FloatArray], turn: FloatArray) -> FloatArray:
    """Which direction of the body is down when it has come to rest that was let go with a turn."""
    settings = ReferenceSettings()
    spec = specs.empty(settings)
    specs.add_things(spec, {NAME: _body([piece @ turn.T for piece in pieces])}, settings)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qpos[2] = MARGIN + DROP - min(float((piece @ turn.T)[:, 2].min()) for piece in pieces)
    mujoco.mj_step(model, data, nstep=round(SECONDS / model.opt.timestep))
    mujoco.mj_kinematics(model, data)
    after = data.body(shapes.THING + NAME).xmat.reshape(3, 3) @ turn
    return np.asarray(after.T @ [0.0, 0.0, -1.0])


def _body(pieces: Sequence[FloatArray]) -> Body:
    nothing = Surface(np.zeros((0, 3)), np.zeros((0, 3), int))
    key = hashlib.sha256(np.vstack(pieces).tobytes()).hexdigest()
    shape = Mesh(key, tuple(pieces), np.vstack(pieces), nothing, 0.0)
    return Body(shape, mass=0.2, friction=0.8, rolling_friction=1e-4)
