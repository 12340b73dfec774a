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
    from rich.table import Table

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
        table = Table("plugin", "from", "version", "state", box=None, pad_edge=False)
        for s in statuses:
            state = "loaded" if s.error is None else f"[red]failed:[/] {escape(s.error)}"
            table.add_row(escape(s.name), escape(s.source), s.version or "", state)
        Console().print(table)
    if strict and registry.plugins.failures:
        raise typer.Exit(2)
