"""A domain small enough to check by hand: beads on a wire from -10 to 10."""

import dataclasses
from pathlib import Path

import numpy as np

from proc3s import Margin, Problem, Score, World
from proc3s.domain.domain import Domain
from proc3s.domain.plan_batch import WIDTH, PlanBatch
from proc3s.domain.values import Pose
from proc3s.specs.domain import SamplerSpec
from proc3s.specs.yaml_files import load_domain

DOMAIN = """\
spec_version: 1
name: toy
summary: Beads slide on a wire.
world: {target: "toy_world:Wire"}
state: Scene
objects: beads
types:
  Bead:
    summary: A bead.
    fields:
      name: {type: str}
      place: {type: float, unit: m}
  Scene:
    summary: The wire.
    fields:
      beads: {type: "list[Bead]"}
      moves: {type: int, default: 0}
skills:
  slide:
    summary: Slides a bead.
    target: "toy_world:slide"
    params:
      bead: {type: object}
      by: {type: float, unit: m, noise: 2}
samplers: [ContinuousSampler]
constraints:
  on_wire: {says: "{bead} leaves the wire", target: "toy_world:on_wire", tolerance: 0.5}
tasks:
  shift:
    instruction: Shift a bead.
    initial: {target: "toy_world:scene", args: {count: 2}}
budget: {paper: 100, release: 50}
"""


def scene(rng, count=2):
    return {"beads": [{"name": f"object_{i}", "place": float(i)} for i in range(count)]}


@dataclasses.dataclass(frozen=True)
class Slid:
    bead: str
    place: float


class Wire(World):
    def place(self, state):
        self._state = state

    def observe(self):
        return self._state

    def save(self):
        return self._state

    def load(self, snapshot):
        self._state = snapshot


def slide(world, bead, by):
    state = world.observe()
    beads = tuple(dataclasses.replace(b, place=b.place + by) if b.name == bead else b for b in state.beads)
    world.load(dataclasses.replace(state, beads=beads, moves=state.moves + 1))
    return Slid(bead, next(b.place for b in beads if b.name == bead))


def on_wire(transition):
    return Margin(10 - abs(transition.telemetry.place), {"bead": transition.telemetry.bead})


def answer(transition, value=None):
    """A constraint that returns what a test wants it to."""
    return value


def says_true(transition):
    return np.float64(1) > 0


def says_false(transition):
    return np.float64(1) < 0


def thousandth(transition):
    return np.float32(-0.125)


def not_a_number(transition):
    return float("nan")


def infinite(transition):
    return -np.inf


def moved(state, plan):
    return Score(state.moves > 0, f"{state.moves} moves")


def write(folder: Path, text: str = DOMAIN) -> Path:
    path = folder / "domain.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def domain(folder: Path, text: str = DOMAIN) -> Domain:
    sampler = SamplerSpec(
        name="ContinuousSampler",
        summary="A number.",
        params={"min": "float", "max": "float"},
        target="proc3s.domain.samplers:ContinuousSampler",
    )
    return Domain(load_domain(write(folder, text)), (sampler,))


def problem(folder: Path, text: str = DOMAIN, seed: int = 0) -> Problem:
    import json

    made = domain(folder, text)
    task = made.spec.tasks["shift"]
    state = made.scene(task, seed)
    return Problem(
        domain=made,
        task=task,
        scene=json.dumps(made.states.dump(state)),
        goal=task.instruction,
        seed=seed,
        samples=100,
    )


def columns(signatures, plans, errors=None) -> PlanBatch:
    """Plans as columns; None stands for a sample that failed."""
    start, skill, offset, values = [0], [], [0], []
    names = [s.skill for s in signatures]
    for plan in plans:
        for name, *args in plan or ():
            k = names.index(name)
            for param, value in zip(signatures[k].params, args, strict=True):
                values += _wire(param, value)
            skill.append(k)
            offset.append(len(values))
        start.append(len(skill))
    return PlanBatch(
        tuple(signatures),
        np.array(start),
        np.array(skill, dtype=np.uint8),
        np.array(offset),
        np.array(values, dtype=float),
        errors or {},
    )


def _wire(param, value):
    if param.choices:
        return [param.choices.index(value)]
    if WIDTH[param.type] == 1:
        return [value]
    return list(dataclasses.astuple(value)) if isinstance(value, Pose) else list(value)
