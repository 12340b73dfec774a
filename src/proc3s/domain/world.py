"""Worlds: the transition models that accept or refuse plans."""

from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Generic, TypeVar

import numpy as np

from proc3s.domain.domain import Domain
from proc3s.domain.state import State
from proc3s.domain.values import Action, Plan
from proc3s.domain.world_options import WorldOptions
from proc3s.errors import UsageError, blame, not_wanted
from proc3s.specs.base import Target
from proc3s.specs.domain import ScreenSpec

T = TypeVar("T")


@dataclass(frozen=True)
class Transition(Generic[T]):
    """One step of a world: the state before, the action, the state after, and what the world measured.

    `telemetry` is the world's own frozen class; constraints read what they need from it.
    """

    before: State
    action: Action
    after: State
    telemetry: T


@dataclass(frozen=True)
class Score:
    """A judge's verdict on the final state, with the reason in words.

    `margin` says how far the goal is from being missed, or, negative, from being reached, in the unit of the
    positions of the domain; None where a judge knows yes and no only.
    """

    reached: bool
    reason: str
    margin: float | None = None


class World(Generic[T]):
    """A world of one domain whose skills change `state`; a simulator overrides what it keeps elsewhere.

    `step` is generic around the target of the skill. A snapshot is whatever `save` returns; `load` restores
    it exactly, so that a step from a loaded snapshot equals the same step in a replayed plan bit for bit.
    """

    most_prefixes: ClassVar[int] = 256
    """How many snapshots the prefix cache keeps; 0 where a step is cheaper than a look-up."""

    screens: ClassVar[tuple[ScreenSpec, ...]] = ()
    """Cheap tests that come with this world, for every domain in which it accepts plans."""

    options: ClassVar[type[WorldOptions]] = WorldOptions
    """The model of what `-W key=value` may say of this world, and of the execution world of its domain."""

    measures: ClassVar[type[Any]] = object
    """What skills must return; by default they may return anything."""

    def __init__(self, domain: Domain) -> None:
        self.domain = domain
        self.state: Any = None
        self._snapshot: Any = None

    def reset(self, state: State) -> None:
        """Put the world into a state."""
        self.place(state)
        self._snapshot = self.save()

    @property
    def snapshot(self) -> Any:
        """The snapshot that the next step starts from."""
        return self._snapshot

    def resume(self, snapshot: Any) -> None:
        """Go on from a snapshot that an earlier step left."""
        self._snapshot = snapshot

    def step(self, action: Action) -> Transition[T]:
        """Carry out one ground action from the snapshot of the step before."""
        self.load(self._snapshot)
        before = self.observe()
        with blame(f"skill {action.skill}"):
            telemetry: Any = self.domain.skill(action.skill)(self, *action.args)
        if not isinstance(telemetry, self.measures):
            raise not_wanted(f"skill {action.skill}", telemetry, f"a {self.measures.__name__}")
        self._snapshot = self.save()
        return Transition(before, action, self.observe(), telemetry)

    def disturb(self, rng: np.random.Generator | None, corner: int | None = None) -> None:
        """Carry actions out with small errors from the next reset on, as the real thing would; None: without.

        All errors are drawn from the generator. In a `corner` they are as large as they get, and those of an
        even corner are opposite to the next one's. Raises UsageError in a world that knows no errors.
        """
        if rng is not None:
            raise UsageError(f"the world of {self.domain.spec.name} has no disturbances to rehearse with")

    def misplace(self, rng: np.random.Generator | None, error: float = 0.0) -> None:
        """From the next reset on everything stands, and is put down, up to `error` metres off; None: exactly.

        Errors are uniform in a disc, new for each object and each time that one is put down, and come with a
        turn of up to half a degree a millimetre. All are drawn from the generator; `error` scales the draws.
        Raises UsageError in a world in which nothing is misplaced.
        """
        if rng is not None:
            raise UsageError(f"--error: nothing is misplaced in the world of {self.domain.spec.name}")

    def flaws(self, state: State) -> Sequence[str]:
        """Why no plan can begin from a state, a sentence for each reason; asked before any draw."""
        return ()

    def place(self, state: State) -> None:
        """Build everything that the state describes."""
        self.state = state

    def observe(self) -> State:
        """The state the world is in."""
        state: State = self.state
        return state

    def save(self) -> Any:
        """A snapshot of everything that later steps depend on."""
        return self.state

    def load(self, snapshot: Any) -> None:
        """Restore a snapshot exactly."""
        self.state = snapshot

    def render(self, plan: Plan, path: Path) -> None:
        """Draw the world after a plan as a PNG file; a world without a picture writes none."""

    def film(self) -> Sequence[Any]:
        """What `render_film` draws of the plan that was carried out, as data that JSON has.

        A frame for the world before the first step and one after each, or only one after the last. Empty in a
        world that draws by `render` alone.
        """
        return ()

    def render_film(self, initial: State, frames: Mapping[Path, Any]) -> None:
        """Draw frames of a film, each as a PNG file as `render` would have; nothing is reset or simulated.

        `initial` is the state that the plan began from.
        """

    def render_marked(self, plan: Plan, path: Path, marked: Sequence[str]) -> None:
        """Draw only the world after a plan, with these objects of the state marked; by default none is."""
        self.render(plan, path)

    def facts(self) -> Sequence[str]:
        """Measured accuracy of its models, one line each: `proc3s check` prints them."""
        return ()

    def coarse(self) -> Mapping[str, str]:
        """Models less exact than plans may need, a sentence each, and what to do; `proc3s check` notes it."""
        return {}

    def close(self) -> None:
        """Release simulators and files that the world holds."""


def make_world(domain: Domain, target: Target | None = None) -> World[Any]:
    """A fresh world of a domain; `target` names another one than the reference world."""
    target = target or domain.spec.world
    make = target.load()
    with blame(f"world {target.target}"):
        world: World[Any] = make(domain, **target.args)
    return world


def draws(world: World[Any]) -> bool:
    """Whether a world draws pictures."""
    return type(world).render is not World.render or type(world).render_marked is not World.render_marked


def flaws_of(domain: Domain, state: State) -> Sequence[str]:
    """Why no plan can begin from a state, as the world sees it, a sentence each."""
    with closing(make_world(domain)) as world, blame(f"world {domain.spec.world.target}"):
        return list(world.flaws(state))
