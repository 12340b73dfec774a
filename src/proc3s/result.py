"""What a run came to, for scripts and notebooks: read from its folder, and shown."""

import html
import io
from base64 import b64encode
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from proc3s.domain.room import Room
from proc3s.domain.state import State
from proc3s.domain.values import Action, Plan
from proc3s.domain.world import make_world
from proc3s.errors import UsageError
from proc3s.feedback.report import Diagnosis
from proc3s.llm.budget import Spent
from proc3s.planning.film import draw_pictures
from proc3s.planning.known_plan import plan_of
from proc3s.planning.options import RunOptions
from proc3s.planning.repetition import Repetition, repeat, require_error
from proc3s.planning.setup import make_problem
from proc3s.planning.summary import Summary
from proc3s.plugins.registry import Registry, open_registry
from proc3s.reporting.history import ProgramRecord, Story, read_story
from proc3s.runs.pictures import NEAREST_MISS, OUTCOME, SCENE, step_picture
from proc3s.search.rollout import carry_out
from proc3s.specs.domain import SamplerSpec
from proc3s.specs.yaml_files import validate
from proc3s.wording import count

if TYPE_CHECKING:
    from pandas import DataFrame
    from PIL.Image import Image

_COLUMNS = ("accepted", "reached", "step", "violation", "margin", "text")


@dataclass(frozen=True)
class Trials:
    """The samples of all programs of a run as columns; equal positions belong to one sample.

    `columns` has round, candidate, sample, accepted, reached (steps before the first violation), and of the
    first violation step, constraint (violation), margin (its unit, negative) and text. `values` and `u` have
    a column for each open parameter: what the program was given, and the point of the unit cube; None where
    another program was at work.
    """

    columns: Mapping[str, Sequence[Any]]
    values: Mapping[str, Sequence[Any]]
    u: Mapping[str, Sequence[Any]]

    def __len__(self) -> int:
        return len(self.columns["round"])

    def __repr__(self) -> str:
        accepted = sum(map(bool, self.columns["accepted"]))
        return f"<{count(len(self), 'trial')}, {accepted} accepted, of {', '.join(self.values)}>"

    def __getitem__(self, name: str) -> Sequence[Any]:
        """A column, or the values of a parameter, by name."""
        return self.columns[name] if name in self.columns else self.values[name]

    def to_pandas(self) -> "DataFrame":
        """A table with a row for each sample; points of the cube are columns `u.NAME`.

        Raises UsageError without pandas.
        """
        try:
            from pandas import DataFrame
        except ModuleNotFoundError as error:
            raise UsageError("to_pandas needs pandas: pip install pandas") from error

        points = {f"u.{name}": column for name, column in self.u.items()}
        return DataFrame({**self.columns, **self.values, **points})


class Result:
    """A run that ended; everything is read from its folder when it is asked for.

    A temporary folder goes with the result: give `out` to keep it. Raises UsageError if there is no run.
    """

    def __init__(
        self,
        run_dir: Path,
        registry: Registry | None = None,
        summary: Summary | None = None,
        temporary: "TemporaryDirectory[str] | None" = None,
    ) -> None:
        self.run_dir = run_dir
        self._given = registry
        self._temporary = temporary
        self._story: Story = read_story(run_dir)
        self.summary = summary or Summary.model_validate(self._story.summary or {})

    @property
    def solved(self) -> bool:
        """Whether the world accepted the plan."""
        return self.summary.solved

    @property
    def goal_reached(self) -> bool | None:
        """The judge's verdict after execution; None without a judge."""
        return self.summary.goal_reached

    @property
    def reason(self) -> str | None:
        """The judge's reason; of a run that did not come so far, why: its error, or the commonest failure."""
        return self.summary.error or self.summary.goal_reason or self._commonest

    @property
    def _commonest(self) -> str | None:
        failure = self.diagnosis.commonest if self.diagnosis else None
        return f"{failure.kind}: {failure.text}" if failure else None

    @property
    def error(self) -> str | None:
        """Why the run did not come to its end; None if it did."""
        return self.summary.error

    @property
    def plan(self) -> Plan | None:
        """The plan that was carried out."""
        plan = self.summary.plan
        return tuple(Action.from_json(action) for action in plan) if plan else None

    @property
    def room(self) -> Room | None:
        """What limits the accepted plan, and how many errors of the expected size it stands (`value`)."""
        room = self.summary.room
        return Room(**room) if room else None

    @property
    def program(self) -> str | None:
        """The text of the last program."""
        return next((p.source for p in reversed(self._story.programs) if p.source), None)

    @property
    def diagnosis(self) -> Diagnosis | None:
        """What failed in the last round that was diagnosed."""
        return next((p.diagnosis for p in reversed(self._story.programs) if p.diagnosis), None)

    @property
    def cost(self) -> Spent:
        """Calls, tokens and US dollars; unknown sums are None."""
        return self.summary.usage

    @cached_property
    def trials(self) -> Trials:
        """All samples of all programs."""
        return _trials(self._story, self._registry)

    @cached_property
    def states(self) -> tuple[State, ...]:
        """The state after every step of the plan, in the execution world; the plan is carried out again."""
        if self.plan is None:
            return ()
        problem = make_problem(self._registry, self._options, goal_needed=False)
        spec, seen = problem.domain.spec, list[State]()
        world = make_world(problem.domain, spec.execution or spec.world)
        try:
            carry_out(world, problem, self.plan, stop=False, visit=seen.append)
        finally:
            world.close()
        return tuple(seen)

    def execute(
        self, error_mm: float = 0.0, times: int = 10, world_options: Mapping[str, Any] | None = None
    ) -> list[Repetition]:
        """The verdict each time that the plan is carried out with things up to `error_mm` (mm) off; 0: once.

        `world_options` replace those of the run. Raises UsageError without a plan.
        """
        changed = {name: str(value) for name, value in (world_options or {}).items()}
        known = plan_of(self.run_dir)
        problem = known.problem(self._registry, changed)
        return [*repeat(problem, known.plan, times, require_error(error_mm))]

    def picture(self, step: int | None = None) -> "Image":
        """The outcome, of an unsolved run its nearest miss, or the world after so many steps, where it draws
        one; drawn now if it is not there yet. Raises UsageError without."""
        from PIL import Image

        path = self._outcome if step is None else self.run_dir / step_picture(step)
        if not path.is_file() and step is not None:
            draw_pictures(self.run_dir, self._registry)
        if not path.is_file():
            raise UsageError(f"the run has no picture {path.name}")
        with Image.open(path) as image:
            return image.copy()

    @property
    def _outcome(self) -> Path:
        """The picture of what became of the run; the last of those that it may have, if it has none."""
        names = [OUTCOME] if self.solved else [NEAREST_MISS, OUTCOME, SCENE]
        paths = [self.run_dir / name for name in names]
        if not any(path.is_file() for path in paths):
            draw_pictures(self.run_dir, self._registry, steps=False)
        return next((path for path in paths if path.is_file()), paths[-1])

    @cached_property
    def _options(self) -> RunOptions:
        return validate(RunOptions, self._story.options, str(self.run_dir))

    @cached_property
    def _registry(self) -> Registry:
        return self._given or open_registry(self._options.plugins)

    def __repr__(self) -> str:
        verdict = "solved" if self.solved else "not solved"
        return f"<{self.summary.task}, seed {self.summary.seed}: {verdict}; {self.reason}>"

    def _repr_html_(self) -> str:
        """The picture, the plan and the reason, for a notebook."""
        lines = [html.escape(repr(self)[1:-1])]
        lines += [f"{k} {html.escape(str(action))}" for k, action in enumerate(self.plan or ())]
        text = "<br>".join(lines)
        return f'<div style="display:flex;gap:1em">{self._picture_tag()}<div>{text}</div></div>'

    def _picture_tag(self) -> str:
        if not self._outcome.is_file():
            return ""
        buffer = io.BytesIO()
        self.picture().save(buffer, "png")
        data = b64encode(buffer.getvalue()).decode()
        return f'<img width="360" alt="the outcome" src="data:image/png;base64,{data}">'


def _trials(story: Story, registry: Registry) -> Trials:
    programs = [program for program in story.programs if program.samples.u]
    names = list(dict.fromkeys(name for program in programs for name in program.parameters))
    columns: dict[str, list[Any]] = {n: [] for n in ("round", "candidate", "sample", *_COLUMNS)}
    values: dict[str, list[Any]] = {name: [] for name in names}
    u: dict[str, list[Any]] = {name: [] for name in names}
    for program in programs:
        size = len(program.samples.u)
        columns["round"] += [program.round] * size
        columns["candidate"] += [program.candidate] * size
        columns["sample"] += range(size)
        for name in _COLUMNS:
            columns[name] += getattr(program.samples, name)
        points = _points(program)
        for name in names:
            here = points.get(name)
            u[name] += [None] * size if here is None else _plain(here)
            values[name] += [None] * size if here is None else _values(program, name, here, registry)
    return Trials(columns, values, u)


def _points(program: ProgramRecord) -> dict[str, Any]:
    """The points of the unit cube, (n, dim), of every parameter."""
    rows, at, found = np.array(program.samples.u), 0, {}
    for name, dim in program.dims.items():
        found[name] = rows[:, at : at + dim]
        at += dim
    return found


def _values(program: ProgramRecord, name: str, u: Any, registry: Registry) -> list[Any]:
    """What a program was given for points (n, dim) of a parameter; None where that is not known."""
    call, known = program.samplers.get(name), registry.all(SamplerSpec)
    if call is None or call.sampler not in known:
        return [None] * len(u)
    spec = known[call.sampler]
    columns = spec.load()(**call.args).decode(u)
    if spec.gives == "choice":
        choices = call.args[next(iter(spec.params))]
        return [choices[int(k)] for k in columns[:, 0]]
    return _plain(columns)


def _plain(columns: Any) -> list[Any]:
    """One column as numbers, several as tuples."""
    rows = columns.tolist()
    return [row[0] if len(row) == 1 else tuple(row) for row in rows]
