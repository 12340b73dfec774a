"""The specs of a domain and of all that it declares."""

import itertools
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Field,
    PrivateAttr,
    field_validator,
    model_validator,
)

from proc3s.specs.base import Count, Identifier, ImportString, Sentence, Spec, Target, placeholders


def _not_called(*taken: str) -> AfterValidator:
    """A name that is not one of those that the loop itself gives."""

    def check(name: str) -> str:
        if name in taken:
            raise ValueError(f"{name!r} is a name that proc3s itself uses; take another one")
        return name

    return AfterValidator(check)


TaskName = Annotated[str, Field(pattern=r"^[A-Za-z_][A-Za-z0-9_-]*$", max_length=80)]


FieldType = Annotated[str, Field(pattern=r"^(\w+|list\[\w+\]|dict\[\w+\])$")]


def _name_from_key(items: Any) -> Any:
    """Specs in a mapping are named by their key."""
    if not isinstance(items, Mapping):
        return items
    return {k: {"name": k, **v} if isinstance(v, Mapping) else v for k, v in items.items()}


Named = BeforeValidator(_name_from_key)


class FieldSpec(Spec):
    """One field of an object type."""

    type: FieldType
    """`float`, `int`, `str`, `bool`, a type of this domain, or `list[…]` / `dict[…]` of one."""
    unit: str | None = None
    """Unit of the number, as the LLM reads it."""
    says: str = ""
    """A few words for the reader of the prompt."""
    default: Any = None
    """Value when the scene gives none; without it the field is required."""

    @property
    def required(self) -> bool:
        """Whether every scene must give this field."""
        return "default" not in self.model_fields_set


class TypeSpec(Spec):
    """An object type: becomes a frozen dataclass here and an ordinary one in the program's box."""

    summary: str
    """One sentence for the reader of the prompt."""
    fields: dict[Identifier, FieldSpec]
    """Fields in order."""
    methods: ImportString | None = None
    """A class whose methods programs may call; its source stands in the prompt and in the program's box."""

    @field_validator("fields")
    @classmethod
    def _defaults_come_last(cls, fields: dict[str, FieldSpec]) -> dict[str, FieldSpec]:
        names = list(fields)
        for before, name in itertools.pairwise(names):
            if fields[name].required and not fields[before].required:
                raise ValueError(f"{name!r} has no default: it must stand before {before!r}, which has one")
        return fields


class ConstantSpec(Spec):
    """A named constant that programs may use."""

    value: int | float | str | list[Any] | dict[str, Any]
    """The value: a number, a text, or a (nested) list or dict of them."""
    says: str = ""
    """A few words for the reader of the prompt."""


class ParamSpec(Spec):
    """A parameter of a skill."""

    type: Literal["float", "int", "str", "object", "point", "pose", "grasp"] = "float"
    """`object` must name an object of the initial state; `point` is 3 numbers, `pose` and `grasp` are 6."""
    unit: str | None = None
    """Unit of the number, as the LLM reads it."""
    says: str = ""
    """A few words for the reader of the prompt."""
    min: float = Field(-math.inf, allow_inf_nan=True)
    """Smallest legal value of a number."""
    max: float = Field(math.inf, allow_inf_nan=True)
    """Largest legal value of a number."""
    noise: float = Field(0.0, ge=0)
    """Standard deviation at full scale for the Gaussian methods, in the parameter's unit; 0: left alone.
    Of a `pose` and a `grasp` it is that of the position, m."""
    turn_noise: float = Field(0.0, ge=0)
    """The same for the three angles of a `pose` or `grasp`, rad."""
    choices: tuple[str, ...] = ()
    """The legal values of a `str`."""

    @model_validator(mode="after")
    def _complete(self) -> "ParamSpec":
        if self.type == "str" and not self.choices:
            raise ValueError("a parameter of type str needs choices")
        if math.isnan(self.min) or math.isnan(self.max) or self.min == math.inf or self.max == -math.inf:
            raise ValueError(f"min {self.min} and max {self.max} leave no legal value")
        if self.min > self.max:
            raise ValueError(f"min {self.min} is above max {self.max}")
        if self.noise and self.type not in ("float", "point", "pose", "grasp"):
            raise ValueError(f"numbers, points, poses and grasps take noise, not a {self.type}")
        if self.turn_noise and self.type not in ("pose", "grasp"):
            raise ValueError(f"poses and grasps take turn_noise, not a {self.type}")
        return self


class SkillSpec(Target):
    """A skill: `target(world, *args) -> telemetry` moves the world by one ground action."""

    kind: ClassVar[str] = "skills"
    name: Annotated[Identifier, _not_called("goal")] = ""
    """Its key, where it stands in a mapping; a plugin gives it. `goal` is the judges' step."""
    summary: str
    """One sentence for the LLM: what the skill does with its parameters."""
    params: dict[Identifier, ParamSpec]
    """Parameters in order."""
    domains: tuple[str, ...] = ()
    """Domains that a plugin's skill attaches to by itself; `*` is every domain."""
    error: Literal["picked", "placed"] = "placed"
    """Which of the domain's `errors` uses up the margins of its steps; `placed` is both together."""


class SamplerSpec(Target):
    """A sampler: `target(**params)` maps the unit cube to values of one parameter of a program."""

    kind: ClassVar[str] = "samplers"
    name: Identifier
    """Its name, as programs write it."""
    summary: str
    """One sentence for the LLM."""
    params: dict[Identifier, Literal["float", "list"]]
    """Constructor parameters in order, as programs give them."""
    gives: Identifier = "float"
    """`float`: the number itself; `choice`: an index into the list that is the first parameter; else a type
    of the domain whose fields are all numbers: its fields in order."""
    domains: tuple[str, ...] = ()
    """Domains that the sampler attaches to by itself; `*` is every domain."""


class ConstraintSpec(Target):
    """A constraint: `target(transition) -> margin`, negative when violated, None where it does not apply."""

    kind: ClassVar[str] = "constraints"
    name: Annotated[Identifier, _not_called("goal", "rehearsal", "world")] = ""
    """Its key, where it stands in a mapping; a plugin gives it. The names of other verdicts are taken."""
    says: Sentence
    """The sentence of a violation; `{…}` takes details that the margin carries."""
    rule: str = ""
    """The rule as a sentence, for prompts that list the constraints."""
    tolerance: float = Field(0.0, ge=0)
    """A margin down to minus this still counts as fulfilled, in the constraint's unit."""
    error: Literal["picked", "placed", "turn", "speed", "none"] | None = None
    """Which of the domain's `errors` uses up its margin; `none`: it is fulfilled or not; default: that of
    the skill."""
    example: dict[str, str] = Field(default_factory=dict)
    """Details of a violation as there may well be one, for prompts that are read before anything failed."""
    domains: tuple[str, ...] = ()
    """Domains that a plugin's constraint attaches to by itself; `*` is every domain."""

    @model_validator(mode="after")
    def _example_fits(self) -> "ConstraintSpec":
        details = placeholders(self.says)
        if strange := [name for name in self.example if name not in details]:
            taken = ", ".join(details) or "none"
            raise ValueError(f"the example has a detail {strange[0]!r}, and `says` takes {taken}")
        return self


class ScreenSpec(Target):
    """A cheap test before the world: `target(state, batch)` gives a violation or None for every plan.

    If it has a parameter `domain`, it is given the domain as well.

    A screen may only reject, and what it says of a plan must not depend on the batch around it. A stateful
    one is made once a world, `target(domain)`, and its `check(state, plan)` looks at one plan at a time.
    """

    name: str
    """What counts of rejected plans call it."""
    exact: bool = False
    """It rejects just what the world rejects, with the same violation."""
    stateful: bool = False
    """It keeps something expensive (a simulator), so it runs where the world runs."""


class ErrorsSpec(Spec):
    """Errors to be expected where plans are carried out, in the units of the domain.

    The defaults are those of a calibrated arm and camera, with positions in metres.
    """

    picked: float = Field(0.001, ge=0)
    """Of where a thing that is picked stands; it is off by as much in the hand."""
    placed: float = Field(0.001, gt=0)
    """Of where the hand puts it down, beside that."""
    turn: float = Field(math.radians(0.5), gt=0)
    """Of how a thing is turned, rad."""
    speed: float = Field(0.05, gt=0)
    """Of the speed of a motion, as a share of it."""

    @property
    def of_placed(self) -> float:
        """Of where a thing is once it is put down: it was picked before."""
        return self.picked + self.placed


class TaskSpec(Spec):
    """A task: an instruction, a scene, and judges that must all be satisfied."""

    kind: ClassVar[str] = "tasks"
    name: TaskName = ""
    """Its key, where it stands in a mapping; a plugin gives it."""
    instruction: str | None = None
    """What to do, in plain language; without it the task needs `--goal`."""
    initial: Target
    """`target(rng, **args) -> data` makes the scene; plain data of the state type."""
    judge: tuple[Target, ...] = ()
    """Each `target(state, plan, **args) -> Score`; none: nobody checks the outcome."""
    budget: dict[str, Count] = Field(default_factory=dict)
    """Samples per problem by preset, where they differ from the domain's."""


class ExampleSpec(TaskSpec):
    """A worked example for the prompt: a task of its own whose answers stand in `examples/NAME.KIND.md`."""

    instruction: str
    """What to do, in plain language."""
    seed: int = Field(0, ge=0)
    """Seed of its scene."""


def _readable(version: object) -> object:
    """Raises ValueError for a format of a newer proc3s."""
    if isinstance(version, int) and version > 1:
        raise ValueError("this proc3s reads format 1 (`pip install --upgrade proc3s` may bring a newer one)")
    return version


SpecVersion = Annotated[Literal[1], BeforeValidator(_readable)]


class DomainSpec(Spec):
    """A whole domain, as `domain.yaml` describes it."""

    kind: ClassVar[str] = "domains"
    spec_version: SpecVersion
    """Version of this format."""
    name: Identifier
    """The part before the slash in `domain/task`."""
    summary: str
    """One sentence: what this world is."""
    credits: tuple[str, ...] = ()
    """Whose data the domain uses, and under which licence; `proc3s show` repeats it."""
    world: Target
    """The transition model that accepts or refuses plans."""
    execution: Target | None = None
    """The world in which accepted plans are carried out; default: the same."""
    state: Identifier
    """The type that is the state."""
    objects: Identifier | None = None
    """The state's field that holds the named objects (a list of things with a `name`, or a dict)."""
    types: dict[Identifier, TypeSpec]
    """Object types."""
    constants: dict[Identifier, ConstantSpec] = Field(default_factory=dict)
    """Constants that programs may use."""
    preface: str = ""
    """What the LLM must know before it reads the skills: axes, units, sizes."""
    skills: Annotated[dict[Identifier, SkillSpec], Named]
    """Skills of this domain."""
    samplers: tuple[Identifier, ...]
    """Names of the samplers that programs of this domain may use."""
    constraints: Annotated[dict[Identifier, ConstraintSpec], Named]
    """Constraints in the order in which they are checked."""
    use: tuple[Identifier, ...] = ()
    """Names of further skills, samplers and constraints that plugins bring."""
    errors: ErrorsSpec = ErrorsSpec()
    """Errors to be expected where plans are carried out: margins are measured by them."""
    screens: tuple[ScreenSpec, ...] = ()
    """Cheap tests before the world, in order."""
    tasks: Annotated[dict[TaskName, TaskSpec], Named]
    """Tasks of this domain."""
    budget: dict[str, Count]
    """Samples per problem by preset."""
    examples: Annotated[dict[Identifier, ExampleSpec], Named] = Field(default_factory=dict)
    """Worked examples, none of them a task."""
    _folder: Path | None = PrivateAttr(default=None)

    @property
    def folder(self) -> Path | None:
        """Where `examples/`, `answers/` and `templates/` lie: the folder of the file."""
        return self._folder

    def in_folder(self, folder: Path) -> "DomainSpec":
        """The same spec, read from a file in `folder`."""
        copy = self.model_copy()
        copy._folder = folder
        return copy
