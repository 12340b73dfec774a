"""Spec files: strict YAML into pydantic specs, with every mistake at once as `path:line: field: message`."""

import importlib.util
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, TypeAlias, TypeVar, get_args

import yaml
from pydantic import BaseModel, ValidationError

from proc3s.errors import Issue, SpecError, blame, did_you_mean
from proc3s.specs import DomainSpec, Spec
from proc3s.state import SCALARS, split_type
from proc3s.textfiles import read_text

Loc: TypeAlias = tuple[str | int, ...]
S = TypeVar("S", bound=Spec)
M = TypeVar("M", bound=BaseModel)

_PLAIN = "plain"

# The scalars of YAML 1.2: `no` is a word, `1e-3` a number.
_SCALARS = (
    (re.compile(r"~|null|Null|NULL|"), lambda text: None),
    (re.compile(r"true|True|TRUE"), lambda text: True),
    (re.compile(r"false|False|FALSE"), lambda text: False),
    (re.compile(r"[-+]?[0-9]+"), int),
    (re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?"), float),
    (re.compile(r"[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)"), lambda text: float(text.replace(".", "").lower())),
)


def scalar(text: str) -> Any:
    """An unquoted word as YAML 1.2 reads it; also the type of `key=value` on the command line."""
    return next((convert(text) for pattern, convert in _SCALARS if pattern.fullmatch(text)), text)


class _Loader(yaml.SafeLoader):
    """Leaves plain words alone; only tags that the file itself writes are resolved."""

    def resolve(self, kind: Any, value: Any, implicit: Any) -> Any:
        if kind is yaml.ScalarNode and implicit[0]:
            return _PLAIN
        return super().resolve(kind, value, implicit)  # type: ignore[no-untyped-call]


class _Document:
    """Plain data of a YAML file, with the line of every key and the mistakes found while reading."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.lines: dict[Loc, int] = {(): 1}
        self.issues: list[tuple[Loc, int, str]] = []
        self.data: Any = None
        try:
            node = yaml.compose(read_text(path), Loader=_Loader)
        except yaml.MarkedYAMLError as error:
            mark = error.problem_mark or error.context_mark
            self.issues.append(((), mark.line + 1 if mark else 1, f"not valid YAML: {error.problem}"))
        except (yaml.YAMLError, UnicodeDecodeError) as error:
            self.issues.append(((), 1, f"not valid YAML: {error}"))
        except OSError as error:
            raise SpecError([Issue(str(path), "", f"cannot be read: {error.strerror}")]) from error
        else:
            self.data = self._plain(node, ()) if node else {}

    def _plain(self, node: yaml.Node, loc: Loc, inside: tuple[yaml.Node, ...] = ()) -> Any:
        self.lines.setdefault(loc, node.start_mark.line + 1)
        if node in inside:
            self.issues.append((loc, self.lines[loc], "an alias that contains itself"))
            return None
        inside = (*inside, node)
        if isinstance(node, yaml.MappingNode):
            return self._mapping(node, loc, inside)
        if isinstance(node, yaml.SequenceNode):
            return [self._plain(child, (*loc, i), inside) for i, child in enumerate(node.value)]
        assert isinstance(node, yaml.ScalarNode)
        return scalar(node.value) if node.tag == _PLAIN else node.value

    def _mapping(self, node: yaml.MappingNode, loc: Loc, inside: tuple[yaml.Node, ...]) -> dict[str, Any]:
        result: dict[str, Any] = {}
        for key_node, value_node in node.value:
            key, line = str(key_node.value), key_node.start_mark.line + 1
            if key in result:
                first = self.lines[(*loc, key)]
                self.issues.append(
                    ((*loc, key), line, f"the key {key!r} stands here a second time (first in line {first})")
                )
                continue
            self.lines[(*loc, key)] = line
            result[key] = self._plain(value_node, (*loc, key), inside)
        return result

    def line(self, loc: Loc) -> int:
        """The line of a location, or of the nearest enclosing one that the file has."""
        return next(self.lines[loc[:n]] for n in range(len(loc), -1, -1) if loc[:n] in self.lines)


def load_spec(path: Path, model: type[S]) -> S:
    """Read a YAML file into a spec. Raises SpecError with all mistakes, in the order of their lines."""
    document = _Document(path)
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
