"""The templates of prompts copied out, to be changed and given back by --template-dir."""

from collections.abc import Iterator
from pathlib import Path

import typer

from proc3s.cli.handlers.new import refuse_in_use, write
from proc3s.plugins.registry import Registry, folders_of, open_registry
from proc3s.prompts.template_files import template_files
from proc3s.specs.domain import DomainSpec
from proc3s.specs.parts import MethodSpec


def copy_templates(folder: Path) -> None:
    """Copy what prompts are rendered from. Raises UsageError for a folder in use."""
    registry = open_registry()
    refuse_in_use(folder)
    found = template_files(folders_of(registry), registry.all(MethodSpec).values()).files
    for name, source in found.items():
        write(folder / name, source.read_bytes())
    typer.echo(f"{folder} has copies of the templates of all prompts:")
    for name in sorted(found):
        typer.echo(f"  {name}")
    for domain, name in _of_domains(registry):
        if name in found:
            typer.echo(f"the domain {domain} has its own {name}: delete the copy to keep that")
    typer.echo("Change one, delete the others, and see what it does:")
    shown = f"proc3s render-prompt drawing/star --template-dir {folder}"
    typer.echo(f"  {shown} \\\n    --diff <(proc3s render-prompt drawing/star)")
    typer.echo("What a template gets: reference/prompt-templates of the documentation.")


def _of_domains(registry: Registry) -> Iterator[tuple[str, str]]:
    """(domain, name) of every template that a domain brings."""
    for spec in registry.all(DomainSpec).values():
        own = spec.folder / "templates" if spec.folder else Path()
        for path in sorted(own.rglob("*.j2")) if spec.folder else ():
            yield spec.name, path.relative_to(own).as_posix()
