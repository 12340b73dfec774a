"""The parts that a run is made of."""

from dataclasses import dataclass, field
from pathlib import Path

from proc3s.planning.limits import ClockLimits
from proc3s.sandbox.box import Limits
from proc3s.search.executor import Executor
from proc3s.search.problem import Problem
from proc3s.search.start import MakeSolver
from proc3s.specs.parts import MethodSpec, PresetSpec


@dataclass(frozen=True)
class Setup:
    """Everything a run is made of, but for the one who proposes programs.

    `locked` is False only if the user asked for programs to run outside the kernel's lock. `picture` takes
    that of the outcome, `miss_folder` those of an unsolved run.
    """

    problem: Problem
    method: MethodSpec
    preset: PresetSpec
    solver: str
    make_solver: MakeSolver
    executor: Executor
    limits: Limits = field(default_factory=Limits)
    clock_limits: ClockLimits = field(default_factory=ClockLimits)
    locked: bool = True
    audit: int = 0
    picture: Path | None = None
    miss_folder: Path | None = None
