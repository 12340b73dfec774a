"""Options of a run as plain data."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import Field

from proc3s import specs
from proc3s.errors import UsageError
from proc3s.llm.budget import Budget
from proc3s.specs.yaml_files import validate

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


_PAIRS = ("domain_options", "method_options", "solver_options", "llm_options", "limits")
_BUDGET = ("max_cost", "max_tokens", "max_calls")
_PATHS = ("template_dir", "record")


def run_options(**given: Any) -> RunOptions:
    """Options of a run from what was given; None leaves the default. Raises UsageError or SpecError."""
    return validate(RunOptions, plain_options(given), "options")


def plain_options(given: Mapping[str, Any]) -> dict[str, Any]:
    """What was given as fields of RunOptions: pairs `key=value` as dictionaries, paths in full."""
    values = {name: value for name, value in given.items() if value is not None}
    for name in _PAIRS:
        if isinstance(values.get(name), list):
            values[name] = key_values(values[name])
        elif name in values:
            values[name] = {key: str(value) for key, value in values[name].items()}
    if budget := {name: values.pop(name) for name in _BUDGET if name in values}:
        values["budget"] = budget
    if "plugins" in values:
        values["plugins"] = [path.resolve() for path in values["plugins"]]
    for name in _PATHS:
        if name in values:
            values[name] = Path(values[name]).resolve()
    if values.get("jobs", 1) > 1:
        values.setdefault("executor", "processes")
    return values
