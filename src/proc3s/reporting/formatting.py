"""Samplers and ticks, worded for people."""

import re

from markupsafe import Markup, escape

from proc3s.wording import number

_LONG_NUMBER = re.compile(r"-?\d+(?:\.\d{5,}(?:e[-+]?\d+)?|(?:\.\d+)?e-\d+)")


_LONG_SAMPLER = 72


def sampler(text: str) -> str:
    """How a parameter is sampled, its numbers to four digits and a long list cut."""
    text = _LONG_NUMBER.sub(lambda found: number(float(found[0])), text)
    return text if len(text) <= _LONG_SAMPLER else f"{text[: _LONG_SAMPLER - 1]}…"


def ticks(text: str) -> Markup:
    """A sentence as HTML, what stands in backticks as code, all of it escaped."""
    parts = [escape(part) for part in text.split("`")]
    if len(parts) % 2 == 0:
        return escape(text)
    return Markup("").join(
        Markup("<code>{}</code>").format(part) if i % 2 else part for i, part in enumerate(parts)
    )
