"""The parts that a run is made of."""

from dataclasses import dataclass, field
from pathlib import Path

from proc3s.planning.limits import ClockLimits
from proc3s.planning.options import PlanPictures
from proc3s.sandbox.box import Limits
from proc3s.search.executor import Executor
from proc3s.search.problem import Problem
from proc3s.search.start import MakeSolver
from proc3s.specs.parts import MethodSpec, PresetSpec


@dataclass(frozen=True)
class Pictures:
    """Which pictures a run draws at once into its folder: of its plan, and of what an unsolved run came
    nearest to (`miss`). Its film is kept whatever it draws."""

    folder: Path
    plan: PlanPictures = "last"
    miss: bool = True


@dataclass(frozen=True)
class Setup:
    """Everything a run is made of, but for the one who proposes programs.

    `improve` samples go into more room once a plan is found, and `rehearsals` into which of the roomiest to
    take. `locked` is False only if the user asked for programs to run outside the kernel's lock.
    """

    problem: Problem
    method: MethodSpec
    preset: PresetSpec
    solver: str
    make_solver: MakeSolver
    improver: str
    make_improver: MakeSolver
    executor: Executor
    limits: Limits = field(default_factory=Limits)
    clock_limits: ClockLimits = field(default_factory=ClockLimits)
    locked: bool = True
    audit: int = 0
    improve: int = 0
    rehearsals: int = 0
    pictures: Pictures | None = None
