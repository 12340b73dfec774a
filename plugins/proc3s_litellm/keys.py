"""Keys: found in the environment, kept out of every text."""

import os

from pydantic import SecretStr

from proc3s import LLMError, redacted
from proc3s_litellm.providers import PROVIDERS, Provider

DUMMY = SecretStr("none")
"""What a server is given that asks for no key, because the client insists on one."""

_SHORTEST = 8
"""No key is shorter; hiding shorter values would garble ordinary words."""


def find_key(model: str, provider: str, server: str | None) -> SecretStr | None:
    """The key for a model; None where litellm signs in by itself, or nothing is known of the provider.

    Raises LLMError ("missing_key") that names the variable, and ("auth") for a key that cannot be one.
    """
    known = PROVIDERS.get(provider)
    if known is None:
        return None
    for name in known.keys:
        if value := os.environ.get(name, "").strip():
            _check(name, value)
            return SecretStr(value)
    if any(os.environ.get(name) for name in known.instead):
        return None
    if known.local or server:
        return DUMMY
    raise missing_key(model, " or ".join(known.keys))


def missing_key(model: str, variables: str) -> LLMError:
    """The error that says which variables to set."""
    wanted = f"set {variables}" if variables else "set the provider's variable, or sign in with its own tools"
    return LLMError(
        f"{model} needs a key: {wanted}, or choose another --llm (replay needs none)", "missing_key"
    )


def keys_set(provider: Provider) -> list[str]:
    """The variables of a provider that are set; names only."""
    return [name for name in (*provider.keys, *provider.instead) if os.environ.get(name, "").strip()]


def hide_key(text: str, key: SecretStr | None) -> str:
    """The text with `***` for the key."""
    value = key.get_secret_value() if key else ""
    return text.replace(value, "***") if len(value) >= _SHORTEST else text


def hide_secrets(text: str, key: SecretStr | None) -> str:
    """The same, and for every secret in the environment."""
    return redacted(hide_key(text, key))


def _check(name: str, value: str) -> None:
    """Refuse a key that is not ASCII: the HTTP header would fail with the key in its message."""
    if not (value.isascii() and value.isprintable()):
        raise LLMError(f"{name} holds characters that no key has; set it anew", "auth")
