"""What can be said of the installation and the keys without importing litellm or spending a token."""

import re
from collections.abc import Iterator
from importlib import metadata

from proc3s import Finding, UsageError
from proc3s_litellm.backend import Options
from proc3s_litellm.keys import keys_set
from proc3s_litellm.providers import PROVIDERS, SIGNED_IN, Provider, provider_of, server_of
from proc3s_litellm.servers import server_findings

_MALICIOUS = frozenset({"1.82.7", "1.82.8"})
_LOWEST, _BELOW = (1, 106, 2), (1, 110)
_WANTED = "pip install 'litellm>=1.106.2,<1.110'"


def check(model: str | None, options: Options | None) -> Iterator[Finding]:
    """Findings on the installed version, the keys that are set, and the chosen model's key and server."""
    yield _version()
    yield _keys()
    if model is None:
        return
    provider = provider_of(model)
    try:
        server = server_of(provider, options.api_base if options else None)
    except UsageError as error:
        yield Finding(level="error", subject="server", text=str(error), advice="correct it, or unset it")
        return
    yield _key_of(provider, server)
    known = PROVIDERS.get(provider, Provider())
    if address := server or known.address:
        yield from server_findings(address, provider, model.partition("/")[2])


def _version() -> Finding:
    try:
        version = metadata.version("litellm")
    except metadata.PackageNotFoundError:
        return _litellm("error", "is not installed", _WANTED)
    if version in _MALICIOUS:
        advice = f"uninstall it now, change every key that this machine has seen, then {_WANTED}"
        return _litellm("error", f"{version} is a malicious release that steals keys", advice)
    if not _LOWEST <= _numbers(version) < _BELOW:
        return _litellm("error", f"{version} is not a version that proc3s knows", _WANTED)
    return _litellm("ok", version)


def _litellm(level: str, text: str, advice: str = "") -> Finding:
    return Finding.model_validate({"level": level, "subject": "litellm", "text": text, "advice": advice})


def _numbers(version: str) -> tuple[int, ...]:
    return tuple(int(part) for part in re.findall(r"\d+", version)[:3])


def _keys() -> Finding:
    names = sorted({name for provider in PROVIDERS.values() for name in keys_set(provider)})
    return Finding(
        level="note", subject="keys", text=f"set: {', '.join(names)}" if names else "none is set that we know"
    )


def _key_of(provider: str, server: str | None) -> Finding:
    known = PROVIDERS.get(provider)
    if known is None:
        how = "signs in with its own tools" if provider in SIGNED_IN else "is unknown here; litellm decides"
        return Finding(level="note", subject=provider, text=f"{provider} {how}")
    if names := keys_set(known):
        return Finding(level="ok", subject=provider, text=f"{names[0]} is set")
    if known.local or server:
        return Finding(level="ok", subject=provider, text="no key is set; a server of one's own needs none")
    return Finding(
        level="error",
        subject=provider,
        text="its key is missing",
        advice=f"set {' or '.join(known.keys)} in the environment",
    )
