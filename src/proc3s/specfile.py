"""Spec files: strict YAML into pydantic specs, with every mistake at once as `path:line: field: message`."""

import importlib.util
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, TypeAlias, TypeVar, get_args

import yaml
from pydantic import BaseModel, ValidationError

from proc3s.errors import Issue, SpecError, did_you_mean
from proc3s.specs import DomainSpec, Spec
from proc3s.state import split_type

Loc: TypeAlias = tuple[str | int, ...]
S = TypeVar("S", bound=Spec)
M = TypeVar("M", bound=BaseModel)

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


class _Document:
    """Plain data of a YAML file, with the line of every key and the mistakes found while reading."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.lines: dict[Loc, int] = {(): 1}
        self.issues: list[tuple[Loc, int, str]] = []
        self.data: Any = None
        try:
            node = yaml.compose(path.read_text(encoding="utf-8"), Loader=yaml.SafeLoader)
        except yaml.MarkedYAMLError as error:
            mark = error.problem_mark or error.context_mark
            self.issues.append(((), mark.line + 1 if mark else 1, f"not valid YAML: {error.problem}"))
        except (yaml.YAMLError, UnicodeDecodeError) as error:
            self.issues.append(((), 1, f"not valid YAML: {error}"))
        except OSError as error:
            raise SpecError([Issue(str(path), "", f"cannot be read: {error.strerror}")]) from error
        else:
            self.data = self._plain(node, ()) if node else {}

    def _plain(self, node: yaml.Node, loc: Loc) -> Any:
        self.lines.setdefault(loc, node.start_mark.line + 1)
        if isinstance(node, yaml.MappingNode):
            return self._mapping(node, loc)
        if isinstance(node, yaml.SequenceNode):
            return [self._plain(child, (*loc, i)) for i, child in enumerate(node.value)]
        assert isinstance(node, yaml.ScalarNode)
        return node.value if node.style else scalar(node.value)

    def _mapping(self, node: yaml.MappingNode, loc: Loc) -> dict[str, Any]:
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
            result[key] = self._plain(value_node, (*loc, key))
        return result

    def line(self, loc: Loc) -> int:
        """The line of a location, or of the nearest enclosing one that the file has."""
        return next(self.lines[loc[:n]] for n in range(len(loc), -1, -1) if loc[:n] in self.lines)


def load_spec(path: Path, model: type[S], extra: Mapping[str, Any] | None = None) -> S:
    """Read a YAML file into a spec; `extra` adds fields that do not stand in the file.

    Raises SpecError with all mistakes, in the order of their lines.
    """
    document = _Document(path)
    spec, found = None, list(document.issues)
    if document.data is not None:
        if isinstance(document.data, dict) and extra:
            document.data.update(extra)
        try:
            spec = model.model_validate(document.data)
        except ValidationError as error:
            found += [(loc, document.line(loc), text) for loc, text in _explain(error, model)]
        if model is DomainSpec and isinstance(document.data, dict):
            found += [(loc, document.line(loc), text) for loc, text in _references(document.data)]
    if found or spec is None:
        found.sort(key=lambda item: item[1])
        raise SpecError([Issue(f"{path}:{line}", ".".join(map(str, loc)), text) for loc, line, text in found])
    return spec


def load_domain(path: Path | str) -> DomainSpec:
    """The domain that a `domain.yaml` describes. Raises SpecError with all mistakes at once."""
    path = Path(path)
    return load_spec(path, DomainSpec, extra={"folder": path.parent})


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
    types = data.get("types") if isinstance(data.get("types"), dict) else {}
    assert isinstance(types, dict)
    if isinstance(state := data.get("state"), str) and types and state not in types:
        yield ("state",), f"there is no type {state!r}{did_you_mean(state, types)}"
    for name, spec in types.items():
        fields = spec.get("fields") if isinstance(spec, dict) else None
        for field, field_spec in fields.items() if isinstance(fields, dict) else ():
            text = field_spec.get("type") if isinstance(field_spec, dict) else None
            known = {*types, "float", "int", "str", "bool"}
            if isinstance(text, str) and split_type(text)[1] not in known:
                yield (
                    ("types", name, "fields", field, "type"),
                    f"there is no type {split_type(text)[1]!r}{did_you_mean(split_type(text)[1], known)}",
                )
    for loc, target in _targets(data, ()):
        module = target.partition(":")[0]
        try:
            found = importlib.util.find_spec(module)
        except (ImportError, ValueError):
            found = None
        if found is None:
            yield loc, f"there is no module {module!r}"


def _targets(data: Any, loc: Loc) -> Iterator[tuple[Loc, str]]:
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in items:
        if key == "target" and isinstance(value, str) and ":" in value:
            yield (*loc, key), value
        elif key != "args":
            yield from _targets(value, (*loc, key))
