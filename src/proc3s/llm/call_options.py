"""Options of a call that every backend takes."""

from typing import Any

from pydantic import BaseModel, ConfigDict, Field, field_validator, model_validator

from proc3s.llm.types import Effort, Price, Sampling

_PATIENCE = 60.0


_VARIED = 0.7
"""Temperature for several candidates: at 0 they would all be the same."""


class CallOptions(BaseModel):
    """Options that every LLM takes."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    temperature: float | None = Field(
        None,
        ge=0,
        le=2,
        description=f"sampling temperature; by default 0, or {_VARIED} for several candidates; "
        "`none` leaves it out",
    )
    seed: int | None = Field(
        None, description="the provider's seed; by default the run's; `none` leaves it out"
    )
    max_tokens: int | None = Field(None, ge=1, description="longest answer; by default the provider's")
    reasoning_effort: Effort | None = Field(None, description="how long the model thinks, where it can")
    patience: float = Field(
        _PATIENCE, ge=0, le=_PATIENCE, description="seconds in which failed calls are repeated"
    )
    prompt_price: float | None = Field(
        None, ge=0, allow_inf_nan=False, description="US dollars for a million tokens of prompt"
    )
    completion_price: float | None = Field(
        None, ge=0, allow_inf_nan=False, description="US dollars for a million tokens of answer"
    )

    @field_validator("temperature", "seed", "max_tokens", mode="before")
    @classmethod
    def _left_out(cls, given: Any) -> Any:
        return None if given == "none" else given

    @model_validator(mode="after")
    def _whole_price(self) -> "CallOptions":
        if (self.prompt_price is None) != (self.completion_price is None):
            raise ValueError("prompt_price and completion_price go together")
        return self

    @property
    def price(self) -> Price | None:
        """The declared price, if both parts are given."""
        if self.prompt_price is None or self.completion_price is None:
            return None
        return Price(prompt=self.prompt_price, completion=self.completion_price)

    def sampling(self, seed: int, candidates: int) -> Sampling:
        """How the answers of a round are drawn; what was set to None is left to the provider."""
        usual = {"temperature": 0.0 if candidates == 1 else _VARIED, "seed": seed}
        given = {name: getattr(self, name) for name in self.model_fields_set if name in Sampling.model_fields}
        return Sampling.model_validate({"n": candidates, **usual, **given})
