"""One action under way: the scene it happens in, and what has been measured so far."""

import dataclasses
from typing import Any, NoReturn

from proc3s import FloatArray
from proc3s_tabletop.engine.protocol import Simulation
from proc3s_tabletop.robot.settings import ReferenceSettings
from proc3s_tabletop.telemetry import Attempted, Clearance, Stage, Telemetry, least


class Stopped(Exception):
    """The action ends early; its telemetry says where and why."""


class Attempt:
    """Carries the telemetry of an action from stage to stage; `grasp` (4, 4) is where it is commanded to."""

    def __init__(self, scene: Simulation, attempted: Attempted, grasp: FloatArray) -> None:
        self.scene = scene
        self.settings: ReferenceSettings = scene.settings
        held = scene.held.name if scene.held else None
        x, y, z = grasp[:3, 3].tolist()
        self.telemetry = Telemetry(attempted, (x, y, z), held=held)
        self.before = scene.frames()

    def note(self, **measured: Any) -> None:
        """Add to the telemetry, by its field names."""
        self.telemetry = dataclasses.replace(self.telemetry, **measured)

    def note_clearance(self, clearance: Clearance | None) -> None:
        """Keep the smallest clearance."""
        self.note(clearance=least([self.telemetry.clearance, clearance]))

    def note_hand(self, gripped: str | None = None) -> None:
        """Keep the smallest clearance of the robot to what is beside it; what is above or below is tested
        for contact, and no error on the level uses its distance up."""
        found = self.scene.hand_clearances(gripped, self.settings.supporting)
        self.note_clearance(least([*found.values()]))

    def stop(self, stage: Stage, contact: Clearance | None = None) -> NoReturn:
        """End the action at a stage, in contact with something or not."""
        self.note(ended=stage)
        if contact:
            self.note(clearance=contact)
        raise Stopped(stage)
