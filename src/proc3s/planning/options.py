"""Options of a run as plain data."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal, get_origin

from pydantic import Field
from pydantic.fields import FieldInfo

from proc3s.errors import UsageError
from proc3s.llm.budget import Budget
from proc3s.specs.base import Spec

DEFAULT_SOLVER = "rejection"


DEFAULT_PRESET = "best"


@dataclass(frozen=True)
class OnCommandLine:
    """How the command line has a field: the panel of the help that shows it, and its flag if not `--NAME`.

    `metavar` stands for the value where the type does not say enough; `asks`: only where an LLM is asked.
    """

    panel: str
    flag: str = ""
    metavar: str = ""
    asks: bool = False


_LLM = OnCommandLine("LLM", asks=True)
_SEARCH = OnCommandLine("Search")
_WORLD = OnCommandLine("World")
Pairs = dict[str, str]
PlanPictures = Literal["all", "last", "none"]


class RunOptions(Spec):
    """What a run was asked to do; with the same options it does the same again.

    Commands and their help are made from these fields, in this order; see `cli/arguments.py`.
    """

    task: str
    llm: Annotated[str | None, replace(_LLM, metavar="MODEL")] = None
    """PROVIDER/MODEL, replay[:PATH], manual:DIR or stub:FILE (default: PROC3S_LLM, proc3s.toml, replay)"""
    candidates: Annotated[int, _LLM] = Field(1, ge=1)
    """programs asked for at once; they race"""
    llm_jobs: Annotated[int | None, _LLM] = Field(None, ge=1)
    """calls to the LLM in flight (default: --candidates)"""
    record: Annotated[Path | None, _LLM] = None
    """cassette (.jsonl or folder) that keeps every answer"""
    budget: Annotated[Budget, _LLM] = Budget()
    method: Annotated[str, _SEARCH] = "proc3s"
    """see `proc3s list methods`"""
    solver: Annotated[str | None, _SEARCH] = None
    """see `proc3s list solvers`"""
    preset: Annotated[str, _SEARCH] = Field(
        DEFAULT_PRESET,
        description=f"what method and command line leave open (default: {DEFAULT_PRESET})",
    )
    executor: Annotated[str, _SEARCH] = "serial"
    """see `proc3s list executors`"""
    jobs: Annotated[int, _SEARCH] = Field(1, ge=1)
    """worker processes"""
    check_goal: Annotated[bool | None, _SEARCH] = None
    """accept only plans that satisfy the judge"""
    no_screens: Annotated[bool, _SEARCH] = False
    """test every plan in the world, even hopeless ones"""
    audit: Annotated[int, _SEARCH] = Field(0, ge=0)
    """put N rejects of the screens to the world after all"""
    robust: Annotated[int | None, _SEARCH] = Field(None, ge=0)
    """accept only plans that also pass N rehearsals with small errors"""
    improve: Annotated[int | None, _SEARCH] = Field(None, ge=0)
    """after a plan is found, try N samples around it for more room (default: that of the preset)"""
    improver: Annotated[str | None, _SEARCH] = None
    """the solver that asks for them (default: roomier)"""
    seed: Annotated[int, _WORLD] = Field(0, ge=0)
    """scene and random draws"""
    goal: Annotated[str | None, replace(_WORLD, metavar="TEXT")] = None
    """an instruction of your own (nobody judges it)"""
    samples: Annotated[int | None, _SEARCH] = Field(None, ge=1)
    """samples per round"""
    feedback: Annotated[int | None, _LLM] = Field(None, ge=0)
    """feedback rounds"""
    template_dir: Annotated[Path | None, _LLM] = None
    """folder of templates that go before all others"""
    plugins: Annotated[tuple[Path, ...], replace(_WORLD, flag="--plugin")] = ()
    """plugin not installed: .py, domain.yaml or folder (repeatable)"""
    domain_options: Annotated[Pairs, replace(_WORLD, flag="-D")] = Field(default_factory=dict)
    """argument of the task's scene"""
    world_options: Annotated[Pairs, replace(_WORLD, flag="-W")] = Field(default_factory=dict)
    """option of the world, see `proc3s show DOMAIN`"""
    method_options: Annotated[Pairs, replace(_SEARCH, flag="-M")] = Field(default_factory=dict)
    """field of the method"""
    solver_options: Annotated[Pairs, replace(_SEARCH, flag="-S")] = Field(default_factory=dict)
    """option of the solver"""
    llm_options: Annotated[Pairs, replace(_LLM, flag="-L")] = Field(default_factory=dict)
    """option of the LLM"""
    limits: Annotated[Pairs, replace(_WORLD, flag="--limit")] = Field(default_factory=dict)
    """limit of the box, e.g. call=2, or of the clock, e.g. round=60"""
    pictures: Annotated[PlanPictures, replace(_WORLD, metavar="WHICH")] = "last"
    """drawn at once: all, last or none; the others when somebody looks (default: last)"""
    no_miss_picture: Annotated[bool, _WORLD] = False
    """do not draw the nearest miss of an unsolved run"""
    unsafe_exec: Annotated[bool, _WORLD] = False
    """run programs WITHOUT the kernel's lock; warns each time"""


@dataclass(frozen=True)
class Option:
    """An option as whoever gives it sees it: a field, and how the command line has it."""

    name: str
    field: FieldInfo
    shown: OnCommandLine

    @property
    def flag(self) -> str:
        """What stands before its value."""
        return self.shown.flag or f"--{self.name.replace('_', '-')}"


def all_options() -> dict[str, Option]:
    """The options that fill RunOptions, but for its task; those of the budget are options of their own."""
    found: dict[str, Option] = {}
    for name, field in RunOptions.model_fields.items():
        for shown in (m for m in field.metadata if isinstance(m, OnCommandLine)):
            fields = Budget.model_fields if field.annotation is Budget else {name: field}
            found |= {each: Option(each, of, shown) for each, of in fields.items()}
    return found


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


def run_options(**given: Any) -> RunOptions:
    """Options of a run from what was given; None leaves the default. Raises UsageError or SpecError."""
    from proc3s.specs.yaml_files import validate  # not while the command line is put together

    return validate(RunOptions, plain_options(given), "options")


def plain_options(given: Mapping[str, Any]) -> dict[str, Any]:
    """What was given as fields of RunOptions: pairs `key=value` as dictionaries, paths in full."""
    values = {name: _plain(name, value) for name, value in given.items() if value is not None}
    if budget := {name: values.pop(name) for name in Budget.model_fields if name in values}:
        values["budget"] = budget
    if values.get("jobs", 1) > 1:
        values.setdefault("executor", "processes")
    return values


def _plain(name: str, value: Any) -> Any:
    field = RunOptions.model_fields.get(name)
    kind = field.annotation if field else None
    if get_origin(kind) is dict:
        return key_values(value) if isinstance(value, list) else {k: str(v) for k, v in value.items()}
    if kind == Path | None:
        return Path(value).absolute()
    return [path.absolute() for path in value] if name == "plugins" else value
