"""Which files prompts are rendered from: the templates that are asked for, and those that these name."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import jinja2
from jinja2 import meta

from proc3s.specs.parts import MethodSpec

TASK = "partials/task.j2"
FEEDBACK = "feedback.j2"


def method_template(method: MethodSpec) -> str:
    """The template of what a method tells the LLM first."""
    return f"methods/{method.template}.j2"


@dataclass(frozen=True)
class TemplateFiles:
    """Templates by name; `computed` if one names others only while it is rendered."""

    files: Mapping[str, Path]
    computed: bool


def template_files(folders: Sequence[Path], methods: Iterable[MethodSpec]) -> TemplateFiles:
    """The files that prompts of these methods are rendered from, with folders searched in order.

    Templates that do not exist are left out, and one that is no Jinja names no others.
    """
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(folders, encoding="utf-8-sig"))
    waiting = [*map(method_template, methods), TASK, FEEDBACK]
    files: dict[str, Path] = {}
    computed = False
    for name in waiting:  # it grows while it is read
        file = next((folder / name for folder in folders if (folder / name).is_file()), None)
        if file is None or name in files:
            continue
        files[name] = file
        named = _named(environment, name)
        computed |= None in named
        waiting += [other for other in named if other is not None]
    return TemplateFiles(files, computed)


def _named(environment: jinja2.Environment, name: str) -> list[str | None]:
    """What a template includes, imports or extends; None for a name that is computed."""
    try:
        assert environment.loader is not None
        source, _, _ = environment.loader.get_source(environment, name)
        return list(meta.find_referenced_templates(environment.parse(source)))
    except (jinja2.TemplateError, UnicodeDecodeError):  # rendering tells, with the line
        return []
