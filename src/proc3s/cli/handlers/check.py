"""A domain examined from the command line: found by name or by path, its findings as a report."""

import json
import sys
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console
from rich.markup import escape

from proc3s.checks.domain import Check, CheckFinding, examine
from proc3s.checks.subject import Subject
from proc3s.cli.failures import warn_of_failures
from proc3s.cli.streams import print_document
from proc3s.domain.world import make_world
from proc3s.errors import UsageError
from proc3s.plugins.registry import Registry, open_registry
from proc3s.specs.domain import DomainSpec
from proc3s.specs.yaml_files import load_domain
from proc3s.wording import count

FILE = "domain.yaml"


def examine_domain(wanted: str, seconds: float, plugins: Sequence[Path], as_json: bool) -> int:
    """Print the report; returns the exit code. Raises UsageError for a domain that is not there."""
    registry, name = _found(wanted, plugins)
    subject = Subject(registry, name, seconds)
    warn_of_failures(registry)
    out = Console(highlight=False, quiet=as_json, soft_wrap=True)
    found: list[CheckFinding] = []
    for check, findings, took in examine(subject):
        found += findings
        _print(out, check, findings, took)
    errors = sum(finding.level == "error" for finding in found)
    facts = [] if errors else _facts(subject)
    if as_json:
        told = [finding.model_dump() for finding in found]
        document = {"domain": name, "errors": errors, "findings": told, "facts": facts}
        print_document(json.dumps(document, indent=2, ensure_ascii=False))
    else:
        for fact in facts:
            out.print(f"fact   {escape(fact)}")
        out.print(f"{name}: {count(errors, 'error')}, {count(len(found) - errors, 'note')}")
    return 2 if errors else 0


def _facts(subject: Subject) -> list[str]:
    """What the world says of its models."""
    world = make_world(subject.domain)
    try:
        return [*world.facts()]
    finally:
        world.close()


def _print(out: Console, check: Check, findings: Sequence[CheckFinding], took: float) -> None:
    wrong = any(finding.level == "error" for finding in findings)
    state = "[red]wrong[/]" if wrong else "[yellow]note[/] " if findings else "[green]fine[/] "
    out.print(f"{state}  {check.name:10}  {took:.1f} s")
    for finding in findings:
        out.print(f"         {escape(finding.text)}")
        out.print(f"           at    {escape(finding.where)}")
        out.print(f"           why   {escape(finding.why)}")
        out.print(f"           fix   {escape(finding.mend)}")


def _found(wanted: str, plugins: Sequence[Path]) -> tuple[Registry, str]:
    """The registry that has the domain, and its name."""
    path = Path(wanted)
    if not path.exists():
        if path.suffix or "/" in wanted:
            raise UsageError(f"there is no file or folder {wanted}")
        registry = open_registry(plugins)
        return registry, registry.get(DomainSpec, wanted).name
    file = _file(path)
    package = (file.parent / "__init__.py").is_file()
    # its targets name the package, or modules beside the file
    sys.path.insert(0, str((file.parent.parent if package else file.parent).resolve()))
    name = load_domain(file).name
    registry = open_registry(plugins)
    if name in registry.all(DomainSpec):
        return registry, name
    return open_registry([*plugins, file]), name


def _file(path: Path) -> Path:
    """The `domain.yaml` that a path means. Raises UsageError if there is none, or are several."""
    if path.is_file():
        return path
    found = sorted(p for p in path.rglob(FILE) if not {".venv", "venv", "build"} & set(p.parts))
    if len(found) != 1:
        what = "has no" if not found else f"has {len(found)} files called"
        raise UsageError(f"{path} {what} {FILE}; name the file itself")
    return found[0]
