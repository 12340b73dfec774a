"""The execution world: carries accepted plans out by motors and friction, and refuses nothing."""

import dataclasses
from collections.abc import Callable, Mapping

import numpy as np

from proc3s import FloatArray
from proc3s_tabletop.actions.attempt import Attempt, Stopped
from proc3s_tabletop.actions.motion import line_down
from proc3s_tabletop.actions.motors import FLAT, ROUND, Motors
from proc3s_tabletop.actions.outcome import compare, note_bounds
from proc3s_tabletop.actions.table import Table
from proc3s_tabletop.objects.shapes import Bowl, Box
from proc3s_tabletop.robot.frames import Frame, Held
from proc3s_tabletop.telemetry import Attempted, Telemetry, displacement, least


class Execution(Table):
    """The arm is moved by its motors and the hand holds by friction, open loop.

    Nothing is refused but a target out of reach: what a plan breaks shows in where things end up.
    """

    def pick_at(self, grasp: FloatArray) -> Telemetry:
        """Open the hand, go down, close it, and lift."""
        return self._carry_out("pick", pick, grasp)

    def place_at(self, grasp: FloatArray) -> Telemetry:
        """Go down until the hand or its load meets something, open it, and leave."""
        return self._carry_out("place", place, grasp)

    def _iterations(self) -> int:
        """Of the solver, as many as what is there to be held needs."""
        flat = all(isinstance(body.shape, Box | Bowl) for body in self.scene.shapes.values())
        return FLAT if flat else ROUND

    def _carry_out(
        self, attempted: Attempted, action: Callable[[Attempt, FloatArray], None], grasp: FloatArray
    ) -> Telemetry:
        """Run an action from the snapshot and keep where it led to."""
        x, y = grasp[:2, 3].tolist()
        self.scene.load(self.snapshot)
        self.scene.set_iterations(self._iterations())
        attempt = Attempt(self.scene, attempted, grasp)
        self.attempts += 1
        try:
            action(attempt, grasp)
        except Stopped:
            note_bounds(attempt, self.snapshot, x, y)
            return attempt.telemetry
        linkage = tuple(round(angle, 9) for angle in self.scene.robot.linkage())
        believed = self.snapshot.believed
        self.snapshot = dataclasses.replace(self.scene.save(), linkage=linkage, believed=believed)
        note_bounds(attempt, self.snapshot, x, y)
        held = self.snapshot.held
        return dataclasses.replace(attempt.telemetry, held=held.name if held else None)


def pick(attempt: Attempt, grasp: FloatArray) -> None:
    """Grasp at a pose (4, 4) of the grasp point and lift."""
    scene, motors = attempt.scene, Motors(attempt.scene)
    line = line_down(attempt, grasp)
    before = attempt.before | _in_hand(attempt)
    scene.held = None
    motors.fingers(0.0)
    motors.to(line.q[0])
    motors.down(line)
    attempt.note_clearance(least([*scene.hand_clearances().values()]))
    motors.fingers(attempt.settings.finger_closed)
    name = scene.between_pads()
    gripped = _note_grip(attempt, name) if name else None
    motors.up(line)
    if gripped:
        _note_slip(attempt, gripped)
    lifted = scene.between_pads()
    scene.held = Held(lifted, scene.in_tool(lifted)) if lifted else None
    attempt.note(at_rest=scene.settle([*scene.loose()]))
    compare(attempt, before)


def place(attempt: Attempt, grasp: FloatArray) -> None:
    """Set down at a pose (4, 4) of the grasp point what is in the hand, and leave it."""
    scene, settings, motors = attempt.scene, attempt.settings, Motors(attempt.scene)
    line = line_down(attempt, grasp, settings.press)
    held = scene.held
    name = held.name if held else None
    motors.to(line.q[0])
    guard = scene.guard(name)
    motors.down(line, guard)
    if not guard.support and motors.height() < grasp[2, 3]:
        motors.to(line.q[-2])
    if held:
        attempt.note(target=name, finger_gap=scene.robot.gap())
        _note_slip(attempt, held)
    baseline = attempt.before | _in_hand(attempt)
    scene.held = None
    height = motors.height() - float(grasp[2, 3])
    motors.fingers(scene.robot.angle_for(scene.robot.gap() + 2 * settings.open_margin))
    attempt.note_clearance(least([*scene.hand_clearances(name).values()]))
    motors.up(line)
    motors.fingers(0.0)
    attempt.note(at_rest=scene.settle([*scene.loose()]))
    drop = _fall(attempt, baseline, name) if name and not guard.support else 0.0
    if name:
        attempt.note(support=guard.support or scene.support(name), support_height=height - drop)
    compare(attempt, baseline, name, drop)


def _in_hand(attempt: Attempt) -> dict[str, Frame]:
    """Where the held object is, if there is one."""
    held = attempt.scene.held
    return {held.name: attempt.scene.frame(held.name)} if held else {}


def _note_grip(attempt: Attempt, name: str) -> Held:
    """Note what is between the pads, and how it is held."""
    scene = attempt.scene
    attempt.note(target=name, finger_gap=scene.robot.gap(), grip_force=scene.grip_force(name))
    return Held(name, scene.in_tool(name))


def _note_slip(attempt: Attempt, gripped: Held) -> None:
    """Note how far an object has moved in the hand, or out of it."""
    moved = displacement(gripped.name, gripped.frame, attempt.scene.in_tool(gripped.name))
    attempt.note(slip=float(np.hypot(moved.level, moved.upright)), slip_angle=moved.turned)


def _fall(attempt: Attempt, baseline: Mapping[str, Frame], name: str) -> float:
    """How far an object that was let go over nothing has fallen, metres."""
    return baseline[name].position[2] - attempt.scene.frame(name).position[2]
