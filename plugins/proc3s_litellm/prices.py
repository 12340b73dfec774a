"""What calls cost, from the price list that litellm brings: known, or None."""

from collections.abc import Mapping
from typing import Any

from proc3s import Price

_PROMPT, _COMPLETION = "input_cost_per_token", "output_cost_per_token"


def entry(litellm: Any, model: str) -> Mapping[str, Any] | None:
    """What litellm's list says of a model, if the entry is of the same provider."""
    name, provider, *_ = litellm.get_llm_provider(model)
    for key in (f"{provider}/{name}", name):
        found: Mapping[str, Any] | None = litellm.model_cost.get(key)
        if found and str(found.get("litellm_provider", "")).startswith(provider):
            return found
    return None


def price(litellm: Any, model: str) -> Price | None:
    """US dollars for a million tokens. A price of 0 in the list is mostly a gap, so it counts as unknown."""
    found = entry(litellm, model) or {}
    prompt, completion = found.get(_PROMPT), found.get(_COMPLETION)
    if not prompt or not completion:
        return None
    return Price(prompt=1e6 * prompt, completion=1e6 * completion)


def cost(litellm: Any, model: str, usage: Any) -> float | None:
    """US dollars of a call by litellm's `usage`: cached tokens and long prompts have prices of their own."""
    if price(litellm, model) is None:
        return None
    name, provider, *_ = litellm.get_llm_provider(model)
    parts = litellm.cost_per_token(model=name, custom_llm_provider=provider, usage_object=usage)
    total = float(sum(parts))
    return total if total > 0 else None
