"""The findings behind `proc3s doctor`, printed."""

import json
from collections.abc import Sequence

from rich.console import Console
from rich.markup import escape

from proc3s.checks.finding import Finding
from proc3s.checks.installation import examine
from proc3s.checks.question import ask
from proc3s.cli.arguments import OPTIONS, Given
from proc3s.cli.console.lines import print_line
from proc3s.cli.streams import print_document
from proc3s.errors import UsageError
from proc3s.llm.budget import Budget
from proc3s.llm.config import choose_llm
from proc3s.planning.options import key_values
from proc3s.plugins.registry import open_registry
from proc3s.specs.yaml_files import validate

_COLOURS = {"ok": "green", "note": "yellow", "error": "red"}


def diagnose(given: Given, asks: bool, as_json: bool) -> int:
    """Print what is fine, worth knowing or wrong; gives the exit code. Raises UsageError or SpecError."""
    limits = {name: given[name] for name in Budget.model_fields if name in given}
    if limits and not asks:
        raise UsageError(f"{OPTIONS[next(iter(limits))].flag} goes with --ask")
    budget = validate(Budget, limits, "options")
    llm = choose_llm(given.get("llm"), key_values(given.get("llm_options", [])))
    registry = open_registry(given.get("plugins", []))
    findings, code = list(examine(registry, llm)), 0
    if asks:
        asked = ask(registry, llm, budget)
        findings += asked.findings
        code = asked.exit_code
    _show(findings, as_json)
    return code or (UsageError.exit_code if any(finding.level == "error" for finding in findings) else 0)


def _show(findings: Sequence[Finding], as_json: bool) -> None:
    if as_json:
        print_document(
            json.dumps([finding.model_dump() for finding in findings], indent=2, ensure_ascii=False)
        )
        return
    console = Console(highlight=False, soft_wrap=True)
    for finding in findings:
        text = escape(f"{finding.subject}: {finding.text}")
        print_line(console, f"[{_COLOURS[finding.level]}]{finding.level:5}[/]  {text}")
        if finding.advice:
            print_line(console, escape(f"       {finding.advice}"))
