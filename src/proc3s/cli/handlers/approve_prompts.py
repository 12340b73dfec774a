"""Approved renderings: every prompt of every task as a file that a person has read."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import typer

from proc3s.cli.handlers.render_prompt import render, unified_diff
from proc3s.errors import UsageError
from proc3s.planning.options import run_options
from proc3s.plugins.registry import Registry
from proc3s.prompts.text import for_any_python
from proc3s.runs.folder import markdown
from proc3s.specs.domain import DomainSpec
from proc3s.specs.parts import MethodSpec
from proc3s.textfiles import read_text
from proc3s.wording import count


def check(registry: Registry, folder: Path, within: str | None, update: bool, given: dict[str, Any]) -> int:
    """Compare all renderings with the approved files; the number is the exit code.

    One file for every task and prompt template: `domain/task.TEMPLATE.md`. Raises UsageError if a file
    cannot be read or written.
    """
    rendered = dict(_all_renderings(registry, within, given))
    try:
        stale = {name: text for name, text in rendered.items() if not _approved(folder / name, text)}
        orphans = [] if within or "method" in given else list(_orphans(registry, folder, rendered))
        (_approve if update else _report)(folder, stale, orphans)
    except OSError as error:
        raise UsageError(f"{error.filename}: {error.strerror}") from error
    changed = len(stale) + len(orphans)
    typer.echo(f"{count(len(rendered), 'rendering')}, {_verdict(changed, update)}", err=True)
    return 2 if changed and not update else 0


def _approve(folder: Path, stale: Mapping[str, str], orphans: list[Path]) -> None:
    for name, text in stale.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    for path in orphans:
        path.unlink()


def _report(folder: Path, stale: Mapping[str, str], orphans: list[Path]) -> None:
    for name, text in stale.items():
        difference = unified_diff(_read(folder / name) or "", text, f"approved/{name}", f"now/{name}")
        typer.echo("".join(difference), nl=False)
    for path in orphans:
        typer.echo(f"approved, but no longer rendered: {path}")


def _verdict(changed: int, update: bool) -> str:
    if not changed:
        return "all as approved"
    return f"{changed} approved" if update else f"{changed} not as approved; approve them with --update"


def _approved(path: Path, text: str) -> bool:
    """Whether a file says the same, but for the version of Python: that of the machine it was made on."""
    approved = _read(path)
    return approved is not None and for_any_python(approved) == for_any_python(text)


def _read(path: Path) -> str | None:
    try:
        return read_text(path) if path.is_file() else None
    except UnicodeDecodeError as error:
        raise UsageError(f"{path} is no UTF-8 text: {error.reason}") from error


def _orphans(registry: Registry, folder: Path, rendered: Mapping[str, str]) -> Iterator[Path]:
    for domain in registry.all(DomainSpec):
        for path in sorted((folder / domain).glob("*.*.md")):
            if f"{domain}/{path.name}" not in rendered:
                yield path


def _all_renderings(
    registry: Registry, within: str | None, given: dict[str, Any]
) -> Iterator[tuple[str, str]]:
    """Every task of the domain or task `within`, for the first method of every template."""
    if within is not None and "/" in within:
        registry.task(within)
    elif within is not None:
        registry.get(DomainSpec, within)
    methods = {m.template: m.name for m in reversed(registry.all(MethodSpec).values())}
    if "method" in given:
        chosen = registry.get(MethodSpec, given["method"])
        methods = {chosen.template: chosen.name}
    for domain in registry.all(DomainSpec).values():
        for task in domain.tasks.values():
            name = f"{domain.name}/{task.name}"
            if within not in (None, domain.name, name):
                continue
            goal = given.get("goal") or task.instruction or "(your instruction)"
            for template, method in sorted(methods.items()):
                options = run_options(task=name, **{**given, "method": method, "goal": goal})
                yield f"{name}.{template}.md", markdown(render(registry, options, 0, None))
