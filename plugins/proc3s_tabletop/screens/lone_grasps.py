"""Measurements of grasps on a body that stands alone: they depend on body, rest pose and grasp only."""

import dataclasses
import functools
import hashlib

import numpy as np

from proc3s import FloatArray, Pose
from proc3s.domain.transforms import matrices, numbers
from proc3s_tabletop.engine import choice
from proc3s_tabletop.engine.protocol import GripSimulation, HandSimulation
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot import frames as poses
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.robot.grasp_frames import tool_poses
from proc3s_tabletop.robot.widths import Bools, too_wide
from proc3s_tabletop.screens.grasp_cache import Grasp, GraspCache, GraspVerdict
from proc3s_tabletop.tasks.grasp_sampler import pool

FORMAT = 1
"""Cache format version; bump it to invalidate old entries."""
DIGITS = 6
"""Grasps are rounded to this, in m and rad, so that equal ones share a cache entry."""
LENIENCE = 1.005
"""An object that slips by so much more than the world allows slips there, too: a lift test repeats itself to
a few micrometres, wherever on the table it is done (measured)."""
MOST = 100_000
"""Grasps of one body that are kept in memory."""

BODY = "body"


@functools.cache
def lone_grasps(body: Body, roll: float, pitch: float, engine: str | None = None) -> "LoneGrasps":
    """What is known of grasping a body that leans by roll and pitch (rad); one in a process."""
    return LoneGrasps(body, roll, pitch, engine)


@functools.cache
def recurring() -> frozenset[Grasp]:
    """The grasps that are drawn again and again, and so worth being kept."""
    return frozenset(map(rounded, pool()))


def rounded(grasp: FloatArray) -> Grasp:
    """The cache key of a grasp (6,)."""
    return tuple(np.round(grasp, DIGITS).tolist())


class LoneGrasps:
    """Measures grasps (6,) of one body, each once; those that recur, once for all runs."""

    def __init__(self, body: Body, roll: float, pitch: float, engine: str | None = None) -> None:
        self._body, self._there = body, _at_rest(body, roll, pitch)
        self._engine = choice.engine(engine)
        measured = self._engine.settings()
        self._settings = settings = dataclasses.replace(
            measured,
            max_slip=measured.max_slip * LENIENCE,
            max_slip_angle=measured.max_slip_angle * LENIENCE,
        )
        said = f"{FORMAT} {engine or choice.default()} {body!r} {roll!r} {pitch!r} {settings!r}"
        self._kept = GraspCache(hashlib.sha256(said.encode()).hexdigest())
        self._known = self._kept.read()

    def fits(self, grasps: FloatArray) -> FloatArray:
        """How the open hand fits around the body: shape (n, 6) to (n, 2), depth and cover of a Verdict."""
        keys = [rounded(grasp) for grasp in grasps]
        self._learn({key: self._look(key) for key in dict.fromkeys(keys) if key not in self._known})
        return np.array([self._known[key][:2] for key in keys], float).reshape(-1, 2)

    def holds(self, grasps: FloatArray) -> FloatArray:
        """Whether the closed hand keeps the body through the lift test: shape (n, 6) to (n,), 0 or 1.

        Only of grasps that recur; a lift test of any other costs as much as leaving it to the world, so 1.
        """
        keys = [rounded(grasp) for grasp in grasps]
        new = [k for k in dict.fromkeys(keys) if k in recurring() and self._verdict(k).holds is None]
        self._learn({key: self._verdict(key)._replace(holds=self._lift(key)) for key in new})
        return np.array([self._verdict(key).holds is not False for key in keys], float)

    def too_wide(self, grasps: FloatArray) -> Bools:
        """Whether the body is too wide for the hand there: shape (n, 6) to (n,)."""
        return too_wide(self._body.shape, matrices(grasps))

    def _verdict(self, key: Grasp) -> GraspVerdict:
        return self._known.get(key, GraspVerdict(0.0, 1.0))

    def _learn(self, found: dict[Grasp, GraspVerdict]) -> None:
        if len(self._known) + len(found) > MOST:
            self._known = self._kept.read()
        self._known.update(found)
        if kept := {key: verdict for key, verdict in found.items() if key in recurring()}:
            self._kept.add(kept)

    @functools.cached_property
    def _scene(self) -> HandSimulation:
        """The body at rest at the origin of a world of its own, and an open hand."""
        scene = self._engine.hand_scene({BODY: self._body}, self._settings)
        scene.hand.put_fingers(0.0)
        scene.put(BODY, _frame(self._there))
        return scene

    @functools.cached_property
    def _grips(self) -> GripSimulation:
        """Where the body is grasped as in the worlds."""
        return self._engine.grips({BODY: self._body}, self._settings)

    def _look(self, grasp: Grasp) -> GraspVerdict:
        scene = self._scene
        scene.hand.put(*self._tool(grasp))
        return GraspVerdict(scene.hand_depth(BODY), scene.cover()[BODY])

    def _lift(self, grasp: Grasp) -> bool:
        lies = ((self._body, _frame(self._there)),)
        return not self._grips.grip(self._tool(grasp), lies, self._settings.speed).telemetry.ended

    def _tool(self, grasp: Grasp) -> Frame:
        """Where tool0 is for a grasp."""
        return _frame(tool_poses((self._there @ matrices(np.array(grasp)))[None])[0])


def _at_rest(body: Body, roll: float, pitch: float) -> FloatArray:
    """The transform (4, 4) of a body that leans, at x = y = 0 with its lowest point on the table."""
    pose = matrices(np.array([0.0, 0.0, 0.0, roll, pitch, 0.0]))
    pose[2, 3] = -float((body.shape.corners() @ pose[:3, :3].T)[:, 2].min())
    return pose


def _frame(matrix: FloatArray) -> Frame:
    """A transform (4, 4) as the simulator has it."""
    return poses.frame(Pose(*numbers(matrix).tolist()))
