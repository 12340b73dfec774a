"""What one must know of a provider before litellm is imported: variables of its key, and its server."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from urllib.parse import urlsplit

from proc3s import UsageError
from proc3s_litellm.addresses import fault_of


@dataclass(frozen=True)
class Provider:
    """Access to a provider.

    `keys` are the environment variables that may hold its key, in the order in which litellm reads them;
    `instead` are variables of other ways to sign in, which litellm sees to itself. A `local` provider runs on
    the user's machine and needs no key; `address` is where it listens by default.
    """

    keys: tuple[str, ...] = ()
    instead: tuple[str, ...] = ()
    local: bool = False
    address: str | None = None


def _key(*names: str) -> Provider:
    return Provider(keys=names)


def _local(key: str, address: str | None = None) -> Provider:
    return Provider(keys=(key,), local=True, address=address)


PROVIDERS: Mapping[str, Provider] = {
    "ai21": _key("AI21_API_KEY"),
    "anthropic": Provider(keys=("ANTHROPIC_API_KEY",), instead=("ANTHROPIC_AUTH_TOKEN",)),
    "azure": Provider(
        keys=("AZURE_OPENAI_API_KEY", "AZURE_API_KEY"),
        instead=("AZURE_AD_TOKEN", "AZURE_CLIENT_SECRET", "AZURE_PASSWORD"),
    ),
    "azure_ai": _key("AZURE_AI_API_KEY"),
    "baseten": _key("BASETEN_API_KEY"),
    "cerebras": _key("CEREBRAS_API_KEY"),
    "codestral": _key("CODESTRAL_API_KEY"),
    "cohere": _key("COHERE_API_KEY", "CO_API_KEY"),
    "cohere_chat": _key("COHERE_API_KEY", "CO_API_KEY"),
    "dashscope": _key("DASHSCOPE_API_KEY"),
    "deepinfra": _key("DEEPINFRA_API_KEY"),
    "deepseek": _key("DEEPSEEK_API_KEY"),
    "docker_model_runner": _local("DOCKER_MODEL_RUNNER_API_KEY", "http://localhost:22088/engines/llama.cpp"),
    "fireworks_ai": _key(
        "FIREWORKS_API_KEY", "FIREWORKS_AI_API_KEY", "FIREWORKSAI_API_KEY", "FIREWORKS_AI_TOKEN"
    ),
    "friendliai": _key("FRIENDLIAI_API_KEY", "FRIENDLI_TOKEN"),
    "gemini": _key("GOOGLE_API_KEY", "GEMINI_API_KEY"),
    "github": _key("GITHUB_API_KEY"),
    "groq": _key("GROQ_API_KEY"),
    "hosted_vllm": _local("HOSTED_VLLM_API_KEY"),
    "huggingface": _key("HF_TOKEN", "HUGGINGFACE_API_KEY"),
    "hyperbolic": _key("HYPERBOLIC_API_KEY"),
    "lambda_ai": _key("LAMBDA_API_KEY"),
    "lemonade": _local("LEMONADE_API_KEY", "http://localhost:8000/api/v1"),
    "llamafile": _local("LLAMAFILE_API_KEY", "http://127.0.0.1:8080/v1"),
    "lm_studio": _local("LM_STUDIO_API_KEY"),
    "meta_llama": _key("LLAMA_API_KEY"),
    "minimax": _key("MINIMAX_API_KEY"),
    "mistral": Provider(keys=("MISTRAL_API_KEY",), instead=("MISTRAL_AZURE_API_KEY",)),
    "moonshot": _key("MOONSHOT_API_KEY"),
    "nebius": _key("NEBIUS_API_KEY"),
    "novita": _key("NOVITA_API_KEY"),
    "nscale": _key("NSCALE_API_KEY"),
    "nvidia_nim": _key("NVIDIA_NIM_API_KEY"),
    "ollama": _local("OLLAMA_API_KEY", "http://localhost:11434"),
    "ollama_chat": _local("OLLAMA_API_KEY", "http://localhost:11434"),
    "openai": _key("OPENAI_API_KEY"),
    "openrouter": _key("OPENROUTER_API_KEY", "OR_API_KEY"),
    "ovhcloud": _key("OVHCLOUD_API_KEY"),
    "perplexity": _key("PERPLEXITYAI_API_KEY", "PERPLEXITY_API_KEY"),
    "replicate": _key("REPLICATE_API_KEY", "REPLICATE_API_TOKEN"),
    "sambanova": _key("SAMBANOVA_API_KEY"),
    "together_ai": _key("TOGETHER_API_KEY", "TOGETHER_AI_API_KEY", "TOGETHERAI_API_KEY", "TOGETHER_AI_TOKEN"),
    "vercel_ai_gateway": _key("VERCEL_AI_GATEWAY_API_KEY"),
    "volcengine": _key("VOLCENGINE_API_KEY"),
    "xai": _key("XAI_API_KEY"),
    "zai": _key("ZAI_API_KEY"),
}

SIGNED_IN = frozenset(
    {"bedrock", "chatgpt", "databricks", "github_copilot", "oci", "sagemaker", "sagemaker_chat", "sap"}
    | {"snowflake", "vertex_ai", "vertex_ai_beta", "watsonx", "watsonx_text"}
)
"""Providers whose own tools and files say who asks: there is no key to look for."""

_OWN_ADDRESS_NEEDED = frozenset({"azure", "azure_ai"})


def provider_of(model: str) -> str:
    """`PROVIDER/MODEL` -> PROVIDER."""
    return model.partition("/")[0]


def server_of(provider: str, api_base: str | None) -> str | None:
    """The address of a server that stands in for the provider's own: the option's, or a variable's.

    None where there is none. It holds no user name or password. Raises UsageError that names a variable
    which holds no address.
    """
    for name in _bases(provider) if api_base is None else ():
        if given := os.environ.get(name):
            address = _anonymous(given)
            if wrong := fault_of(address):
                raise UsageError(f"the environment variable {name} {wrong}")
            if provider not in _OWN_ADDRESS_NEEDED:
                return address
    return None if api_base is None else _anonymous(api_base)


def _bases(provider: str) -> list[str]:
    """Variables from which litellm takes a server's address, e.g. OPENAI_BASE_URL."""
    keys = PROVIDERS[provider].keys if provider in PROVIDERS else ()
    stems = {key.removesuffix("_API_KEY") for key in keys} | {provider.upper()}
    second = [f"{provider.upper()}_BASE_URL"] if provider in ("openai", "anthropic") else []
    return [*second, *(f"{stem}_API_BASE" for stem in sorted(stems))]


def _anonymous(address: str) -> str:
    """Without what must not be shown; as it is if it is no address, of which `fault_of` shows nothing."""
    try:
        parts = urlsplit(address)
    except ValueError:
        return address
    if not address.isprintable():  # `urlsplit` has dropped what is wrong with it
        return address
    return parts._replace(netloc=parts.netloc.rpartition("@")[2], query="", fragment="").geturl()
