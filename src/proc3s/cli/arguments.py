"""Arguments and options of commands; those that fill `RunOptions` are made from its fields."""

import functools
import inspect
import types
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, TypeAlias, get_args, get_origin

import typer
from annotated_types import Ge, Gt

from proc3s.errors import UsageError
from proc3s.planning.options import Option, all_options

OPTIONS = all_options()

Task: TypeAlias = Annotated[str, typer.Argument(metavar="TASK", help="domain/task, e.g. drawing/star")]
Run: TypeAlias = Annotated[
    Path | None, typer.Argument(metavar="[RUN]", help="run folder (default: the newest in runs)")
]
Resume: TypeAlias = Annotated[
    Path | None,
    typer.Option("--resume", metavar="RUN", help="go on with a run that was broken off"),
]
Out: TypeAlias = Annotated[
    Path | None,
    typer.Option("--out", metavar="PATH", help="run folder (default: runs/…)"),
]
Json: TypeAlias = Annotated[
    bool,
    typer.Option("--json", help="one JSON document on stdout, nothing else"),
]
Plugins: TypeAlias = Annotated[
    list[Path] | None,
    typer.Option("--plugin", metavar="PATH", help=OPTIONS["plugins"].field.description),
]

_NO = "no_"
_METAVARS = {int: "N", float: "N", Path: "PATH", str: "NAME"}

Given: TypeAlias = dict[str, Any]
"""What was given of some options, by the names of their fields."""


@dataclass(frozen=True)
class Fields:
    """Stands at a parameter of a command for the options that fill these fields; the command gets `Given`."""

    names: tuple[str, ...]


def fields(*names: str) -> Fields:
    """The options with these names."""
    return Fields(names)


def all_fields(asks: bool = True) -> Fields:
    """All options, or all but those of a run that asks an LLM."""
    return Fields(tuple(name for name, option in OPTIONS.items() if asks or not option.shown.asks))


def with_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """The command as typer reads it: with an option for each field that its parameters stand for."""
    own = inspect.signature(command).parameters.values()
    groups = {parameter.name: found.names for parameter in own if (found := _fields_of(parameter))}
    if not groups:
        return command

    @functools.wraps(command)
    def called(**values: Any) -> Any:
        for group, names in groups.items():
            taken = {name: _given(values, name) for name in names}
            values[group] = {name: value for name, value in taken.items() if value is not None}
        return command(**values)

    shown = [one for parameter in own for one in _expanded(parameter)]
    called.__signature__ = inspect.Signature(shown)  # type: ignore[attr-defined]
    return called


def _given(values: Given, name: str) -> Any:
    """What was given of an option, taken from the values; its flag that says no makes it False."""
    value = values.pop(name)
    if not values.pop(_NO + name, None):
        return value
    if value:
        raise UsageError(f"{OPTIONS[name].flag} and {_no(OPTIONS[name])} contradict each other")
    return False


def _fields_of(parameter: inspect.Parameter) -> Fields | None:
    return next((one for one in get_args(parameter.annotation)[1:] if isinstance(one, Fields)), None)


def _expanded(parameter: inspect.Parameter) -> Iterator[inspect.Parameter]:
    found = _fields_of(parameter)
    if found is None:
        yield parameter.replace(kind=inspect.Parameter.KEYWORD_ONLY)
        return
    for option in map(OPTIONS.__getitem__, found.names):
        help_ = option.field.description or ""
        yield _parameter(option, option.name, option.flag, help_)
        if option.field.annotation == bool | None:  # two flags, since one with two names fills the help
            yield _parameter(option, _NO + option.name, _no(option), "do not, whatever the preset says")


def _no(option: Option) -> str:
    return f"--no-{option.flag.removeprefix('--')}"


def _parameter(option: Option, name: str, flag: str, help_: str) -> inspect.Parameter:
    """The option in typer's terms; None where it is not given, whatever the default of its field."""
    field, kind = option.field, _type(option.field.annotation)
    least: Any = next(
        (getattr(m, "ge", getattr(m, "gt", None)) for m in field.metadata if isinstance(m, Ge | Gt)), None
    )
    shown = typer.Option(
        None, flag, metavar=_metavar(option), min=least, help=help_, rich_help_panel=option.shown.panel
    )
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=shown, annotation=kind | None)


def _metavar(option: Option) -> str | None:
    """What stands for the value; flags have none."""
    kind = option.field.annotation
    if get_origin(kind) is dict:
        return "KEY=VALUE"
    return option.shown.metavar or next(
        (word for one, word in _METAVARS.items() if one in _parts(kind)), None
    )


def _parts(kind: Any) -> tuple[Any, ...]:
    """A type, or those of a union or tuple."""
    return get_args(kind) or (kind,)


def _type(kind: Any) -> Any:
    """The type of an option: what may be given several times is a list, pairs `key=value` are texts."""
    if get_origin(kind) not in (dict, tuple):
        return kind
    return types.GenericAlias(list, str if get_origin(kind) is dict else get_args(kind)[0])
