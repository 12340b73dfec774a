"""Templates of reports: those of `explain` and `report`, found and rendered as those of prompts are."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import jinja2
from jinja2.sandbox import ImmutableSandboxedEnvironment
from markupsafe import Markup, escape

from proc3s.errors import Issue, SpecError, UsageError
from proc3s.registry import Registry
from proc3s.shares import portion
from proc3s.specs import TemplatesSpec
from proc3s.wording import plain


def folders_of(registry: Registry) -> tuple[Path, ...]:
    """Template folders, of the plugin that loaded last first."""
    return tuple(spec.folder for spec in reversed(registry.all(TemplatesSpec).values()))


class Words:
    """Renders report templates; with `html` every value is escaped for HTML.

    Raises UsageError for a template that is missing, SpecError for one that does not render.
    """

    def __init__(self, folders: Sequence[Path], html: bool = False) -> None:
        self._environment = ImmutableSandboxedEnvironment(
            loader=jinja2.FileSystemLoader(folders, encoding="utf-8-sig"),
            undefined=jinja2.StrictUndefined,
            trim_blocks=True,
            lstrip_blocks=True,
            autoescape=html,
        )
        self._environment.filters |= {
            "number": number,
            "plain": plain,
            "portion": portion,
            "sampler": sampler,
            "ticks": ticks,
        }

    def render(self, name: str, /, **variables: Any) -> str:
        """The text of a template."""
        try:
            return self._environment.get_template(name).render(**variables)
        except jinja2.TemplateNotFound as error:
            raise UsageError(f"there is no template {name!r}") from error
        except jinja2.TemplateSyntaxError as error:
            raise SpecError([Issue(f"{error.filename}:{error.lineno}", "", str(error.message))]) from error
        except (jinja2.TemplateError, TypeError, ValueError) as error:
            raise SpecError([Issue(name, "", str(error))]) from error


_LONG_NUMBER = re.compile(r"-?\d+(?:\.\d{5,}(?:e[-+]?\d+)?|(?:\.\d+)?e-\d+)")
_LONG_SAMPLER = 72
_DECIMALS = 9
"""What a program's arithmetic leaves of a zero reads as zero."""


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


def number(value: Any) -> str:
    """A number to four digits and nine decimals, also within a pose; anything else as it is."""
    if isinstance(value, list | tuple):
        return f"({', '.join(map(number, value))})"
    return plain(round(value, _DECIMALS), 4) if isinstance(value, float) else str(value)
