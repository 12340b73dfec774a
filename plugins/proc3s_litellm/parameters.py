"""How answers are drawn: which of the wishes a model takes, as far as litellm knows."""

from typing import Any

from proc3s import Sampling
from proc3s_litellm.prices import entry

_NOT_IN_RESPONSES = frozenset({"n", "seed"})
"""Models that are only served by OpenAI's Responses API: it has no such parameters."""


def split(litellm: Any, model: str, sampling: Sampling) -> tuple[dict[str, Any], tuple[str, ...]]:
    """Arguments for the call, and the names of those that must be left out because the model refuses them.

    What litellm would drop silently is found by leaving out one after the other and comparing the results.
    """
    wanted = {k: v for k, v in sampling.model_dump(exclude_none=True).items() if (k, v) != ("n", 1)}
    whole = _mapped(litellm, model, wanted)
    dropped = {k for k in wanted if _mapped(litellm, model, _without(wanted, k)) == whole}
    if "thinking" in whole and wanted.get("temperature") != 1.0:
        # Claude refuses any other while it thinks, and DeepSeek ignores it; litellm sends it all the same.
        dropped.add("temperature")
    if (entry(litellm, model) or {}).get("mode") == "responses":
        dropped |= _NOT_IN_RESPONSES
    kept = {k: v for k, v in wanted.items() if k not in dropped}
    return kept, tuple(k for k in wanted if k in dropped)


def _mapped(litellm: Any, model: str, wanted: dict[str, Any]) -> dict[str, Any]:
    """The provider's own parameters for these wishes."""
    name, provider, *_ = litellm.get_llm_provider(model)
    mapped: dict[str, Any] = litellm.utils.get_optional_params(
        model=name, custom_llm_provider=provider, drop_params=True, **wanted
    )
    return mapped


def _without(wanted: dict[str, Any], name: str) -> dict[str, Any]:
    return {k: v for k, v in wanted.items() if k != name}
