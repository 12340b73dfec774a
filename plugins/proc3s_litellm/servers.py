"""A server of one's own: whether it answers, at which address, with which models and how long a context."""

import json
import urllib.error
import urllib.request
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from proc3s import Finding
from proc3s_litellm.addresses import corrected
from proc3s_litellm.exchange import within

_SECONDS = 2.0
_LONGEST = 1_000_000
"""Bytes of a list of models that are read."""
_ENOUGH = 8000
"""Tokens of context that the prompts of a run may need."""
_LISTS = {"ollama": "/api/tags", "ollama_chat": "/api/tags", "anthropic": "/v1/models"}
_LENGTHS = ("max_model_len", "n_ctx", "loaded_context_length", "context_length", "context_window")
"""What servers call the longest conversation that they take, in their lists of models."""


@dataclass(frozen=True)
class _Look:
    """What came back: why nobody answers; else the status, and the models if it was a list of them."""

    problem: str | None = None
    status: int = 0
    models: tuple[Mapping[str, Any], ...] | None = None


def server_findings(address: str, provider: str, model: str) -> Iterator[Finding]:
    """Findings on a server; no key is sent to it, and no model is asked."""
    look, meant = _look(address, provider), corrected(address, provider)
    if look.problem is not None:
        yield _unreachable(address, provider, look.problem)
    elif look.models is not None and meant is None:
        yield _finding("ok", f"{address} answers")
        yield from _context(look.models, model)
    elif meant is None:
        yield _finding("ok", f"{address} answers (HTTP {look.status}, no list of models)")
    elif _look(meant, provider).models is not None:
        yield _finding("error", f"{address} is not the address: {meant} is", f"-L api_base={meant}")
    elif look.models is not None or look.status in (401, 403):
        yield _finding("note", f"{address} answers, but is of an unusual form", f"is {meant} meant?")
    else:
        text = f"{address} answers, but has no list of models (HTTP {look.status})"
        yield _finding("error", text, f"-L api_base={meant} is the usual form")


def _finding(level: str, text: str, advice: str = "") -> Finding:
    return Finding.model_validate({"level": level, "subject": "server", "text": text, "advice": advice})


def _unreachable(address: str, provider: str, problem: str) -> Finding:
    start = "`ollama serve`" if provider.startswith("ollama") else "it"
    advice = f"start {start}, or correct -L api_base=ADDRESS"
    return _finding("error", f"{address} does not answer: {problem}", advice)


def _context(models: tuple[Mapping[str, Any], ...], model: str) -> Iterator[Finding]:
    """A note if the server says that it takes less than a long prompt: some cut without a word."""
    lengths = [length for entry in models if _name(entry) == model for length in _lengths(entry)]
    if lengths and min(lengths) < _ENOUGH:
        text = f"{model} takes {min(lengths):,} tokens; what is longer may be cut without a word"
        yield _finding("note", text, f"give it a context of {_ENOUGH:,} tokens or more")


def _lengths(entry: Mapping[str, Any]) -> Iterator[int]:
    inner = entry.get("meta")
    for part in (entry, inner if isinstance(inner, Mapping) else {}):
        yield from (part[name] for name in _LENGTHS if isinstance(part.get(name), int))


def _name(entry: Mapping[str, Any]) -> Any:
    return entry.get("id") or entry.get("name")


def _look(address: str, provider: str) -> _Look:
    """Look its models up; any HTTP answer will do to show that somebody is there."""
    url = address.rstrip("/") + _LISTS.get(provider, "/models")
    try:
        return within(_SECONDS, partial(_get, url))
    except TimeoutError:
        return _Look(f"no answer within {_SECONDS:g} s")


def _get(url: str) -> _Look:
    try:
        with urllib.request.build_opener(_Stay()).open(url, timeout=_SECONDS) as answer:
            return _Look(status=answer.status, models=_models(answer.read(_LONGEST)))
    except urllib.error.HTTPError as error:
        return _Look(status=error.code)
    except urllib.error.URLError as error:
        return _Look(getattr(error.reason, "strerror", None) or str(error.reason))
    except Exception as error:  # http.client has errors of many kinds, of which a person needs the words
        return _Look(str(error) or type(error).__name__)


def _models(body: bytes) -> tuple[Mapping[str, Any], ...] | None:
    try:
        data = json.loads(body)
    except (ValueError, RecursionError):
        return None
    if isinstance(data, dict):
        data = next((data[name] for name in ("data", "models") if name in data), None)
    return tuple(m for m in data if isinstance(m, dict)) if isinstance(data, list) else None


class _Stay(urllib.request.HTTPRedirectHandler):
    """A redirect is an answer too."""

    def redirect_request(self, *_: object, **__: object) -> None:
        return None
