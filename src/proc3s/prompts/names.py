"""The names that code binds, uses and changes, read from its text: nothing here parses or compiles it."""

import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass, field

_TOKEN = re.compile(
    r"""\\.|\#[^\n]*+|(?P<kind>\b[rbufRBUF]{1,2})?+
    (?:\"{3}(?:[^"\\]|\\.|"(?!""))*+(?:\"{3}|\Z)|'{3}(?:[^'\\]|\\.|'(?!''))*+(?:'{3}|\Z)
    |"(?:[^"\\\n]|\\.)*+"|'(?:[^'\\\n]|\\.)*+')""",
    re.VERBOSE | re.DOTALL,
)
_FIELD = re.compile(r"\{([^{}]++)\}")
_WORD = re.compile(r"(?<![.\w])[^\W\d]\w*+")
_TOP = re.compile(r"(?:async[ \t]|def[ \t]|class[ \t]|import[ \t]|from[ \t]|@)")
_SCOPE = re.compile(r"(?:async[ \t]++)?(def|class)[ \t]++(\w++)[ \t]*+(.*+)$")
_IMPORT = re.compile(r"(?:from[ \t]++[\w.]++[ \t]++)?import\b(.*+)$")
_CLAUSE = re.compile(r"(?:try|else|finally)[ \t]*+:[ \t]*+")
_LOOP = re.compile(r"(?:async[ \t]++)?for\b([^\n]*?)\bin\b")
_HEAD = re.compile(r"(?:if|elif|while|for|async|with|except|match|case)\b")
_AS = re.compile(r"\bas[ \t]++(\w++)|(\w++)[ \t]*+:=")
_TARGETS = re.compile(r"((?:(?!\w[ \t]*+\(|\blambda\b)[\w ,()*\t])++)(?::[^=\n]*+)?=(?!=)[ \t]*+")
_CHANGE = re.compile(r"(\w++)[ \t]*+(?:[\[.]|[-+*/%@&|^<>]{1,3}=)")
_GLOBAL = re.compile(r"global\b(.*+)$")


@dataclass
class Names:
    """Names of one scope; those of a module say what its block gives to others and wants of them."""

    margin: int = -1
    is_class: bool = False
    bound: set[str] = field(default_factory=set)
    used: set[str] = field(default_factory=set)
    changed: set[str] = field(default_factory=set)
    shared: set[str] = field(default_factory=set)
    beyond: set[str] = field(default_factory=set)
    imports_all: bool = False

    @property
    def free(self) -> set[str]:
        """What the scope uses and does not bind; what a class binds is hidden from its methods."""
        return (self.used - (self.bound - self.shared)) | self.beyond


def names_of(code: str) -> Names:
    """The names of a module. A comprehension binds nothing here: its names may be used beyond it."""
    module = Names()
    scopes = [module]
    for line in _statements(unquoted(code)):
        margin = len(line) - len(line.lstrip(" \t"))
        while margin <= scopes[-1].margin:
            _leave(scopes)
        _read(line.strip(), margin, scopes)
    while len(scopes) > 1:
        _leave(scopes)
    return module


def unquoted(code: str) -> str:
    """Code less its comments and strings; of f-strings there stays what they may use."""

    def less(found: re.Match[str]) -> str:
        if found[0] == "\\\n":
            return " "
        inner = _FIELD.findall(found[0]) if "f" in (found["kind"] or "").lower() else []
        return f"({re.sub(r'[^a-zA-Z0-9_.]', ' ', ' '.join(inner))})" if inner else ""

    return _TOKEN.sub(less, unicodedata.normalize("NFKC", code))


def _statements(code: str) -> Iterator[str]:
    """Lines, each with those that its brackets continue; a definition at the margin ends all brackets."""
    parts: list[str] = []
    depth = 0
    for line in code.split("\n"):
        if parts and (depth <= 0 or _TOP.match(line)):
            yield " ".join(parts)
            parts, depth = [], 0
        if line.strip():
            parts.append(line)
            depth += sum(map(line.count, "([{")) - sum(map(line.count, ")]}"))
    if parts:
        yield " ".join(parts)


def _read(line: str, margin: int, scopes: list[Names]) -> None:
    """One statement: into the scope it stands in, or into the one that it opens."""
    scope = scopes[-1]
    if not (opened := _SCOPE.match(line)):
        for part in line.split(";"):
            _read_simple(part.strip(), scope)
        return
    kind, name, rest = opened.groups()
    scope.bound.add(name)
    inner = Names(margin, kind == "class")
    parameters, body = _parameters(rest)
    for parameter in parameters:
        words = _WORD.findall(parameter)
        if kind == "def":
            inner.bound.update(words[:1])
        scope.used.update(words[kind == "def" :])
    scopes.append(inner)
    outer, _, body = body.partition(":")
    scope.used.update(_WORD.findall(outer))
    for part in body.split(";"):
        _read_simple(part.strip(), inner)


def _read_simple(line: str, scope: Names) -> None:
    line = _CLAUSE.sub("", line, count=1)
    if found := _GLOBAL.match(line):
        scope.shared.update(_WORD.findall(found[1]))
    elif found := _IMPORT.match(line):
        scope.bound.update(word for word in _WORD.findall(found[1]) if word != "as")
        scope.imports_all |= found[1].strip() == "*"
    else:
        _read_values(line, scope)


def _read_values(line: str, scope: Names) -> None:
    """What a statement changes, gives a value and uses; a line may hold a clause and its only statement."""
    if found := _CHANGE.match(line):
        scope.changed.add(found[1])
    start = 0
    if found := _LOOP.match(line):
        scope.bound.update(_WORD.findall(found[1]))
        start = found.end()
    for named in _AS.finditer(line):
        scope.bound.update(filter(None, named.groups()))
    if _HEAD.match(line):
        at = line.rfind(":") + 1
        scope.used.update(_WORD.findall(line[start:at]))
        start = at + len(line[at:]) - len(line[at:].lstrip())
    while found := _TARGETS.match(line, start):
        scope.bound.update(_WORD.findall(found[1]))
        start = found.end()
    scope.used.update(_WORD.findall(line, start))


def _parameters(text: str) -> tuple[list[str], str]:
    """What stands between the commas of the first brackets, and the text after these."""
    if not text.startswith("("):
        return [], text
    parts, start, depth = [], 1, 0
    for found in re.finditer(r"[(\[{)\]},]", text):
        depth += (found[0] in "([{") - (found[0] in ")]}")
        if depth == 0 or (depth == 1 and found[0] == ","):
            parts.append(text[start : found.start()])
            start = found.end()
        if depth == 0:
            return parts, text[start:]
    return [*parts, text[start:]], ""


def _leave(scopes: list[Names]) -> None:
    left = scopes.pop()
    around = scopes[-1]
    (around.beyond if around.is_class and not left.is_class else around.used).update(left.free)
