"""Every provider that litellm has."""

import re
from collections.abc import Callable

from proc3s import LLMSpec, hookimpl

SPEC = LLMSpec(
    name="litellm",
    summary="A model of any provider, or a local server, through litellm.",
    usage="PROVIDER/MODEL, or litellm/PROVIDER/MODEL",
    example="anthropic/claude-sonnet-4-5",
    target="proc3s_litellm.backend:LiteLLM",
    options="proc3s_litellm.backend:Options",
    check="proc3s_litellm.checks:check",
)


@hookimpl
def register_llms(register: Callable[[LLMSpec], None]) -> None:
    """The backend by its own name."""
    register(SPEC)


@hookimpl(trylast=True)
def resolve_llm(model: str) -> LLMSpec | None:
    """Any PROVIDER/MODEL that nobody else claims."""
    return SPEC if re.fullmatch(r"[\w.-]+/[^\s]+", model) else None
