"""Spec files: strict YAML into pydantic specs, with every mistake at once as `path:line: field: message`."""

import importlib.util
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, ValidationError

from proc3s.errors import Issue, SpecError, blame, did_you_mean
from proc3s.specs.base import Spec
from proc3s.specs.domain import DomainSpec
from proc3s.specs.types import SCALARS, split_type
from proc3s.specs.yaml_reader import Document, Loc

S = TypeVar("S", bound=Spec)
M = TypeVar("M", bound=BaseModel)


def load_spec(path: Path, model: type[S]) -> S:
    """Read a YAML file into a spec. Raises SpecError with all mistakes, in the order of their lines."""
    document = Document(path)
    spec, found = None, list(document.issues)
    if document.data is not None:
        try:
            spec = model.model_validate(_beside(document.data, path.parent.resolve()))
        except ValidationError as error:
            found += [(loc, document.line(loc), text) for loc, text in _explain(error, model)]
        if model is DomainSpec and isinstance(document.data, dict):
            found += [(loc, document.line(loc), text) for loc, text in _references(document.data)]
    if found or spec is None:
        found.sort(key=lambda item: item[1])
        raise SpecError([Issue(f"{path}:{line}", ".".join(map(str, loc)), text) for loc, line, text in found])
    return spec


def _beside(data: Any, folder: Path, in_args: bool = False) -> Any:
    """Plain data in which `./…` within the `args` of a target is a path below the folder."""
    if isinstance(data, dict):
        return {key: _beside(value, folder, in_args or key == "args") for key, value in data.items()}
    if isinstance(data, list):
        return [_beside(value, folder, in_args) for value in data]
    return str(folder / data) if in_args and isinstance(data, str) and data.startswith("./") else data


def load_domain(path: Path | str) -> DomainSpec:
    """The domain that a `domain.yaml` describes. Raises SpecError with all mistakes at once."""
    path = Path(path)
    return load_spec(path, DomainSpec).in_folder(path.parent)


def validate(model: type[M], data: Mapping[str, Any], where: str) -> M:
    """A spec or options from plain data, e.g. of `key=value` options. Raises SpecError naming `where`."""
    try:
        return model.model_validate(dict(data))
    except ValidationError as error:
        issues = [Issue(where, ".".join(map(str, loc)), text) for loc, text in _explain(error, model)]
        raise SpecError(issues) from error


def _explain(error: ValidationError, model: type[BaseModel]) -> Iterator[tuple[Loc, str]]:
    for detail in error.errors(include_url=False):
        loc, text = detail["loc"], detail["msg"].removeprefix("Value error, ")
        text = text[:1].lower() + text[1:]
        if detail["type"] == "extra_forbidden":
            text = f"unknown key {str(loc[-1])!r}{did_you_mean(str(loc[-1]), _keys(model, loc[:-1]))}"
        elif detail["type"] == "missing":
            text = "is missing"
        elif not isinstance(detail["input"], Mapping | list):
            text = f"{text}, not {detail['input']!r}"
        yield loc, text


def _keys(model: Any, loc: Loc) -> list[str]:
    """The keys that a spec has at a location inside `model`."""
    for part in loc:
        if isinstance(model, type) and issubclass(model, BaseModel):
            model = model.model_fields[str(part)].annotation if str(part) in model.model_fields else None
        else:
            model = next((a for a in reversed(get_args(model)) if a is not Ellipsis), None)
        while get_args(model) and type(None) in get_args(model):
            model = next(a for a in get_args(model) if a is not type(None))
    return list(model.model_fields) if isinstance(model, type) and issubclass(model, BaseModel) else []


def _references(data: Mapping[str, Any]) -> Iterator[tuple[Loc, str]]:
    """Names in a domain file that point nowhere; works on data that is no valid spec, as far as it goes."""
    types = {name: _field_types(spec) for name, spec in _mapping_of(data, "types").items()}
    state, objects = data.get("state"), data.get("objects")
    if isinstance(state, str) and types and state not in types:
        yield ("state",), f"there is no type {state!r}{did_you_mean(state, types)}"
    elif isinstance(state, str) and isinstance(objects, str) and types and objects not in types[state]:
        yield ("objects",), f"{state} has no field {objects!r}{did_you_mean(objects, types[state])}"
    for name, fields in types.items():
        yield from _field_references(name, fields, types)
    for loc, target in _targets(data, ()):
        module = target.partition(":")[0]
        if not _importable(module):
            yield loc, f"there is no module {module!r}"


def _field_references(
    name: str, fields: Mapping[str, str], types: Mapping[str, Mapping[str, str]]
) -> Iterator[tuple[Loc, str]]:
    for field, text in fields.items():
        inner, loc = split_type(text)[1], ("types", name, "fields", field, "type")
        if inner not in {*types, *SCALARS}:
            yield loc, f"there is no type {inner!r}{did_you_mean(inner, {*types, *SCALARS})}"
        elif name in _contained(inner, types):
            yield loc, f"{name} contains itself"


def _contained(name: str, types: Mapping[str, Mapping[str, str]]) -> set[str]:
    """A type and all that its fields are made of."""
    found: set[str] = set()
    waiting = [name]
    while waiting:
        if (name := waiting.pop()) not in found:
            found.add(name)
            waiting += [split_type(text)[1] for text in types.get(name, {}).values()]
    return found


def _field_types(spec: Any) -> dict[str, str]:
    fields = _mapping_of(spec, "fields")
    found = {name: field.get("type") for name, field in fields.items() if isinstance(field, dict)}
    return {name: text for name, text in found.items() if isinstance(text, str)}


def _mapping_of(data: Any, key: str) -> dict[str, Any]:
    value = data.get(key) if isinstance(data, Mapping) else None
    return value if isinstance(value, dict) else {}


def _importable(module: str) -> bool:
    try:
        with blame("target"):  # importing the package around it may raise anything
            return importlib.util.find_spec(module) is not None
    except SpecError:
        return False


def _targets(data: Any, loc: Loc) -> Iterator[tuple[Loc, str]]:
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in items:
        if key == "target" and isinstance(value, str) and ":" in value:
            yield (*loc, key), value
        elif key != "args":
            yield from _targets(value, (*loc, key))
