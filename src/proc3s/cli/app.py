"""The typer application: the table of commands, and how errors leave it."""

import contextlib
import functools
import inspect
import sys
import warnings
from collections.abc import Callable, Mapping
from typing import Any

import typer

from proc3s.cli.arguments import with_options
from proc3s.cli.command_classes import Command, CommandGroup
from proc3s.cli.commands import (
    bench,
    check,
    compare,
    doctor,
    execute,
    explain,
    judge,
    new,
    pictures,
    plugins,
    render_prompt,
    replay,
    report,
    run,
    runs,
    schema,
)
from proc3s.cli.commands import list as catalogue
from proc3s.cli.streams import document_alone, exit_code, take_streams
from proc3s.errors import Notice, Proc3sError, refuse_windows

PYTHONS = warnings.formatwarning
"""How Python shows a warning."""

app = typer.Typer(
    name="proc3s",
    cls=CommandGroup,
    help="Plans for robots from plain language: an LLM writes a program, a solver finds its numbers.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _prints_document(options: Mapping[str, Any]) -> bool:
    """Whether stdout is for one document: JSON, or a prompt."""
    return bool(options.get("json")) or ("format_" in options and options["check"] is None)


def _guarded(command: Callable[..., Any]) -> Callable[..., Any]:
    """A mistake of the user is a message and an exit code, never a traceback."""

    @functools.wraps(command)
    def guarded(*args: Any, **kwargs: Any) -> None:
        try:
            refuse_windows()
            with document_alone() if _prints_document(kwargs) else contextlib.nullcontext():
                command(*args, **kwargs)
        except Proc3sError as error:
            typer.echo(f"proc3s: {error}", err=True)
            raise typer.Exit(error.exit_code) from error
        except KeyboardInterrupt as error:
            typer.echo("proc3s: interrupted", err=True)
            raise typer.Exit(130) from error
        except OSError as error:
            if isinstance(error, BrokenPipeError):
                raise
            place = f"{error.filename}: " if error.filename else ""
            typer.echo(f"proc3s: {place}{error.strerror or error}", err=True)
            raise typer.Exit(2) from error
        except SystemExit as error:  # typer's own exits are of another class
            typer.echo(f"proc3s: code of a plugin ended the command (SystemExit: {error})", err=True)
            raise typer.Exit(2) from error

    return guarded


_COMMANDS: dict[str, Callable[..., Any]] = {
    "run": run.run,
    "solve": run.solve,
    "render-prompt": render_prompt.render_prompt,
    "runs": runs.runs,
    "replay": replay.replay,
    "execute": execute.execute,
    "explain": explain.explain,
    "report": report.report,
    "pictures": pictures.pictures,
    "bench": bench.bench,
    "bench ccsp": bench.ccsp,
    "bench execution": bench.execution,
    "bench command": bench.command,
    "compare": compare.compare,
    "judge": judge.judge,
    "check": check.check,
    "list": catalogue.list_,
    "show": catalogue.show,
    "plugins": plugins.plugins,
    "schema": schema.schema,
    "doctor": doctor.doctor,
}


def _add(group: typer.Typer, name: str, command: Callable[..., Any]) -> None:
    """Typer keeps the line breaks of a docstring; the help breaks its lines where the terminal ends."""
    paragraphs = inspect.cleandoc(command.__doc__ or "").split("\n\n")
    help_ = "\n\n".join(" ".join(text.split()) for text in paragraphs)
    group.command(name=name, cls=Command, help=help_)(_guarded(with_options(command)))


for _name, _command in _COMMANDS.items():
    _add(app, _name, _command)
_BEGINNINGS: dict[str, Callable[..., Any]] = {
    "domain": new.domain,
    "solver": new.solver,
    "llm": new.llm,
    "templates": new.templates,
}
for _name, _command in _BEGINNINGS.items():
    _add(new.new, _name, _command)
app.add_typer(new.new, name="new", no_args_is_help=True)


def _print_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version as installed

        typer.echo(f"proc3s {installed('proc3s')}")
        raise typer.Exit


@app.callback()
def _root(
    version: bool = typer.Option(
        False, "--version", help="Print the version and exit.", callback=_print_version, is_eager=True
    ),
) -> None:
    pass


def main() -> None:
    """Entry point of the `proc3s` script."""
    out = take_streams()
    warnings.formatwarning = _warning
    try:
        app()
    except SystemExit as ended:
        sys.exit(exit_code(ended.code if isinstance(ended.code, int) else 0, out))


def _warning(
    message: Warning | str, category: type[Warning], filename: str, lineno: int, line: str | None = None
) -> str:
    """A notice as the command line says it; another warning as Python shows it."""
    if category is Notice:
        return f"proc3s: {message}\n"
    return PYTHONS(message, category, filename, lineno, line)
