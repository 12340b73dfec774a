"""The built-in prompt templates."""

from collections.abc import Callable
from pathlib import Path

from proc3s import TemplatesSpec, hookimpl


@hookimpl
def register_templates(register: Callable[[TemplatesSpec], None]) -> None:
    """Templates of the three kinds of prompt, their shared parts, and the feedback."""
    register(
        TemplatesSpec(
            name="builtin",
            summary="methods/{proc3s,cap,llm3}.j2, partials/, feedback.j2",
            folder=Path(__file__).parent,
        )
    )
