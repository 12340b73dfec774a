"""`proc3s new`."""

from pathlib import Path
from typing import Annotated

import typer

from proc3s.cli.command_classes import CommandGroup

new = typer.Typer(
    cls=CommandGroup, help="Begin a plugin, as a complete package with tests, or templates of your own."
)

Name = Annotated[str, typer.Argument(metavar="NAME", help="lower-case letters, digits and _")]
Dir = Annotated[
    Path | None, typer.Option("--dir", metavar="PATH", help="where the package goes (default: ./NAME)")
]
TemplatesDir = Annotated[Path, typer.Option("--dir", metavar="PATH", help="where the templates go")]


def domain(name: Name, dir_: Dir = None) -> None:
    """A domain: types, a skill, constraints, a task with scene and judge, a worked example, tests."""
    _begin("domain", name, dir_)


def solver(name: Name, dir_: Dir = None) -> None:
    """A solver with an option, and its tests."""
    _begin("solver", name, dir_)


def llm(name: Name, dir_: Dir = None) -> None:
    """A language-model backend, and its tests."""
    _begin("llm", name, dir_)


def templates(dir_: TemplatesDir = Path("templates")) -> None:
    """Templates of prompts: copies of all, to change and to give by --template-dir."""
    from proc3s.cli.handlers.new_templates import copy_templates

    copy_templates(dir_)


def _begin(kind: str, name: str, folder: Path | None) -> None:
    from proc3s.cli.handlers.new import begin

    begin(kind, name, folder or Path(name))
