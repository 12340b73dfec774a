"""Asking a model through litellm, which is imported inside the call only: it takes seconds."""

import os
from typing import Any
from urllib.parse import urlsplit

from pydantic import BaseModel, ConfigDict, Field, field_validator

from proc3s import Completion, LLMError, Request


class Options(BaseModel):
    """Options of a call. Keys come from the environment of the provider alone (e.g. OPENAI_API_KEY)."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    api_base: str | None = Field(None, description="address of a server that speaks the provider's protocol")
    temperature: float | None = Field(0.0, description="sampling temperature")
    max_tokens: int | None = Field(None, ge=1, description="longest answer")
    timeout: float = Field(120.0, gt=0, description="seconds to wait for the answer")

    @field_validator("api_base")
    @classmethod
    def _no_password(cls, address: str | None) -> str | None:
        if address and urlsplit(address).username:
            raise ValueError("an address is logged, so it must not hold a user name or password")
        return address


class LiteLLM:
    """One model; `complete` makes one call. Raises LLMError with the provider's reason."""

    def __init__(self, model: str, options: Options) -> None:
        self._model = model
        self._options = options

    def complete(self, request: Request) -> Completion:
        """Ask the model for one answer."""
        litellm = _import_litellm()
        options = self._options.model_dump(exclude_none=True)
        if "api_base" in options and not os.environ.get("OPENAI_API_KEY"):
            options["api_key"] = "none"  # a local server asks for no key, but the client insists on one
        messages = [{"role": m.role, "content": m.text} for m in request.messages]
        try:
            response = litellm.completion(
                model=self._model,
                messages=messages,
                num_retries=0,
                max_retries=0,
                drop_params=True,
                **options,
            )
        except Exception as error:  # litellm's classes share no base of their own
            raise LLMError(f"{self._model}: {_one_line(error)}") from error
        return self._completion(response)

    def _completion(self, response: Any) -> Completion:
        choices = getattr(response, "choices", None)
        text = choices[0].message.content if choices else None
        if not text:
            raise LLMError(f"{self._model}: the answer is empty; ask again or choose another --llm")
        if choices[0].finish_reason == "length":
            raise LLMError(f"{self._model}: the answer was cut off; raise -L max_tokens=N")
        usage = getattr(response, "usage", None)
        return Completion(
            text=text,
            source="live",
            model=getattr(response, "model", None) or self._model,
            finish_reason=choices[0].finish_reason,
            prompt_tokens=getattr(usage, "prompt_tokens", None),
            completion_tokens=getattr(usage, "completion_tokens", None),
        )


def _import_litellm() -> Any:
    # Without these litellm fetches a price list from the network and loads a `.env` file.
    os.environ.setdefault("LITELLM_LOCAL_MODEL_COST_MAP", "True")
    os.environ.setdefault("LITELLM_MODE", "PRODUCTION")
    import litellm

    litellm.suppress_debug_info = True
    return litellm


def _one_line(error: Exception) -> str:
    text = " ".join(str(error).split())
    return text if len(text) <= 500 else f"{text[:500]}…"
