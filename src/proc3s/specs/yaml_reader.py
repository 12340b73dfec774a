"""YAML as people write it by hand: plain data with the line of every key, strict and of bounded size."""

import re
from pathlib import Path
from typing import Any, TypeAlias

import yaml
from yaml.composer import Composer

from proc3s.errors import Issue, SpecError
from proc3s.textfiles import decoded

Loc: TypeAlias = tuple[str | int, ...]

MOST_BYTES = 1_000_000
"""A larger file is refused unread: a spec is written by hand, and a megabyte takes seconds."""
MOST_LEVELS = 64
MOST_REPEATED = 10_000
"""Values that aliases may repeat, all together."""

_PLAIN = "plain"

# The scalars of YAML 1.2: `no` is a word, `1e-3` a number. Python makes no int of more digits.
_SCALARS = (
    (re.compile(r"~|null|Null|NULL|"), lambda text: None),
    (re.compile(r"true|True|TRUE"), lambda text: True),
    (re.compile(r"false|False|FALSE"), lambda text: False),
    (re.compile(r"[-+]?[0-9]{1,4000}"), int),
    (re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?"), float),
    (re.compile(r"[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)"), lambda text: float(text.replace(".", "").lower())),
)


def scalar(text: str) -> Any:
    """An unquoted word as YAML 1.2 reads it; also the type of `key=value` on the command line."""
    return next((convert(text) for pattern, convert in _SCALARS if pattern.fullmatch(text)), text)


class _Composer(Composer):
    """Leaves plain words alone; only tags that the file itself writes are resolved."""

    _levels = 0

    def resolve(self, kind: Any, value: Any, implicit: Any) -> Any:
        if kind is yaml.ScalarNode and implicit[0]:
            return _PLAIN
        return super().resolve(kind, value, implicit)  # type: ignore[misc]

    def compose_node(self, parent: Any, index: Any) -> Any:
        self._levels += 1
        if self._levels > MOST_LEVELS:
            mark = self.peek_event().start_mark  # type: ignore[attr-defined]
            raise yaml.MarkedYAMLError(problem=f"nested more than {MOST_LEVELS} deep", problem_mark=mark)
        node = super().compose_node(parent, index)
        self._levels -= 1
        return node


class _Loader(_Composer, yaml.SafeLoader):
    """Reads in Python, and says best what is wrong."""


_InC: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class _FastLoader(_Composer, _InC):  # type: ignore[misc]
    """Reads in C where PyYAML was built with it."""

    def __init__(self, stream: str) -> None:
        _InC.__init__(self, stream)
        Composer.__init__(self)


def _composed(text: str) -> yaml.Node | None:
    """The tree of a document. Raises YAMLError and ValueError."""
    try:
        return yaml.compose(text, Loader=_FastLoader)
    except (yaml.YAMLError, ValueError):
        return yaml.compose(text, Loader=_Loader)


class Document:
    """Plain data of a YAML file, with the line of every key and the mistakes found while reading.

    Raises SpecError for a file that cannot be read, is too large, or grows too large by its aliases.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.lines: dict[Loc, int] = {(): 1}
        self.issues: list[tuple[Loc, int, str]] = []
        self.data: Any = None
        self._seen: set[int] = set()
        self._repeated = 0
        text = self._text()
        try:
            node = _composed(text)
        except yaml.MarkedYAMLError as error:
            mark = error.problem_mark or error.context_mark
            self._invalid(mark.line + 1 if mark else 1, str(error.problem))
        except yaml.reader.ReaderError as error:
            self._invalid(
                text.count("\n", 0, error.position) + 1, f"it has the character {text[error.position]!r}"
            )
        except (yaml.YAMLError, ValueError) as error:
            self._invalid(1, str(error))
        else:
            self.data = self._plain(node, ()) if node else {}

    def _text(self) -> str:
        try:
            with self.path.open("rb") as file:
                data = file.read(MOST_BYTES + 1)
        except OSError as error:
            raise self._refusal(None, f"cannot be read: {error.strerror}") from error
        if len(data) > MOST_BYTES:
            raise self._refusal(None, f"has more than {MOST_BYTES:,} bytes, the most that are read")
        try:
            return decoded(data)
        except UnicodeDecodeError as error:
            line = data.count(b"\n", 0, error.start) + 1
            raise self._refusal(line, f"not valid YAML: not UTF-8 (byte {data[error.start]:#04x})") from error

    def _refusal(self, line: int | None, text: str) -> SpecError:
        return SpecError([Issue(f"{self.path}:{line}" if line else str(self.path), "", text)])

    def _invalid(self, line: int, text: str) -> None:
        self.issues.append(((), line, f"not valid YAML: {text}"))

    def _plain(self, node: yaml.Node, loc: Loc, inside: tuple[yaml.Node, ...] = ()) -> Any:
        line = self.lines.setdefault(loc, node.start_mark.line + 1)
        if node in inside:
            self.issues.append((loc, line, "an alias that contains itself"))
            return None
        self._repeated += id(node) in self._seen
        self._seen.add(id(node))
        if self._repeated > MOST_REPEATED:
            where = node.start_mark.line + 1
            raise self._refusal(
                where, f"aliases repeat more than {MOST_REPEATED:,} values; write less of them"
            )
        inside = (*inside, node)
        if isinstance(node, yaml.MappingNode):
            return self._mapping(node, loc, inside)
        if isinstance(node, yaml.SequenceNode):
            return [self._plain(child, (*loc, i), inside) for i, child in enumerate(node.value)]
        assert isinstance(node, yaml.ScalarNode)
        value = scalar(node.value) if node.tag == _PLAIN else node.value
        if value != value:
            self.issues.append((loc, line, f"{node.value} is no number that a spec may have"))
        return value

    def _mapping(self, node: yaml.MappingNode, loc: Loc, inside: tuple[yaml.Node, ...]) -> dict[str, Any]:
        result: dict[str, Any] = {}
        for key_node, value_node in node.value:
            key, line = str(key_node.value), key_node.start_mark.line + 1
            if refusal := self._refused_key(key_node, result, loc):
                self.issues.append(((*loc, key), line, refusal))
                continue
            self.lines[(*loc, key)] = line
            result[key] = self._plain(value_node, (*loc, key), inside)
        return result

    def _refused_key(self, node: yaml.Node, known: dict[str, Any], loc: Loc) -> str:
        """Why a key is refused, in words."""
        if not isinstance(node, yaml.ScalarNode):
            return "a key must be a word"
        if node.tag == _PLAIN and node.value == "<<":
            return "merge keys (`<<`) are not supported; write the keys out"
        if node.value in known:
            first = self.lines[(*loc, node.value)]
            return f"the key {node.value!r} stands here a second time (first in line {first})"
        return ""

    def line(self, loc: Loc) -> int:
        """The line of a location, or of the nearest enclosing one that the file has."""
        return next(self.lines[loc[:n]] for n in range(len(loc), -1, -1) if loc[:n] in self.lines)
