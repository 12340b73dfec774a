"""Asking a model through litellm, which is imported inside the call only: it takes seconds."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, SecretStr, model_validator

from proc3s import LLM, Candidate, Completion, LLMError, Price, Request, Usage
from proc3s_litellm import prices
from proc3s_litellm.addresses import fault_of
from proc3s_litellm.answers import candidate, counted, error_in, finishes, model_in, readable, tokens
from proc3s_litellm.exchange import Exchange
from proc3s_litellm.faults import diagnose, sent_as_success
from proc3s_litellm.keys import find_key, hide_key
from proc3s_litellm.loading import introduce, load_litellm
from proc3s_litellm.parameters import refused, renamed, split
from proc3s_litellm.providers import PROVIDERS, Provider, server_of
from proc3s_litellm.sentences import Call, explain
from proc3s_litellm.strangers import key_for_call
from proc3s_litellm.wire import marked, plain, takes_marks

_NOTHING = Usage(prompt_tokens=0, completion_tokens=0)


class Options(BaseModel):
    """Options of a call. Keys come from the environment of the provider alone (e.g. OPENAI_API_KEY)."""

    model_config = ConfigDict(extra="forbid", frozen=True, hide_input_in_errors=True)

    api_base: str | None = Field(None, description="address of a server that speaks the provider's protocol")
    timeout: float = Field(
        120.0,
        gt=0,
        le=86_400,
        description="seconds that a call may take, to the end of its answer",
    )

    @model_validator(mode="before")
    @classmethod
    def _plain_address(cls, given: Any) -> Any:
        # Before the fields, so that no message about a field can repeat an address with a password.
        address = given.get("api_base") if isinstance(given, Mapping) else None
        if isinstance(address, str) and (wrong := fault_of(address)):
            raise ValueError(f"api_base {wrong}")
        return given


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
        self._spelling: dict[str, str] = {}

    @property
    def price(self) -> Price | None:  # type: ignore[override]
        """From litellm's list, which is imported for it; with a server of one's own a name proves nothing."""
        if self._call.server:
            return None
        try:
            return prices.price(load_litellm(), self._call.model)
        except Exception as error:  # litellm's classes share no base of their own
            raise explain(diagnose(error), self._call) from None

    def prepare(self) -> None:
        """Import litellm, which takes seconds, and see whether it knows the provider and has a key for it."""
        try:
            key_for_call(litellm := load_litellm(), self._call)
            litellm.get_llm_provider(self._call.model)
        except LLMError:
            raise
        except Exception as error:  # an installation that is broken, in whichever way
            raise explain(diagnose(error), self._call) from None

    def complete(self, request: Request) -> Completion:
        """Ask the model once. Raises LLMError with the fault that litellm's exception stands for."""
        exchange, arguments = Exchange(), dict[str, Any]()
        try:
            litellm = load_litellm()
            introduce(litellm, self._call.provider, self._call.name)
            access = self._access(key_for_call(litellm, self._call))
            arguments, dropped = split(litellm, self._call.model, request.sampling)
            messages = marked if takes_marks(litellm, self._call.model) else plain
            call = partial(
                litellm.completion,
                model=self._call.model,
                messages=messages(request.messages),
                logger_fn=exchange.listen,
                **{self._spelling.get(name, name): value for name, value in arguments.items()},
                **access,
            )
            response = exchange.run(call, self._options.timeout)
        except LLMError:
            raise
        except Exception as error:  # litellm's classes share no base of their own
            if candidates := readable(exchange.body):
                return self._completion(candidates, exchange, dropped)
            raise self._explained(error, exchange, arguments) from None
        choices = getattr(response, "choices", None) or ()
        ends = finishes(exchange.body, [choice.finish_reason for choice in choices])
        candidates = tuple(candidate(_fields(c.message), end) for c, end in zip(choices, ends, strict=True))
        cost = self._cost(litellm, response)
        answer = self._completion(candidates, exchange, dropped)
        usage = _usage(response, silent=not any(c.text for c in candidates))
        return answer.model_copy(update={"model": self._named(response.model), "usage": usage, "cost": cost})

    def _explained(self, error: Exception, exchange: Exchange, arguments: Mapping[str, Any]) -> LLMError:
        failure = diagnose(error)
        if exchange.body and error_in(exchange.body):
            failure = sent_as_success(exchange.body) or failure
        refusal = failure.status is not None and 400 <= failure.status < 500 and failure.fault != "filtered"
        usage = counted(exchange.body) or (_NOTHING if refusal else None)
        if "max_tokens" in arguments and "max_tokens" not in self._spelling and renamed(failure):
            self._spelling["max_tokens"] = "max_completion_tokens"
            return explain(failure, self._call, usage, ())
        return explain(failure, self._call, usage, refused(failure, arguments) or None)

    def _access(self, key: SecretStr | None) -> dict[str, Any]:
        """Arguments that say where and as whom; litellm is told not to try again."""
        given: dict[str, Any] = {"timeout": self._options.timeout, "max_retries": 0, "num_retries": 0}
        if key is not None:
            given["api_key"] = key.get_secret_value()
        if self._options.api_base is not None:
            given["api_base"] = self._options.api_base
        return given

    def _completion(
        self, candidates: Sequence[Candidate], exchange: Exchange, dropped: tuple[str, ...]
    ) -> Completion:
        """What came over the wire; figures as far as its body has them."""
        return Completion(
            candidates=tuple(
                c.model_copy(
                    update={"text": self._hidden(c.text), "refusal": c.refusal and self._hidden(c.refusal)}
                )
                for c in candidates
            ),
            model=self._named(model_in(exchange.body)),
            model_asked=self._call.model,
            usage=counted(exchange.body) or Usage(),
            latency=exchange.seconds,
            dropped=dropped,
        )

    def _named(self, model: Any) -> str:
        """A model as it calls itself, else as it was asked for."""
        name = model if isinstance(model, str) and model else self._call.model
        return self._hidden(name).removeprefix(f"{self._call.provider}/")

    def _hidden(self, text: str) -> str:
        """A server that echoes the key in its answer does not get it into any log."""
        return hide_key(text, self._call.key)

    def _cost(self, litellm: Any, response: Any) -> float | None:
        if self._call.server or _usage(response).prompt_tokens is None:
            return None
        try:
            return prices.cost(litellm, self._call.model, response.usage)
        except Exception:  # an answer that is paid for is worth more than its price
            return None


def _fields(message: Any) -> dict[str, Any]:
    """What litellm's message says, refusals that it keeps apart included."""
    names = ("content", "refusal", "tool_calls", "function_call")
    apart = getattr(message, "provider_specific_fields", None) or {}
    return {name: getattr(message, name, None) or apart.get(name) for name in names}


def _usage(response: Any, silent: bool = True) -> Usage:
    """Tokens as the provider counted them; where it says nothing litellm puts zeros.

    Only a `silent` answer may have none.
    """
    counted = getattr(response, "usage", None)
    prompt = tokens(getattr(counted, "prompt_tokens", None)) or None
    if prompt is None:
        return Usage()
    completion = tokens(getattr(counted, "completion_tokens", None))
    details = getattr(counted, "prompt_tokens_details", None)
    return Usage(
        prompt_tokens=prompt,
        completion_tokens=completion if completion or silent else None,
        cached_tokens=tokens(getattr(details, "cached_tokens", None)),
    )
