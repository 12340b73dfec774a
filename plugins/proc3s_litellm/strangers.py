"""Keys of the providers that are not in our table: litellm is asked, once it is imported anyway."""

from typing import Any

from pydantic import SecretStr

from proc3s_litellm.keys import DUMMY, missing_key
from proc3s_litellm.providers import PROVIDERS, SIGNED_IN
from proc3s_litellm.sentences import Call


def key_for_call(litellm: Any, call: Call) -> SecretStr | None:
    """The key to hand over; None where litellm has one. Raises LLMError ("missing_key").

    Without a key litellm would send OPENAI_API_KEY to any provider that speaks OpenAI's protocol.
    """
    if call.provider in PROVIDERS or call.provider in SIGNED_IN:
        return call.key
    _, provider, found, _ = litellm.get_llm_provider(call.model)
    if found:
        return None
    if call.server:
        return DUMMY
    names = _variables(litellm, provider, call.model)
    if names or provider in litellm.openai_compatible_providers:
        raise missing_key(call.model, names)
    return None


def _variables(litellm: Any, provider: str, model: str) -> str:
    """Names of the variables that litellm misses."""
    from litellm.llms.openai_like.json_loader import JSONProviderRegistry

    listed = JSONProviderRegistry.get(provider)
    missing = [listed.api_key_env] if listed else litellm.validate_environment(model)["missing_keys"]
    return " and ".join(missing)
