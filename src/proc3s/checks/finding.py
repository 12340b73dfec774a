"""Findings: what a check of an installation or a plugin has to say."""

from typing import Literal

from pydantic import BaseModel, ConfigDict


class Finding(BaseModel):
    """One result of a check: fine, worth knowing, or wrong; `advice` says how to fix it."""

    model_config = ConfigDict(frozen=True)

    level: Literal["ok", "note", "error"]
    subject: str
    """The subject of the check, in a word or two."""
    text: str
    advice: str = ""
