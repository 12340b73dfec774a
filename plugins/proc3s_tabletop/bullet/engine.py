"""PyBullet as an engine of table-tops."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from proc3s import FloatArray
from proc3s_tabletop.bullet import landing
from proc3s_tabletop.bullet.client import import_pybullet
from proc3s_tabletop.bullet.hand_scene import HandScene
from proc3s_tabletop.bullet.scene import Scene
from proc3s_tabletop.engine.grips import GripSimulator
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.robot.hand_profile import AIRO, HandProfile
from proc3s_tabletop.robot.settings import ReferenceSettings

if TYPE_CHECKING:
    from proc3s_tabletop.bullet.pictures import Studio


class BulletEngine:
    """Makes simulations in PyBullet, each with a client of its own."""

    def require(self) -> None:
        """Raise UsageError where a package is missing that the engine needs."""
        import_pybullet()

    def settings(self) -> ReferenceSettings:
        """The constants of a reference world in this engine."""
        return ReferenceSettings()

    def profile(self) -> HandProfile:
        """What of the hand meets things on its way straight down."""
        return AIRO

    def scene(self, bodies: Mapping[str, Body], settings: ReferenceSettings) -> Scene:
        """A table with the robot and these bodies."""
        return Scene(bodies, settings)

    def hand_scene(self, bodies: Mapping[str, Body], settings: ReferenceSettings) -> HandScene:
        """A table with a floating hand and these bodies."""
        return HandScene(bodies, settings)

    def grips(self, bodies: Mapping[str, Body], settings: ReferenceSettings) -> GripSimulator:
        """Grips and falls among these bodies."""
        return GripSimulator(bodies, settings, HandScene)

    def landed(self, pieces: Sequence[FloatArray], turn: FloatArray) -> FloatArray:
        """Which direction (3,) of a body is down when it has come to rest that was let go with a turn."""
        return landing.landed(pieces, turn)

    def studio(self, bodies: Mapping[str, Body], colors: Mapping[str, str]) -> "Studio":
        """A table with the robot and these bodies to be drawn; colours are names."""
        from proc3s_tabletop.bullet.pictures import Studio

        return Studio(bodies, colors)
