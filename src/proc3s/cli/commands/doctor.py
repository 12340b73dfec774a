"""`proc3s doctor`."""

from typing import Annotated

import typer

from proc3s.cli import arguments as a


def doctor(
    given: Annotated[a.Given, a.fields("llm", "llm_options", "plugins")], json: a.Json = False
) -> None:
    """Check this installation: sandbox, packages, keys (never shown), servers. Asks no model."""
    import json as json_

    from rich.console import Console
    from rich.markup import escape

    from proc3s.checks.installation import examine
    from proc3s.cli.streams import print_document
    from proc3s.llm.config import choose_llm
    from proc3s.planning.options import key_values
    from proc3s.plugins.registry import open_registry

    chosen = choose_llm(given.get("llm"), key_values(given.get("llm_options", [])))
    findings = list(examine(open_registry(given.get("plugins", [])), chosen))
    if json:
        print_document(
            json_.dumps([finding.model_dump() for finding in findings], indent=2, ensure_ascii=False)
        )
    else:
        console = Console(highlight=False, soft_wrap=True)
        colours = {"ok": "green", "note": "yellow", "error": "red"}
        for finding in findings:
            text = escape(f"{finding.subject}: {finding.text}")
            console.print(f"[{colours[finding.level]}]{finding.level:5}[/]  {text}")
            if finding.advice:
                console.print(escape(f"       {finding.advice}"))
    if any(finding.level == "error" for finding in findings):
        raise typer.Exit(2)
