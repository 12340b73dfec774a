"""Options of a run as plain data."""

from pathlib import Path

from pydantic import Field

from proc3s import specs
from proc3s.errors import UsageError
from proc3s.llm.budget import Budget

DEFAULT_SOLVER = "rejection"


DEFAULT_PRESET = "best"


class RunOptions(specs.Spec):
    """What a run was asked to do; with the same options it does the same again."""

    task: str
    llm: str | None = None
    method: str = "proc3s"
    solver: str | None = None
    preset: str = DEFAULT_PRESET
    executor: str = "serial"
    seed: int = Field(0, ge=0)
    goal: str | None = None
    samples: int | None = Field(None, ge=1)
    feedback: int | None = Field(None, ge=0)
    template_dir: Path | None = None
    plugins: tuple[Path, ...] = ()
    domain_options: dict[str, str] = Field(default_factory=dict)
    method_options: dict[str, str] = Field(default_factory=dict)
    solver_options: dict[str, str] = Field(default_factory=dict)
    llm_options: dict[str, str] = Field(default_factory=dict)
    limits: dict[str, str] = Field(default_factory=dict)
    unsafe_exec: bool = False
    jobs: int = Field(1, ge=1)
    no_screens: bool = False
    audit: int = Field(0, ge=0)
    robust: int = Field(0, ge=0)
    check_goal: bool | None = None
    candidates: int = Field(1, ge=1)
    llm_jobs: int | None = Field(None, ge=1)
    record: Path | None = None
    budget: Budget = Budget()


def key_values(pairs: list[str]) -> dict[str, str]:
    """`["count=7"]` -> {"count": "7"}. Raises UsageError for a pair without `=`."""
    for pair in pairs:
        if "=" not in pair:
            raise UsageError(f"an option is given as key=value, not {pair!r}")
    values = dict(pair.split("=", 1) for pair in pairs)
    for name in values:
        if len({pair for pair in pairs if pair.split("=", 1)[0] == name}) > 1:
            raise UsageError(f"the option {name!r} is given several times, with different values")
    return values
