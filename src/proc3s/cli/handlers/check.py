"""A domain examined from the command line: found by name or by path, its findings as a report."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape

from proc3s.checks.domain import Checked, CheckFinding, examine
from proc3s.checks.subject import Subject
from proc3s.cli.failures import warn_of_failures
from proc3s.cli.streams import print_document
from proc3s.domain.world import make_world
from proc3s.errors import UsageError
from proc3s.planning.options import plain_options
from proc3s.plugins.loose_folders import DOMAIN_FILE, loose_plugins
from proc3s.plugins.registry import Registry, open_registry
from proc3s.specs.domain import DomainSpec
from proc3s.wording import count


def examine_domain(
    wanted: str, seconds: float, given: Mapping[str, Any], plugins: Sequence[Path], as_json: bool
) -> int:
    """Print the report; returns the exit code. Raises UsageError for a domain that is not there."""
    registry, name = _found(wanted, plugins)
    subject = Subject(registry, name, seconds, **plain_options(given))
    warn_of_failures(registry)
    out = Console(highlight=False, quiet=as_json, soft_wrap=True)
    found: list[CheckFinding] = []
    unchecked: dict[str, str] = {}
    for checked in examine(subject):
        found += checked.findings
        unchecked |= {checked.check.name: checked.unchecked} if checked.unchecked else {}
        _print(out, checked)
    errors = sum(finding.level == "error" for finding in found)
    facts = [] if errors else _facts(subject)
    if as_json:
        told = [finding.model_dump() for finding in found]
        document = {
            "domain": name,
            "errors": errors,
            "findings": told,
            "unchecked": unchecked,
            "facts": facts,
        }
        print_document(json.dumps(document, indent=2, ensure_ascii=False))
    else:
        for fact in facts:
            out.print(f"fact   {escape(fact)}")
        open_ = f", {count(len(unchecked), 'check')} not made" if unchecked else ""
        out.print(f"{name}: {count(errors, 'error')}, {count(len(found) - errors, 'note')}{open_}")
    return 2 if errors else 0


def _facts(subject: Subject) -> list[str]:
    """What the world says of its models."""
    world = make_world(subject.domain)
    try:
        return [*world.facts()]
    finally:
        world.close()


def _print(out: Console, checked: Checked) -> None:
    """A line for a check, four for each finding; words that are long hang under their beginning."""
    wrong = any(finding.level == "error" for finding in checked.findings)
    state = "[red]wrong[/]" if wrong else "[yellow]note[/] " if checked.findings else "[green]fine[/] "
    if checked.unchecked and not checked.findings:
        state = "[yellow]open[/] "
    not_made = f"  not checked: {escape(checked.unchecked)}" if checked.unchecked else ""
    out.print(f"{state}  {checked.check.name:10}  {checked.seconds:.1f} s{not_made}")
    for finding in checked.findings:
        out.print(f"         {escape(finding.text)}")
        out.print(f"           at    {escape(finding.where)}")
        out.print(f"           why   {escape(finding.why)}")
        out.print(f"           fix   {escape(finding.mend)}")


def _found(wanted: str, plugins: Sequence[Path]) -> tuple[Registry, str]:
    """The registry that has the domain, and its name: a bare word means one that is known before a path."""
    path = Path(wanted)
    if not path.suffix and "/" not in wanted:
        registry = open_registry(plugins)
        if not path.exists() or wanted in registry.all(DomainSpec):
            return registry, registry.get(DomainSpec, wanted).name
    if not path.exists():
        raise UsageError(f"there is no file or folder {wanted}")
    return _in_path(path, plugins)


def _in_path(path: Path, plugins: Sequence[Path]) -> tuple[Registry, str]:
    """The same for the domain at a path."""
    file = _file(path)
    for plugin in (_plugin(path, file), file):
        registry = open_registry([*plugins, plugin])
        domains = registry.all(DomainSpec).values()
        of_file = [one.name for one in domains if one.folder and one.folder.samefile(file.parent)]
        if of_file:
            return registry, of_file[-1]
    warn_of_failures(registry)
    raise UsageError(f"the domain of {file} cannot be loaded")


def _plugin(path: Path, file: Path) -> Path:
    """The folder, whose hooks may bring more than the domain, if it is a plugin; else the file."""
    try:
        loose_plugins(path)
    except UsageError:
        return file
    return path


def _file(path: Path) -> Path:
    """The `domain.yaml` that a path means. Raises UsageError if there is none, or are several."""
    if path.is_file():
        return path
    found = sorted(p for p in path.rglob(DOMAIN_FILE) if not {".venv", "venv", "build"} & set(p.parts))
    if len(found) != 1:
        what = "has no" if not found else f"has {len(found)} files called"
        raise UsageError(f"{path} {what} {DOMAIN_FILE}; name the file itself")
    return found[0]
