"""The specs of methods, presets, solvers, LLM backends, executors and templates."""

from pathlib import Path
from typing import ClassVar, Literal

from pydantic import (
    Field,
)

from proc3s.specs.base import ImportString, Spec, Target


class MethodSpec(Spec):
    """A method: which prompt, what kind of answer, and how it is searched."""

    kind: ClassVar[str] = "methods"
    name: str
    """What `--method` calls it."""
    summary: str
    """One sentence for `proc3s list`."""
    template: str
    """Template of the prompt, `methods/NAME.j2`; bundled answers are kept under the same NAME."""
    answer: Literal["sketch", "program", "plan"]
    """`sketch`: gen_plan with parameters, and gen_domain; `program`: gen_plan(state); `plan`: the actions."""
    samples: Literal["none", "one", "budget"] = "budget"
    """How many samples a problem gets; `none` executes the plan unchecked."""
    perturb: Literal["none", "gaussian"] = "none"
    """`gaussian`: every number of the plan becomes a dimension of noise."""
    fallback: Literal["none", "last_plan"] = "none"
    """What is executed when nothing was accepted."""
    rounds: int = Field(0, ge=0)
    """Feedback rounds after the first answer."""
    solver: str | None = None
    """Solver that the method needs; the command line may still name another."""


class PresetSpec(Spec):
    """What method and command line leave open: budgets and the style of the feedback."""

    kind: ClassVar[str] = "presets"
    name: str
    """What `--preset` calls it."""
    summary: str
    """One sentence for `proc3s list`."""
    budget: str
    """Which of the budgets of a domain applies."""
    feedback: str = "paper"
    """Style of the feedback template."""
    top: int = Field(2, ge=1)
    """How many of the commonest failures the feedback names."""
    solver: str | None = None
    """Solver where neither method nor command line names one."""
    check_goal: bool = False
    """Whether a plan must satisfy the judge to be accepted."""
    improve: int = Field(0, ge=0)
    """Samples around an accepted plan, for one with more room."""
    rehearsals: int = Field(0, ge=0)
    """Rehearsals with small errors, where the world can make some: of the roomiest plans the first is taken
    that passes them."""
    improver: str = "roomier"
    """The solver that asks for them."""
    screens: Literal["all", "exact", "none"] = "exact"
    """Which screens may reject plans."""
    repairs: int = Field(0, ge=0)
    """Questions that a program with errors costs before it costs a feedback round."""
    restart_after: int = Field(0, ge=0)
    """Rounds without progress after which the LLM is shown its best program again; 0: never."""
    state_constraints: bool = False
    """Whether the prompt lists the constraints."""


class SolverSpec(Target):
    """A solver: `target(space, budget, rng, options)` with `ask` and `tell`."""

    kind: ClassVar[str] = "solvers"
    name: str
    """What `--solver` calls it."""
    summary: str
    """One sentence for `proc3s list`."""
    options: ImportString | None = None
    """pydantic model of its options (`-S key=value`)."""
    objective: Literal["progress", "room"] = "progress"
    """`progress`: it looks for an accepted plan; `room`: it begins from one (the first trial that it is told)
    and looks for more room, where `--improver` names it."""


class LLMSpec(Target):
    """A language-model backend: `target(model, options)` with `complete(request)`."""

    kind: ClassVar[str] = "llms"
    name: str
    """What `--llm` begins with."""
    summary: str
    """One sentence for `proc3s list`."""
    usage: str
    """How `--llm` names it."""
    example: str | None = None
    """A model that it asks, as after `--llm`; messages name it where a model may help."""
    options: ImportString | None = None
    """pydantic model of its own options (`-L key=value`), beside those that every backend takes."""
    check: ImportString | None = None
    """`check(model, options)` -> findings for `proc3s doctor`; model is None if another one is chosen."""


class ExecutorSpec(Target):
    """An executor: `target(jobs)` maps `rollout` over plans, results in order."""

    kind: ClassVar[str] = "executors"
    name: str
    """What `--executor` calls it."""
    summary: str
    """One sentence for `proc3s list`."""
    most_jobs: int | None = Field(None, ge=1)
    """More jobs than these change nothing, and are refused; null for any number."""


class TemplatesSpec(Spec):
    """A folder of Jinja templates; later registrations are searched first."""

    kind: ClassVar[str] = "templates"
    name: str
    """What `proc3s list` calls it."""
    summary: str
    """One sentence for `proc3s list`."""
    folder: Path
    """Where the `.j2` files lie."""
