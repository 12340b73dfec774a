"""Templates of the pages that are generated; they stand beside this file."""

import html
from pathlib import Path
from typing import Any

import jinja2


def render(template: str, **variables: Any) -> str:
    """The text of a generated page."""
    return _environment().get_template(template).render(**variables)


def _environment() -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        autoescape=False,
    )
    environment.filters |= {"cell": cell, "code": code}
    return environment


def cell(text: object) -> str:
    """Text as it may stand in a cell of a Markdown table."""
    return html.escape(" ".join(str(text).split()), quote=False).replace("|", "&#124;")


def code(text: object) -> str:
    """Text as code in a cell."""
    return f"<code>{cell(text)}</code>" if str(text) else ""
