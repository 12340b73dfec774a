"""The domain under examination: its scenes, and plans to try it with, made once."""

import dataclasses
import functools
import json
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from proc3s.checks.fault import NotCheckedError
from proc3s.domain.domain import Domain
from proc3s.domain.plan_batch import PlanBatch
from proc3s.domain.prelude import setup_code
from proc3s.domain.source_text import source_text
from proc3s.domain.values import Plan
from proc3s.domain.world_options import with_world_options
from proc3s.planning.options import RunOptions
from proc3s.planning.setup import make_problem
from proc3s.plugins.registry import Registry
from proc3s.prompts.examples import example_turns
from proc3s.prompts.extract import extract_program
from proc3s.sandbox import BoxedSketch, Program, SketchError
from proc3s.search.problem import Problem
from proc3s.specs.parts import MethodSpec
from proc3s.textfiles import read_text

SEEDS = 4
"""Scenes of every task that are looked at."""
SAMPLES = 48
"""Samples of every program that plans are taken from."""
NONE = "no program is bundled, see programs"


@dataclass(frozen=True)
class BundledAnswer:
    """A program that comes with the domain, for a task or an example."""

    name: str
    path: Path
    source: str
    method: MethodSpec
    """The method whose answer it is."""
    problem: Problem

    @property
    def kind(self) -> str:
        """`sketch`, `program` or `plan`."""
        return self.method.answer


class Subject:
    """A domain with what its checks need in common; `seconds` bounds the search for a screen's mistakes.

    `world_options` are those of its worlds. Raises UsageError for one that they do not have.
    """

    def __init__(
        self,
        registry: Registry,
        name: str,
        seconds: float = 20.0,
        world_options: Mapping[str, str] | None = None,
    ) -> None:
        self.registry, self.seconds = registry, seconds
        self.wrong: set[str] = set()
        """Checks that found errors."""
        self.causes: dict[str, str] = {}
        """What the domain's code raised, and the check that met it first."""
        self._world_options = world_options or {}
        self.domain: Domain = with_world_options(registry.domain(name), self._world_options)
        self.spec = self.domain.spec
        self.file = str(self.spec.folder / "domain.yaml") if self.spec.folder else f"domain {name}"

    @property
    def methods(self) -> list[MethodSpec]:
        """All methods that are installed."""
        return list(self.registry.all(MethodSpec).values())

    def problem(self, task: str, seed: int = 0, method: str = "proc3s") -> Problem:
        """The problem of a task without a program; the judge does not decide what is accepted."""
        goal = None if self.spec.tasks[task].instruction else "anything"
        name = f"{self.spec.name}/{task}"
        options = RunOptions.model_validate(
            {
                "task": name,
                "method": method,
                "seed": seed,
                "goal": goal,
                "check_goal": False,
                "samples": SAMPLES,
                "world_options": self._world_options,
            }
        )
        return make_problem(self.registry, options, goal_needed=False)

    @functools.cached_property
    def answers(self) -> list[BundledAnswer]:
        """The bundled answers to tasks (seed 0 where they name one), and those of the examples."""
        return [*self._of_tasks(), *self._of_examples()]

    def _of_tasks(self) -> Iterator[BundledAnswer]:
        folder = self.spec.folder / "answers" if self.spec.folder else None
        methods = {method.template: method for method in reversed(self.methods)}
        for path in sorted(folder.glob("*.md")) if folder else ():
            task, template, *rest = path.name.removesuffix(".md").split(".")
            seeds = [int(part.removeprefix("seed")) for part in rest if part.startswith("seed")]
            if task in self.spec.tasks and template in methods:
                problem = self.problem(task, seeds[0] if seeds else 0)
                yield self._answer(path.name, path, read_text(path), methods[template], problem)

    def _of_examples(self) -> Iterator[BundledAnswer]:
        for example in self.spec.examples.values():
            if not self.spec.tasks:
                return
            problem = self.problem(next(iter(self.spec.tasks)))
            scene = json.dumps(self.domain.states.dump(self.domain.scene(example, example.seed)))
            problem = dataclasses.replace(problem, task=example, scene=scene, goal=example.instruction or "")
            for kind, method in sorted({method.answer: method for method in reversed(self.methods)}.items()):
                path = (self.spec.folder or Path()) / "examples" / f"{example.name}.{kind}.md"
                if path.is_file():
                    texts = [t for turn, t in example_turns(problem, example, kind) if turn == "answer"]
                    yield self._answer(path.name, path, texts[-1], method, problem)

    def _answer(
        self, name: str, path: Path, text: str, method: MethodSpec, problem: Problem
    ) -> BundledAnswer:
        try:
            source = extract_program(text)
        except SketchError:
            source = text
        return BundledAnswer(name, path, source, method, problem)

    def sketch(self, answer: BundledAnswer, source: str | None = None) -> BoxedSketch:
        """The program of an answer in its box, or another in its place. Raises SketchError."""
        state = answer.problem.initial
        return BoxedSketch(
            Program(
                source=answer.source if source is None else source,
                answer=answer.method.answer if source is None else "program",
                prelude=setup_code(self.domain),
                initial=source_text(state),
                signatures=self.domain.signatures(state),
                samplers=self.domain.samplers,
            )
        )

    @functools.cached_property
    def batches(self) -> list[tuple[BundledAnswer, PlanBatch]]:
        """Plans of every answer that has any: samples drawn by a seed of their own."""
        found = []
        for answer in self.answers:
            try:
                with self.sketch(answer) as sketch:
                    u = np.random.default_rng(0).random((SAMPLES, sketch.space.dim))
                    batch = sketch.plans(u if sketch.space.dim else u[:1], first=0)
            except SketchError:
                continue  # the check of bundled programs says so
            if len(batch.errors) < len(batch):
                found.append((answer, batch))
        return found

    def plans(self, most: int) -> Iterator[tuple[BundledAnswer, Plan]]:
        """Plans of all answers, of each in turn, at most so many of each."""
        for answer, batch in self.batches:
            good = [i for i in range(len(batch)) if i not in batch.errors][:most]
            yield from ((answer, batch.plan(i)) for i in good)

    def require_plans(self) -> None:
        """Raises NotCheckedError if there is no plan to try."""
        if not self.batches:
            self.require_all_plans()

    def require_all_plans(self) -> None:
        """Raises NotCheckedError if a bundled program makes no plan."""
        if not self.answers:
            raise NotCheckedError(NONE)
        if idle := [one.name for one in self.answers if one.path not in {a.path for a, _ in self.batches}]:
            raise NotCheckedError(f"{', '.join(idle)} makes no plan, see programs")

    def deadline(self) -> float:
        """When the search for mistakes that began now must end, as `time.monotonic` counts."""
        return time.monotonic() + self.seconds


def same(a: Any, b: Any) -> bool:
    """Whether two results are equal to the last bit, arrays and NaN included."""
    return bool(a == b) or repr(a) == repr(b)
