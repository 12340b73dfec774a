"""Approved renderings: every prompt of every task as a file that a person has read."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import typer

from proc3s.cli.handlers.render_prompt import unified_diff
from proc3s.errors import UsageError
from proc3s.planning.options import RunOptions, run_options
from proc3s.planning.setup import first_messages
from proc3s.planning.typical_feedback import typical_feedback
from proc3s.plugins.registry import Registry
from proc3s.prompts.text import for_any_python
from proc3s.runs.folder import markdown
from proc3s.specs.domain import DomainSpec, TaskSpec
from proc3s.specs.parts import MethodSpec
from proc3s.textfiles import read_text
from proc3s.wording import count

_FEEDBACK = "feedback"
"""The folder within that of a domain: no task's file, whatever the task is called."""


def check(registry: Registry, folder: Path, within: str | None, update: bool, given: dict[str, Any]) -> int:
    """Compare all renderings with the approved files; the number is the exit code.

    One file for every task and prompt template: `domain/task.TEMPLATE.md`; and one for every domain and
    template with the feedback on typical failures: `domain/feedback/TEMPLATE.md`. Raises UsageError if a
    file cannot be read or written.
    """
    rendered = dict(_all_renderings(registry, within, given))
    if not update and not folder.is_dir():
        raise UsageError(f"there is no folder {folder}; --update makes it, and approves what is rendered now")
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
        difference = unified_diff(_read(folder / name) or "", text, str(folder / name), f"now/{name}")
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
        found = [*(folder / domain).glob("*.*.md"), *(folder / domain / _FEEDBACK).glob("*.md")]
        yield from (p for p in sorted(found) if p.relative_to(folder).as_posix() not in rendered)


def _all_renderings(
    registry: Registry, within: str | None, given: dict[str, Any]
) -> Iterator[tuple[str, str]]:
    """Every task of the domain or task `within`, and the feedback of every domain in it."""
    if within is not None and "/" in within:
        registry.task(within)
    elif within is not None:
        registry.get(DomainSpec, within)
    methods = registry.all(MethodSpec)
    if "method" in given:
        methods = {given["method"]: registry.get(MethodSpec, given["method"])}
    for domain in registry.all(DomainSpec).values():
        for task in domain.tasks.values():
            if within in (None, domain.name, f"{domain.name}/{task.name}"):
                yield from _of_task(registry, domain, task, methods.values(), given)
        if within in (None, domain.name) and domain.tasks:
            yield from _feedback(registry, domain, methods.values(), given)


def _of_task(
    registry: Registry,
    domain: DomainSpec,
    task: TaskSpec,
    methods: Iterable[MethodSpec],
    given: dict[str, Any],
) -> Iterator[tuple[str, str]]:
    """The first prompt of a task by every template."""
    for template, method in _by_template(methods):
        options = _options(domain, task, method, given)
        yield f"{domain.name}/{task.name}.{template}.md", markdown(first_messages(registry, options))


def _feedback(
    registry: Registry, domain: DomainSpec, methods: Iterable[MethodSpec], given: dict[str, Any]
) -> Iterator[tuple[str, str]]:
    """The feedback on typical failures of one task that has a judge, by every template that gets any."""
    tasks = sorted(domain.tasks.values(), key=lambda task: not (task.judge and task.instruction))
    for template, method in _by_template(method for method in methods if method.rounds):
        found = typical_feedback(registry, _options(domain, tasks[0], method, given))
        parts = (f"<!-- {name} -->\n\n{message.text.rstrip()}\n" for name, message in sorted(found.items()))
        yield f"{domain.name}/{_FEEDBACK}/{template}.md", "\n".join(parts)


def _by_template(methods: Iterable[MethodSpec]) -> list[tuple[str, MethodSpec]]:
    """The first method of every template."""
    return sorted({m.template: m for m in reversed(list(methods))}.items())


def _options(domain: DomainSpec, task: TaskSpec, method: MethodSpec, given: dict[str, Any]) -> RunOptions:
    goal = given.get("goal") or task.instruction or "(your instruction)"
    return run_options(task=f"{domain.name}/{task.name}", **{**given, "method": method.name, "goal": goal})
