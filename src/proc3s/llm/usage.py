"""What a provider counted of a call."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Count = Annotated[int, Field(ge=0)]


class FrozenData(BaseModel):
    """Plain data that is never changed, and has no field that is unknown."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Usage(FrozenData):
    """Tokens of a call as the provider counted them; None is unknown, never 0."""

    prompt_tokens: Count | None = None
    completion_tokens: Count | None = None
    cached_tokens: Count | None = None
    """Tokens of the prompt that the provider had in its cache."""
