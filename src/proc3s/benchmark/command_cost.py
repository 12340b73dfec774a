"""What a whole command costs: `proc3s run` with bundled answers, as a process of its own."""

import json
import resource
import subprocess
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from proc3s.benchmark.statistics import Ratio, geometric
from proc3s.errors import UsageError
from proc3s.planning.options import RunOptions
from proc3s.plugins.registry import Registry
from proc3s.search.clock import STAGES
from proc3s.specs.domain import DomainSpec

AROUND = "start and end"
"""What is in no stage of a run: imports, reading specs, writing the run folder, exit."""
METHOD: str = RunOptions.model_fields["method"].default
"""Of a run that names none."""


@dataclass(frozen=True)
class CommandCost:
    """One run of a task with a seed by the Python at `python`: CPU seconds by stage, wall seconds of all."""

    task: str
    python: str
    seed: int
    solved: bool
    cpu: dict[str, float]
    wall: float

    @property
    def total(self) -> float:
        """CPU seconds of all stages, those of child processes included."""
        return sum(self.cpu.values())


@dataclass(frozen=True)
class CommandRow:
    """All seeds of a task and a Python: medians, and how much cheaper it is than the other Python."""

    task: str
    python: str
    seeds: int
    solved: int
    cpu: dict[str, float]
    total: float
    wall: float
    cheaper: Ratio | None = None


def tasks_with_answers(registry: Registry, wanted: Sequence[str] = ()) -> list[str]:
    """Tasks that have a bundled answer, or those of the wanted domains and tasks. Raises UsageError."""
    found = []
    for name in wanted:
        spec, task = registry.domain(name).spec if "/" not in name else registry.task(name)[0].spec, name
        answered = [each for each in _answered(spec) if task in (spec.name, each)]
        if not answered:
            raise UsageError(f"{name} has no bundled answer (answers/TASK.{METHOD}.md beside its spec)")
        found += answered
    if not wanted:
        found = [each for spec in registry.all(DomainSpec).values() for each in _answered(spec)]
    return [*dict.fromkeys(found)]


def _answered(spec: DomainSpec) -> list[str]:
    folder = spec.folder / "answers" if spec.folder else None
    return [
        f"{spec.name}/{task}" for task in spec.tasks if folder and (folder / f"{task}.{METHOD}.md").is_file()
    ]


def command_cost(python: str, task: str, seed: int, arguments: Sequence[str]) -> CommandCost:
    """Run a task once, in a folder that is deleted. Raises UsageError if the run does not come to an end."""
    with tempfile.TemporaryDirectory() as folder:
        command = [python, "-P", "-m", "proc3s", "run", task, "--seed", str(seed), *arguments]
        begun, before = time.perf_counter(), _cpu_of_children()
        # It is this program once more, or an earlier version of it.
        done = subprocess.run(
            [*command, "--out", str(Path(folder, "run")), "--json"],
            capture_output=True,
            text=True,
            cwd=folder,
        )
        wall, whole = time.perf_counter() - begun, _cpu_of_children() - before
        return CommandCost(task, python, seed, *_stages(done, whole, command), wall)


def _stages(
    done: subprocess.CompletedProcess[str], whole: float, command: Sequence[str]
) -> tuple[bool, dict[str, float]]:
    """Whether a run solved its task, and its CPU seconds by stage."""
    try:
        summary: dict[str, Any] = json.loads(done.stdout)
        stages = {stage: float(summary["cpu_seconds"][stage]) for stage in STAGES}
    except (ValueError, KeyError) as error:
        last = (done.stderr.strip().splitlines() or ["it said nothing"])[-1]
        raise UsageError(f"`{' '.join(command)}` ended with exit code {done.returncode}: {last}") from error
    return bool(summary["solved"]), {AROUND: max(whole - sum(stages.values()), 0.0), **stages}


def _cpu_of_children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def command_rows(costs: Sequence[CommandCost]) -> list[CommandRow]:
    """One row for every task and Python, in the order in which they were measured."""
    keys = dict.fromkeys((cost.task, cost.python) for cost in costs)
    return [_row(task, python, costs) for task, python in keys]


def _row(task: str, python: str, costs: Sequence[CommandCost]) -> CommandRow:
    own = [cost for cost in costs if (cost.task, cost.python) == (task, python)]
    others = {cost.seed: cost.total for cost in costs if cost.task == task and cost.python != python}
    pairs = [(others[cost.seed], cost.total) for cost in own if cost.seed in others]
    return CommandRow(
        task=task,
        python=python,
        seeds=len(own),
        solved=sum(cost.solved for cost in own),
        cpu={stage: float(np.median([cost.cpu[stage] for cost in own])) for stage in own[0].cpu},
        total=float(np.median([cost.total for cost in own])),
        wall=float(np.median([cost.wall for cost in own])),
        cheaper=geometric(pairs),
    )
