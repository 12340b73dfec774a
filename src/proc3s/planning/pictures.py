"""Pictures of a run: of what was carried out, and of what an unsolved run came nearest to."""

import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from proc3s.domain.margins import Violation
from proc3s.domain.state import State
from proc3s.domain.values import Action, Plan
from proc3s.domain.world import World, draws, make_world
from proc3s.errors import Proc3sError, blame
from proc3s.planning.attempts import Attempt, furthest
from proc3s.planning.film import draw_steps, keep_film
from proc3s.planning.parts import Pictures
from proc3s.reporting.caption import write_below
from proc3s.runs.events import Emit, Undrawn, Unwritten
from proc3s.runs.pictures import FILM, NEAREST_MISS, OUTCOME, SCENE, step_picture
from proc3s.search.problem import Problem
from proc3s.search.rollout import carry_out


@dataclass(frozen=True)
class Miss:
    """A plan up to and with the step that failed, and what that violates."""

    plan: Plan
    text: str

    @classmethod
    def of(cls, plan: Plan, violation: Violation) -> "Miss":
        """The miss of a whole plan whose first violation this is."""
        text = f"step {violation.step} ({violation.skill}): {violation.text}"
        return cls(plan[: violation.step + 1], text)


def nearest_miss(attempts: Sequence[Attempt]) -> Miss | None:
    """That of the attempt that came furthest; None where no plan was tried."""
    best = furthest(attempts)
    if best is None or best.nearest is None or not best.nearest["violations"]:
        return None
    plan = tuple(Action.from_json(action) for action in best.nearest["plan"])
    first = best.nearest["violations"][0]
    return Miss.of(plan, Violation(**{**first, "margin": first["margin"] or 0.0}))


@contextmanager
def told_if_missing(picture: Path, emit: Emit) -> Iterator[None]:
    """Without its picture a run is as good: what keeps it from being drawn is only told."""
    try:
        with blame("world"):
            yield
    except Proc3sError as error:
        cause, missing = error.__cause__, f"the picture {picture} is missing"
        if isinstance(cause, OSError) and cause.strerror:
            emit(Unwritten(text=f"{missing}: {cause.strerror}"))
        else:
            emit(Undrawn(text=f"{missing}: {error}"))


def draw_outcome(initial: State, plan: Plan, pictures: Pictures, emit: Emit, world: World[Any]) -> None:
    """Keep the film of a plan that a world has carried out, and draw what is wanted at once."""
    folder, film = pictures.folder, world.film()
    if film:
        with told_if_missing(folder / FILM, emit):
            keep_film(film, folder)
    if pictures.plan == "none":
        return
    with told_if_missing(folder / OUTCOME, emit):
        world.render(plan, folder / OUTCOME)
    if pictures.plan == "all":
        with told_if_missing(folder / step_picture(0), emit):
            draw_steps(world, initial, plan, film, folder)


def draw_unsolved(problem: Problem, miss: Miss | None, folder: Path, emit: Emit) -> None:
    """Draw the scene, and the nearest miss with what it names marked and its sentence below.

    A world that draws nothing is not asked to.
    """
    with closing(make_world(problem.domain)) as world:
        if not draws(world):
            return
        with told_if_missing(folder / SCENE, emit):
            world.reset(problem.initial)
            world.render_marked((), folder / SCENE, ())
        if miss is None:
            return
        with told_if_missing(folder / NEAREST_MISS, emit):
            carry_out(world, problem, miss.plan)
            marked = _named(problem.domain.object_names(problem.initial), miss.text)
            world.render_marked(miss.plan, folder / NEAREST_MISS, marked)
            if (folder / NEAREST_MISS).is_file():
                write_below(folder / NEAREST_MISS, miss.text)


def _named(names: Iterable[str], text: str) -> list[str]:
    """The names that occur in a text."""
    return [name for name in names if re.search(rf"(?<!\w){re.escape(name)}(?!\w)", text)]
