"""Asking a model through litellm, which is imported inside the call only: it takes seconds."""

from collections.abc import Mapping
from typing import Any
from urllib.parse import urlsplit

from pydantic import BaseModel, ConfigDict, Field, SecretStr, model_validator

from proc3s import LLM, Candidate, Completion, LLMError, Price, Request, Usage
from proc3s_litellm import prices
from proc3s_litellm.faults import diagnose
from proc3s_litellm.keys import find_key, hide_key
from proc3s_litellm.loading import introduce, load_litellm
from proc3s_litellm.parameters import split
from proc3s_litellm.providers import PROVIDERS, Provider, server_of
from proc3s_litellm.refusals import Failure
from proc3s_litellm.sentences import Call, explain
from proc3s_litellm.strangers import key_for_call
from proc3s_litellm.wire import marked, plain, takes_marks


class Options(BaseModel):
    """Options of a call. Keys come from the environment of the provider alone (e.g. OPENAI_API_KEY)."""

    model_config = ConfigDict(extra="forbid", frozen=True, hide_input_in_errors=True)

    api_base: str | None = Field(None, description="address of a server that speaks the provider's protocol")
    timeout: float = Field(120.0, gt=0, description="seconds to wait for the answer")

    @model_validator(mode="before")
    @classmethod
    def _plain_address(cls, given: Any) -> Any:
        # Before the fields, so that no message about a field can repeat an address with a password.
        if isinstance(given, Mapping) and isinstance(address := given.get("api_base"), str):
            _check_address(address)
        return given


def _check_address(address: str) -> None:
    parts = urlsplit(address)
    if parts.username or parts.password or "@" in parts.netloc:
        raise ValueError("api_base is logged, so it must not hold a user name or password")
    if parts.scheme not in ("http", "https") or not parts.hostname or parts.query or parts.fragment:
        raise ValueError("api_base must be an address such as http://localhost:11434/v1")


class LiteLLM(LLM):
    """One model; `complete` makes one call and never repeats it.

    Raises LLMError if the key is missing, or the address of a local server.
    """

    def __init__(self, model: str, options: Options) -> None:
        provider, slash, name = model.partition("/")
        if not (provider and slash and name):
            raise LLMError(f"name the provider too: PROVIDER/MODEL, not {model!r}", "unknown_model")
        server = server_of(provider, options.api_base)
        known = PROVIDERS.get(provider, Provider())
        if known.local and not (server or known.address):
            raise LLMError(f"{model}: say where it listens, -L api_base=http://HOST:PORT/v1", "connection")
        key = find_key(model, provider, server)
        self._options = options
        self._call = Call(model, provider, server, options.timeout, key)

    @property
    def price(self) -> Price | None:  # type: ignore[override]
        """From litellm's list, which is imported for it; with a server of one's own a name proves nothing."""
        if self._call.server:
            return None
        try:
            return prices.price(load_litellm(), self._call.model)
        except Exception as error:  # litellm's classes share no base of their own
            raise explain(diagnose(error), self._call) from None

    def complete(self, request: Request) -> Completion:
        """Ask the model once. Raises LLMError with the fault that litellm's exception stands for."""
        try:
            litellm = load_litellm()
            introduce(litellm, self._call.provider, self._call.name)
            access = self._access(key_for_call(litellm, self._call))
            arguments, dropped = split(litellm, self._call.model, request.sampling)
            messages = marked if takes_marks(litellm, self._call.model) else plain
            response = litellm.completion(
                model=self._call.model,
                messages=messages(request.messages),
                **arguments,
                **access,
            )
        except LLMError:
            raise
        except Exception as error:  # litellm's classes share no base of their own
            raise explain(diagnose(error), self._call) from None
        return self._completion(litellm, response, dropped)

    def _access(self, key: SecretStr | None) -> dict[str, Any]:
        """Arguments that say where and as whom; litellm is told not to try again."""
        given: dict[str, Any] = {"timeout": self._options.timeout, "max_retries": 0, "num_retries": 0}
        if key is not None:
            given["api_key"] = key.get_secret_value()
        if self._options.api_base is not None:
            given["api_base"] = self._options.api_base
        return given

    def _completion(self, litellm: Any, response: Any, dropped: tuple[str, ...]) -> Completion:
        candidates = tuple(self._candidate(choice) for choice in getattr(response, "choices", None) or ())
        if not candidates:
            raise explain(Failure("empty"), self._call)
        if not any(c.text for c in candidates) and "content_filter" in {c.finish_reason for c in candidates}:
            raise explain(Failure("filtered"), self._call)
        usage = _usage(getattr(response, "usage", None))
        return Completion(
            candidates=candidates,
            model=self._hidden(response.model or self._call.model).removeprefix(f"{self._call.provider}/"),
            model_asked=self._call.model,
            usage=usage,
            cost=self._cost(litellm, response, usage),
            dropped=dropped,
        )

    def _candidate(self, choice: Any) -> Candidate:
        content = choice.message.content
        text = content if isinstance(content, str) else ""
        return Candidate(text=self._hidden(text), finish_reason=choice.finish_reason)

    def _hidden(self, text: str) -> str:
        """A server that echoes the key in its answer does not get it into any log."""
        return hide_key(text, self._call.key)

    def _cost(self, litellm: Any, response: Any, usage: Usage) -> float | None:
        if self._call.server or usage.prompt_tokens is None:
            return None
        try:
            return prices.cost(litellm, self._call.model, response.usage)
        except Exception:  # an answer that is paid for is worth more than its price
            return None


def _usage(counted: Any) -> Usage:
    """Tokens as the provider counted them; where it says nothing litellm puts zeros."""
    prompt = getattr(counted, "prompt_tokens", None) or None
    if prompt is None:
        return Usage()
    details = getattr(counted, "prompt_tokens_details", None)
    return Usage(
        prompt_tokens=prompt,
        completion_tokens=getattr(counted, "completion_tokens", None),
        cached_tokens=getattr(details, "cached_tokens", None),
    )
