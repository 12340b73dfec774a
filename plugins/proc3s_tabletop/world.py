"""Table-tops as proc3s knows worlds; their skills are importable from here, too."""

import dataclasses
from abc import abstractmethod
from collections.abc import Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from proc3s import Action, Plan, SpecError, State, Transition, World
from proc3s.errors import Issue
from proc3s.specs.domain import ErrorsSpec
from proc3s.wording import count
from proc3s_tabletop.actions.disturbances import Disturbance
from proc3s_tabletop.actions.execution import Execution
from proc3s_tabletop.actions.misplacement import Misplacement
from proc3s_tabletop.actions.reference import Reference
from proc3s_tabletop.actions.table import Table
from proc3s_tabletop.catalogue.body_specs import bodies_of, body_of
from proc3s_tabletop.engine import choice, looks
from proc3s_tabletop.engine.options import TabletopOptions
from proc3s_tabletop.engine.protocol import Studio
from proc3s_tabletop.engine.snapshot import Snapshot
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.objects.shapes import Mesh
from proc3s_tabletop.robot import frames as poses
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.screens.registered import SCREENS
from proc3s_tabletop.skills import pick as pick
from proc3s_tabletop.skills import pick_object as pick_object
from proc3s_tabletop.skills import place as place
from proc3s_tabletop.skills import place_object as place_object
from proc3s_tabletop.telemetry import Telemetry

if TYPE_CHECKING:
    from proc3s import Domain


COARSE = 0.003
"""Pieces that are further from their mesh than this, m, are too coarse for some plans."""
FINER = (
    "give it a smaller `concavity` (0.01, then 0.006: more pieces, which are slower), "
    "declare a box, a cylinder or a bowl instead, or leave as much room around it"
)


class TabletopWorld(World[Telemetry]):
    """Picks and places among the `objects` of a state: name -> something with `category` and `pose`.

    `bodies` says which body a category has (see `body_specs`); block and bowl where it is not given. `speed`
    scales that of arm and fingers. Disturbed, it makes the `errors` of the domain, but for `placement_error`
    (m) where that is given. `engine` names the physics engine. It starts with the first state, and again when
    a state has other objects.
    """

    options = TabletopOptions
    measures = Telemetry

    def __init__(
        self,
        domain: "Domain",
        bodies: Mapping[str, Any] | None = None,
        speed: float = 1.0,
        placement_error: float | None = None,
        engine: str | None = None,
    ) -> None:
        super().__init__(domain)
        self.engine = engine
        self.speed = speed
        self._errors = {} if placement_error is None else {"placed": placement_error}
        self.categories = bodies_of(bodies)
        self._bodies: dict[str, Body] = {}
        self._table: Table | None = None
        self._film: list[Snapshot] = []
        self._disturbance: Disturbance | None = None
        self._misplacement: Misplacement | None = None

    @property
    def errors(self) -> ErrorsSpec:
        """What is to be expected: the errors of the domain, but for what this world was given."""
        return self.domain.spec.errors.model_copy(update=self._errors)

    def disturb(self, rng: np.random.Generator | None, corner: int | None = None) -> None:
        """From the next reset on, arm and fingers are a little faster or slower, objects stand a little off
        from where they are believed to be, and so they come down."""
        self._disturbance = Disturbance(rng, corner, self.errors) if rng else None
        self._set_speed()

    def misplace(self, rng: np.random.Generator | None, error: float = 0.0) -> None:
        """From the next reset on objects stand, and are set down, up to `error` metres off, turned by up to
        half a degree a millimetre; picks reach for where plan or arm believe them to be."""
        self._misplacement = Misplacement(rng, error) if rng and error else None

    def _set_speed(self) -> None:
        # At once, too: without disturbance the next plan may go on from a snapshot, without a reset.
        if self._table is not None:
            self._table.set_speed(self._disturbance.speed if self._disturbance else self.speed)

    def placed(self, x: float, y: float, z: float) -> tuple[float, float, float, float]:
        """Where something is placed that is to be placed at a point, and its turn about z, rad."""
        made = [self._disturbance.placed()] if self._disturbance else []
        made += [self._misplacement.draw()] if self._misplacement else []
        dx, dy, turn = (sum(numbers) for numbers in zip((0.0, 0.0, 0.0), *made, strict=True))
        return x + dx, y + dy, z, turn

    def step(self, action: Action) -> Transition[Telemetry]:
        """Carry out one ground action, which may be one pick, or one place, at most.

        Raises SpecError for a skill that does more, or keeps to itself what it did: nobody could judge it.
        """
        before = self.table.attempts
        transition = super().step(action)
        attempts = self.table.attempts - before
        if attempts > 1:
            message = f"picks and places {attempts} times in one action: make it {attempts} skills"
            raise SpecError([Issue(f"skill {action.skill}", "target", message)])
        if attempts and transition.telemetry.attempted is None:
            message = "returned other telemetry than that of the pick or place that it carried out"
            raise SpecError([Issue(f"skill {action.skill}", "target", message)])
        return transition

    @abstractmethod
    def make_table(self, bodies: Mapping[str, Body], frames: Mapping[str, Frame]) -> Table:
        """A simulated table with these bodies on it."""

    @property
    def table(self) -> Table:
        """The simulated table; there is one once a state has been placed."""
        if self._table is None:
            raise RuntimeError("reset the world to a state first")
        return self._table

    def flaws(self, state: State) -> list[str]:
        """Objects beside the table, in it, or in one another."""
        from proc3s_tabletop.actions.beginning import flaws_of

        objects: Mapping[str, Any] = state.objects  # type: ignore[attr-defined]
        return flaws_of(objects, *self._placed(objects), self.engine)

    def _placed(self, objects: Mapping[str, Any]) -> tuple[dict[str, Body], dict[str, Frame]]:
        """The bodies of objects, and where they are."""
        bodies = {name: body_of(self.categories, name, thing.category) for name, thing in objects.items()}
        return bodies, {name: poses.frame(thing.pose) for name, thing in objects.items()}

    def place(self, state: State) -> None:
        """Put a body where every object is, the hand empty and above. Raises SpecError on a strange one."""
        super().place(state)
        bodies, frames = self._placed(self.state.objects)
        if self._table is None or bodies != self._bodies:
            self.close()
            self._table, self._bodies = self.make_table(bodies, frames), bodies
        if off := self._misplacement or self._disturbance:
            self._table.put(off.stands(frames), believed=frames)
        else:
            self._table.put(frames)
        self._set_speed()
        self._film = []

    def observe(self) -> State:
        """The state of the last reset, with every object that moved where it is now."""
        objects = dict(self.state.objects)
        start = {name: poses.frame(thing.pose) for name, thing in objects.items()}
        for name, frame in self.table.snapshot.frames:
            if frame != start[name]:
                thing = objects[name]
                pose = dataclasses.replace(thing.pose, **poses.numbers(frame))
                objects[name] = dataclasses.replace(thing, pose=pose)
        state: State = dataclasses.replace(self.state, objects=objects)
        return state

    def save(self) -> Snapshot:
        """Everything that later steps depend on, as plain data; kept for the pictures, too."""
        self._film.append(self.table.snapshot)
        return self.table.snapshot

    def load(self, snapshot: Snapshot) -> None:
        """Go on from a snapshot; every action begins by putting the simulator into it."""
        if not self._film or self._film[-1] is not snapshot:
            self._film = [snapshot]
        self.table.snapshot = snapshot

    def render(self, plan: Plan, path: Path) -> None:
        """Draw the world after a plan."""
        self.render_marked(plan, path, ())

    def film(self) -> list[dict[str, Any]]:
        """What pictures show of every snapshot."""
        return [snapshot.filmed() for snapshot in self._film]

    def render_film(self, initial: State, frames: Mapping[Path, Any]) -> None:
        """Draw frames of a film: only what draws of the engine is started."""
        objects: Mapping[str, Any] = initial.objects  # type: ignore[attr-defined]
        with closing(self._studio(objects)) as studio:
            for path, frame in frames.items():
                studio.picture(Snapshot.of_film(frame)).save(path)

    def render_marked(self, plan: Plan, path: Path, marked: Sequence[str]) -> None:
        """Draw the world after a plan, with a ring and the name around objects that are marked."""
        with closing(self._studio(self.state.objects)) as studio:
            looks.draw_marked(studio, self._bodies, self.table.snapshot, path, marked)

    def _studio(self, objects: Mapping[str, Any]) -> Studio:
        colors = {name: getattr(thing, "color", "") for name, thing in objects.items()}
        return choice.engine(self.engine).studio(self._placed(objects)[0], colors)

    def facts(self) -> list[str]:
        """How far convex pieces are from their mesh: the 95th percentile of the surfaces' distance."""
        return [
            f"{name}: {_pieces(mesh)}, {1e3 * mesh.error:.1f} mm off the mesh"
            for name, mesh in self._meshes().items()
        ]

    def coarse(self) -> dict[str, str]:
        """Bodies whose pieces are more than 3 mm off their mesh, and what makes them finer."""
        return {
            f"{name} is {1e3 * mesh.error:.1f} mm off its {_pieces(mesh)}": FINER
            for name, mesh in self._meshes().items()
            if mesh.error > COARSE
        }

    def _meshes(self) -> dict[str, Mesh]:
        """The meshes by category."""
        return {name: body.shape for name, body in self.categories.items() if isinstance(body.shape, Mesh)}

    def close(self) -> None:
        """Release the simulator."""
        if self._table:
            self._table.close()
            self._table = None


def _pieces(mesh: Mesh) -> str:
    return count(len(mesh.pieces), "convex piece")


class ExecutionWorld(TabletopWorld):
    """The world in which accepted plans are carried out."""

    def make_table(self, bodies: Mapping[str, Body], frames: Mapping[str, Frame]) -> Table:
        """A table whose arm is driven."""
        return Execution(bodies, frames, engine=self.engine)


class ReferenceWorld(TabletopWorld):
    """The world that accepts plans."""

    screens = SCREENS

    def make_table(self, bodies: Mapping[str, Body], frames: Mapping[str, Frame]) -> Table:
        """A table whose arm is kinematic."""
        return Reference(bodies, frames, engine=self.engine)
