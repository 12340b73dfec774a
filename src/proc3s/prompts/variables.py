"""What a template of a prompt is given: its variables and filters."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from typing import Any

from pydantic import BaseModel

from proc3s.domain.state import State
from proc3s.feedback.report import Diagnosis
from proc3s.feedback.shares import portion
from proc3s.prompts.text import state_text
from proc3s.specs.domain import DomainSpec, SamplerSpec
from proc3s.specs.parts import MethodSpec, PresetSpec
from proc3s.wording import plain


@dataclass(frozen=True)
class SharedVariables:
    """Variables of every template."""

    domain: DomainSpec
    """The domain, with the skills and constraints that plugins attach to it."""
    method: MethodSpec
    """The method; `method.answer` says what the model must write."""
    preset: PresetSpec
    """The preset; `preset.feedback` is the style of the feedback."""
    samplers: tuple[SamplerSpec, ...]
    """The samplers that a program may use; none unless the answer is a `sketch`."""
    setup_code: str
    """Python source that runs before the program: imports, constants, classes."""
    python: str
    """Version of the Python that runs the program, such as `3.11`."""


@dataclass(frozen=True)
class TaskVariables:
    """Further variables of `partials/task.j2`, which shows a task or a worked example."""

    initial: State
    """The initial state, an object of the domain's state type; `initial | state_text` shows it."""
    goal: str
    """The instruction."""


@dataclass(frozen=True)
class FeedbackVariables:
    """Further variables of `feedback.j2`."""

    diagnosis: Diagnosis
    """Why the latest round shown failed."""
    tried: tuple[Diagnosis, ...]
    """Why later rounds failed that got no further, and are not shown (`restart_after` of the preset)."""


FILTERS: Mapping[str, Callable[..., str]] = {"state_text": state_text, "portion": portion, "plain": plain}
"""Filters beside those of Jinja."""


def plain_data(variables: SharedVariables | TaskVariables | FeedbackVariables) -> dict[str, Any]:
    """The variables by name; specs and diagnoses as dictionaries, since templates come from anyone."""
    return {field.name: _plain(getattr(variables, field.name)) for field in fields(variables)}


def _plain(value: Any) -> Any:
    if isinstance(value, BaseModel):
        return value.model_dump()
    return [_plain(item) for item in value] if isinstance(value, tuple) else value
