"""`proc3s plugins`."""

from typing import Annotated

import typer

from proc3s.cli import arguments as a


def plugins(
    strict: Annotated[bool, typer.Option("--strict", help="exit 2 if a plugin is broken")] = False,
    plugin: a.Plugins = None,
    json: a.Json = False,
) -> None:
    """List the plugins: which loaded, from where, and why the others did not."""
    import dataclasses
    import json as json_

    from rich.console import Console
    from rich.markup import escape

    from proc3s.cli.console.tables import print_table
    from proc3s.cli.streams import print_document
    from proc3s.plugins.registry import KINDS, open_registry

    registry = open_registry(plugin or [])
    for kind in KINDS:
        if kind not in ("presets", "suites"):
            registry.plugins.specs(kind)
    statuses = list(registry.plugins.statuses.values())
    if json:
        print_document(json_.dumps([dataclasses.asdict(status) for status in statuses], indent=2))
    else:
        out = Console(highlight=False)
        states = ["loaded" if s.error is None else "failed" for s in statuses]
        lines = [
            (s.name, s.source, s.version or "", state) for s, state in zip(statuses, states, strict=True)
        ]
        print_table(out, ("plugin", "from", "version", "state"), lines)
        for status in registry.plugins.failures:
            out.print(f"[red]failed:[/] {escape(status.name)}: {escape(status.error or '')}", soft_wrap=True)
    if strict and registry.plugins.failures:
        raise typer.Exit(2)
