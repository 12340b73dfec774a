"""Templates of reports: those of `explain` and `report`, found and rendered as those of prompts are."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import jinja2
from jinja2.sandbox import ImmutableSandboxedEnvironment

from proc3s.errors import Issue, SpecError, UsageError
from proc3s.feedback.shares import portion
from proc3s.reporting.formatting import sampler, ticks
from proc3s.wording import number, plain


class ReportTemplates:
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
