"""The page of what a template of a prompt gets: variables, filters, and what diagnoses are made of."""

import inspect
import re
from collections.abc import Iterator, Sequence
from typing import Any

import models
import names
from words import cell, render

from proc3s.feedback.report import Diagnosis
from proc3s.prompts.variables import FILTERS, FeedbackVariables, SharedVariables, TaskVariables
from proc3s.specs.domain import DomainSpec

_GROUPS = {
    "Every template": SharedVariables,
    "partials/task.j2": TaskVariables,
    "feedback.j2": FeedbackVariables,
}


def page(registered: Sequence[dict[str, Any]]) -> str:
    """Markdown; `registered` are the tables of the page of hooks, to which types lead."""
    parts = models.tables(Diagnosis)
    places = {spec["name"]: "hooks.md" for spec in registered}
    places |= {spec["name"]: "domain-yaml.md" for spec in models.tables(DomainSpec)}
    places |= {spec["name"]: "" for spec in parts}
    groups = [
        {"name": name, "says": inspect.getdoc(cls), "fields": list(_variables(cls, places))}
        for name, cls in _GROUPS.items()
    ]
    filters = [
        {"name": name, "signature": names.signature(f), "doc": inspect.getdoc(f)}
        for name, f in FILTERS.items()
    ]
    return render("prompt_templates.md.j2", groups=groups, filters=filters, specs=parts)


def _variables(cls: type, places: dict[str, str]) -> Iterator[dict[str, str]]:
    for field in names.fields(cls):
        yield {"name": field["name"], "type": _linked(field["type"], places), "says": field["says"]}


def _linked(kind: str, places: dict[str, str]) -> str:
    """A type whose spec, if it has a table, is a link to it."""
    found = re.search(r"\w+", kind.replace("tuple[", "").replace(", ...]", ""))
    name = found[0] if found else ""
    text = f"[{name}]({places[name]}#{name.lower()})" if name in places else cell(name)
    return f"list of {text}" if kind.startswith("tuple") else text
