"""Addresses of servers: what is wrong with one, and which one is most likely meant."""

from urllib.parse import urlsplit

_REQUESTS = (
    "/chat/completions",
    "/completions",
    "/responses",
    "/messages",
    "/models",
    "/api/chat",
    "/api/tags",
)
"""Ends of addresses that are those of a request, not of the server."""
_AT_ROOT = frozenset({"anthropic", "ollama", "ollama_chat"})
"""Providers whose client adds the whole path itself."""
_AT_V1 = frozenset({"openai", "lm_studio", "hosted_vllm", "llamafile"})
_PORT = "has a port that is none: a port is a number from 1 to 65535"
_EXAMPLE = "must be an address such as http://localhost:11434/v1"


def fault_of(address: str) -> str | None:
    """What is wrong with an address, in words that follow its name and never repeat it; None if nothing is.

    It may hold no user name or password: addresses are logged.
    """
    if not address.isprintable() or " " in address:
        return "holds a space or another character that no address has"
    try:
        parts = urlsplit(address)
        port = parts.port
    except ValueError as error:
        return _PORT if str(error).startswith("Port") else _EXAMPLE
    if parts.username or parts.password or "@" in parts.netloc:
        return "is logged, so it must not hold a user name or password"
    if parts.scheme not in ("http", "https") or not parts.hostname or parts.query or parts.fragment:
        return _EXAMPLE
    return _PORT if port == 0 else None


def corrected(address: str, provider: str) -> str | None:
    """The address that is meant by one of an unusual form; None if its form is the usual one."""
    bare = address.rstrip("/")
    for end in _REQUESTS:
        bare = bare.removesuffix(end).rstrip("/")
    if provider in _AT_ROOT:
        bare = bare.removesuffix("/v1").removesuffix("/api")
    elif provider in _AT_V1 and not urlsplit(bare).path:
        bare += "/v1"
    return bare if bare != address.rstrip("/") else None
