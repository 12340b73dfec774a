"""The twelve hooks: the table of contents of what a plugin can do.

Each `register_*` hook is called once with a callable that takes one spec at a time.
"""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from proc3s import specs
    from proc3s.runs.events import Event
    from proc3s.search.problem import Problem
    from proc3s.specs.suite import SuiteSpec
from proc3s.markers import hookspec


@hookspec
def register_domains(register: "Callable[[specs.DomainSpec], None]") -> None:
    """Bring domains, usually `register(load_domain(folder / "domain.yaml"))`."""


@hookspec
def register_skills(register: "Callable[[specs.SkillSpec], None]") -> None:
    """Bring skills for domains that exist: by their `domains`, or by a domain's `use`."""


@hookspec
def register_samplers(register: "Callable[[specs.SamplerSpec], None]") -> None:
    """Bring samplers that programs may return from `gen_domain`."""


@hookspec
def register_constraints(register: "Callable[[specs.ConstraintSpec], None]") -> None:
    """Bring constraints for domains that exist: by their `domains`, or by a domain's `use`."""


@hookspec
def register_methods(register: "Callable[[specs.MethodSpec | specs.PresetSpec | SuiteSpec], None]") -> None:
    """Bring methods, presets that fill what methods leave open, and suites that compare them."""


@hookspec
def register_solvers(register: "Callable[[specs.SolverSpec], None]") -> None:
    """Bring solvers of continuous constraint satisfaction problems."""


@hookspec
def register_llms(register: "Callable[[specs.LLMSpec], None]") -> None:
    """Bring language-model backends that `--llm NAME` or `--llm NAME:…` selects."""


@hookspec
def register_executors(register: "Callable[[specs.ExecutorSpec], None]") -> None:
    """Bring executors that map rollouts over plans."""


@hookspec
def register_templates(register: "Callable[[specs.TemplatesSpec], None]") -> None:
    """Bring a folder of Jinja templates."""


@hookspec(firstresult=True)
def resolve_llm(model: str) -> "specs.LLMSpec | None":
    """The backend for a model name that no registered backend claims; the first answer wins."""


@hookspec
def prompt_context(problem: "Problem", method: "specs.MethodSpec") -> "Mapping[str, Any] | None":
    """Further variables for the prompt templates."""


@hookspec
def on_event(event: "Event") -> None:
    """Something happened in a run: a prompt, an answer, trials, an outcome (`proc3s.runs.events`)."""
