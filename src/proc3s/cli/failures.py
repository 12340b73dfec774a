"""Plugins that failed, said once, at the end of a command."""

import typer

from proc3s.plugins.registry import Registry


def warn_of_failures(registry: Registry) -> None:
    """Name on stderr every plugin that did not load or whose hooks raised, and why."""
    for status in registry.plugins.failures:
        typer.echo(f"proc3s: plugin {status.name} ({status.source}) failed: {status.error}", err=True)
