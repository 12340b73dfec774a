"""Importing litellm, which takes seconds and talks unless it is told not to."""

import logging
import os
import warnings
from typing import Any

from proc3s import platform_name

_QUIET = {
    # Each of these keeps it from fetching a list from the network.
    "LITELLM_LOCAL_MODEL_COST_MAP": "True",
    "LITELLM_LOCAL_ANTHROPIC_BETA_HEADERS": "True",
    # Otherwise it loads a `.env` file of the working directory.
    "LITELLM_MODE": "PRODUCTION",
}
_LOGGERS = ("LiteLLM", "LiteLLM Proxy", "LiteLLM Router")


def load_litellm() -> Any:
    """The module, silent: it prints nothing, logs nothing, and asks nobody on its own account."""
    os.environ.update(_QUIET)
    for name in _LOGGERS:
        logging.getLogger(name).disabled = True
    platform_name()  # The SDK of OpenAI will ask for it.
    import litellm

    litellm.suppress_debug_info = True
    # Bodies of the wrong shape make its own models warn; they become an error here anyway.
    warnings.filterwarnings("ignore", message="Pydantic serializer warnings")
    return litellm


def introduce(litellm: Any, provider: str, name: str) -> None:
    """Put a model of Ollama into litellm's list; of one that it does not find there it asks the server.

    It does so several times a call, and not always the server that was named.
    """
    if provider in ("ollama", "ollama_chat"):
        litellm.model_cost.setdefault(f"ollama/{name}", {"litellm_provider": "ollama", "mode": "chat"})
