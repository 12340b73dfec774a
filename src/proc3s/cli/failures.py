"""What a command says on stderr beside its result: notices, and plugins that failed."""

from collections.abc import Iterable

import typer

from proc3s.plugins.registry import Registry


def warn_of_failures(registry: Registry) -> None:
    """Name on stderr every plugin that did not load or whose hooks raised, and why."""
    for status in registry.plugins.failures:
        typer.echo(f"proc3s: plugin {status.name} ({status.source}) failed: {status.error}", err=True)


def say(notices: Iterable[str]) -> None:
    """Each notice on stderr, as from proc3s."""
    for notice in notices:
        typer.echo(f"proc3s: {notice}", err=True)
