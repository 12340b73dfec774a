"""Failures as sentences: what happened, with which model and server, and what to do."""

from collections.abc import Sequence
from dataclasses import dataclass

from pydantic import SecretStr

from proc3s import LLMError, Usage
from proc3s_litellm.addresses import corrected
from proc3s_litellm.keys import DUMMY, hide_secrets, missing_key
from proc3s_litellm.providers import PROVIDERS, Provider
from proc3s_litellm.refusals import Failure

_MOST_WORDS = 300


@dataclass(frozen=True)
class Call:
    """What was asked: `server` is None if it is the provider's own."""

    model: str
    provider: str
    server: str | None
    timeout: float
    key: SecretStr | None

    @property
    def known(self) -> Provider:
        """What is known of the provider."""
        return PROVIDERS.get(self.provider, Provider())

    @property
    def name(self) -> str:
        """The provider's name for the model."""
        return self.model.partition("/")[2]


def explain(
    failure: Failure, call: Call, usage: Usage | None = None, parameters: Sequence[str] | None = None
) -> LLMError:
    """The error that a person reads; no key in it.

    `usage` is what the provider counted all the same, `parameters` are those that it refuses, if that is it.
    """
    if failure.fault == "missing_key":
        return missing_key(call.model, " or ".join(call.known.keys))
    fault = failure.fault if parameters is None else "parameter"
    what, advice = _sentence(failure, call) if parameters is None else _parameters(parameters)
    status = f"HTTP {failure.status}" if failure.status else ""
    said = ": ".join(part for part in (status, _words(failure, call)) if part)
    where = f"{call.model} at {call.server}" if call.server else call.model
    text = f"{where}: {what}{f' ({said})' if said else ''}{f'; {advice}' if advice else ''}"
    return LLMError(hide_secrets(text, call.key), fault, failure.retry_after, usage, parameters or ())


def _parameters(names: Sequence[str]) -> tuple[str, str]:
    if not names:
        return "a parameter has another name there", ""
    options = " ".join(f"-L {name}=none" for name in names if name != "n")
    return f"the provider refuses {' and '.join(names)}", options and f"{options} leaves it out"


def _words(failure: Failure, call: Call) -> str:
    """The other side's words, cut after secrets are hidden: half a key is a secret too."""
    said = hide_secrets(failure.words, call.key)
    return said if len(said) <= _MOST_WORDS else f"{said[: _MOST_WORDS - 1]}…"


def _sentence(failure: Failure, call: Call) -> tuple[str, str]:
    match failure.fault:
        case "auth":
            return _auth(failure, call)
        case "quota":
            return "the account has nothing left to pay with", "top it up, or choose another --llm"
        case "rate_limit":
            return "too many requests for now", "wait, ask less at once, or choose another --llm"
        case "timeout" if failure.status:
            return "the server ran out of time", "try again later, or choose another --llm"
        case "timeout":
            return f"no answer within {call.timeout:g} s", "raise -L timeout=SECONDS"
        case "connection":
            return _connection(call)
        case "server":
            return "the server failed", "try again later, or choose another --llm"
        case "broken":
            return "what came back is no answer", _base_advice(failure, call) or "try again"
        case "context":
            return "the conversation is too long for the model", "choose one with a larger context"
        case "filtered":
            return "the content filter refused", "change the instruction, or choose another --llm"
        case "unknown_model":
            return _unknown_model(failure, call)
        case _:
            return "the request failed", _base_advice(failure, call)


def _auth(failure: Failure, call: Call) -> tuple[str, str]:
    names = " or ".join(call.known.keys) or "the provider's key"
    if failure.status == 403:
        return "access is refused", f"check {names} and what it may be used for"
    if call.key is DUMMY:
        return "the server asks for a key", f"set {names}"
    return "the key is refused", f"check {names}"


def _connection(call: Call) -> tuple[str, str]:
    if call.provider in ("ollama", "ollama_chat"):
        return "nobody answers", "start the server with `ollama serve`"
    if call.server or call.known.local:
        return "nobody answers", "start the server, or correct -L api_base=ADDRESS"
    return "the provider cannot be reached", "check the network"


def _unknown_model(failure: Failure, call: Call) -> tuple[str, str]:
    if failure.status is None:
        return (
            f"litellm knows no provider {call.provider!r}",
            "name the model PROVIDER/MODEL, or openai/NAME with -L api_base=ADDRESS for a server of your own",
        )
    if call.provider in ("ollama", "ollama_chat"):
        return "the server has no such model", f"fetch it with `ollama pull {call.name}`"
    also = _base_advice(failure, call)
    return "there is no such model", f"check its name{also and f'; {also}'}"


def _base_advice(failure: Failure, call: Call) -> str:
    """A page, or a path that is not there, mostly means that the address has another end."""
    elsewhere = failure.status in (301, 302, 303, 307, 308)
    lost = failure.lost or elsewhere or (failure.status in (404, 405) and "model" not in failure.words)
    if call.server is None or not lost:
        return ""
    meant = corrected(call.server, call.provider)
    return f"is -L api_base={meant} meant?" if meant else "check -L api_base=ADDRESS"
