"""Cassettes: append-only files of JSON entries whose texts can be read line by line in a diff.

A cassette is UTF-8 with one JSON value a line:

    {"format": "proc3s cassette", "version": 1}     the first line
    {"text": "<SHA-256>"}                           a text begins that the cassette does not have yet
    "Draw a star."                                  its lines; joined by line feeds they are the text
    "Use five lines."
    {"entry": {…, "text": "<SHA-256>", …}}          an entry; wherever it has a key `text`, it names a text

An entry counts once its line is there. So a process that is killed loses the entry that it was writing and no
other; what it left behind is ignored, and cleared away by the next append.
"""

import errno
import fcntl
import hashlib
import json
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from proc3s.llm.errors import LLMError

_VERSION = 1
_HEADER = b'{"format": "proc3s cassette", "version": 1}\n'
# What JSON allows as it is, but editors take for the end of a line, or UTF-8 cannot express.
_ESCAPED = re.compile("[\x7f-\x9f\u2028\u2029\ud800-\udfff]")
# JSON takes two surrogates side by side for one character, so they are kept in strings of their own.
_BETWEEN_SURROGATES = re.compile("(?<=[\ud800-\udbff])(?=[\udc00-\udfff])")


@dataclass(frozen=True)
class Entry:
    """An entry with its texts, and the line of the file that it stands in."""

    line: int
    value: dict[str, Any]


class Cassette:
    """A cassette at a path, which need not exist. Threads and processes may append at the same time."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._reader: _Reader | None = None

    def entries(self) -> list[Entry]:
        """All whole entries, oldest first.

        Raises LLMError, naming file and line, if it is damaged or of an unknown version; OSError.
        """
        with self.path.open("rb") as file:
            fcntl.flock(file, fcntl.LOCK_SH)
            return _Reader(self.path).read(file.read()).entries

    def append(self, value: dict[str, Any]) -> None:
        """Add an entry, and those of its texts that are new. Raises like `entries`."""
        with self.path.open("a+b", buffering=0) as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            file.seek(0)
            there = self._read_on(file.readall())
            file.truncate(len(there.whole))
            data = there.opening() + b"".join(_lines(value, there.texts))
            if file.write(data) != len(data):
                raise OSError(errno.ENOSPC, "the entry was written in part only")

    def _read_on(self, data: bytes) -> "_Reader":
        """What is in the file. Only what is new since the last append is parsed."""
        reader, self._reader = self._reader, None  # one that meets damage is not used again
        if reader is None or reader.opening() or not data.startswith(reader.whole):
            reader = _Reader(self.path)
        self._reader = reader.read(data)
        return reader


class _Reader:
    """The content of a cassette, up to the end of its last whole entry."""

    def __init__(self, path: Path) -> None:
        self.entries: list[Entry] = []
        self.texts: dict[str, str] = {}
        self.whole = b""
        self._path = path
        self._number = 0  # of the last line of `whole`
        self._fresh: dict[str, str] = {}  # texts of the entry to come
        self._name, self._begun, self._lines = "", 0, list[str]()  # the text that is being read

    def read(self, data: bytes) -> "_Reader":
        """Go on to the end of the file, of which `whole` is known. Raises LLMError."""
        self._fresh, self._begun = {}, 0
        *lines, last = data[len(self.whole) :].split(b"\n")
        if last and not _is_cut(last):
            lines.append(last)
        elif not self.whole and not lines and not _HEADER.startswith(last):
            raise self._foreign()
        end = whole = len(self.whole)
        for number, line in enumerate(lines, start=self._number + 1):
            end += len(line) + 1
            if self._take(number, self._parse(number, line)):
                self._number, whole = number, end
        self.whole = data[:whole]
        return self

    def opening(self) -> bytes:
        """What has to be written before the next entry."""
        return b"" if self.whole.endswith(b"\n") else b"\n" if self.whole else _HEADER

    def _parse(self, number: int, line: bytes) -> Any:
        try:
            return json.loads(line.decode("utf-8-sig" if number == 1 else "utf-8"))
        except (ValueError, RecursionError) as error:
            raise self._foreign() if number == 1 else self._damaged(number, f"no JSON: {error}") from error

    def _take(self, number: int, value: Any) -> bool:
        """Take in a line. Whether nothing is lost if the file ends after it."""
        match value:
            case {"format": "proc3s cassette"} if number == 1:
                self._check_version(value)
                return True
            case _ if number == 1:
                raise self._foreign()
            case {"text": str(name)} if len(value) == 1:
                self._finish_text()
                self._name, self._begun, self._lines = name, number, []
            case {"entry": dict(entry)} if len(value) == 1:
                self._finish_text()
                self.texts |= self._fresh
                self.entries.append(Entry(number, self._with_texts(number, entry)))
                self._fresh = {}
                return True
            case str() if self._begun:
                self._lines.append(value)
            case list() if self._begun and all(isinstance(part, str) for part in value):
                self._lines.append("".join(value))
            case _:
                raise self._damaged(number, "neither a text nor an entry")
        return False

    def _finish_text(self) -> None:
        if not self._begun:
            return
        text = "\n".join(self._lines)
        if _sha256(text) != self._name:
            raise self._damaged(self._begun, "the text that begins here has another SHA-256")
        self._fresh[self._name] = text
        self._begun = 0

    def _with_texts(self, number: int, entry: dict[str, Any]) -> Any:
        try:
            return _replace_texts(entry, self.texts.__getitem__)
        except (KeyError, TypeError) as error:
            raise self._damaged(number, f"there is no text {error}") from error

    def _check_version(self, header: dict[str, Any]) -> None:
        if (version := header.get("version")) != _VERSION:
            raise LLMError(
                f"{self._path}:1: a cassette of version {version}, and this proc3s knows version {_VERSION}; "
                "use the proc3s that wrote it, or record anew"
            )
        if len(header) != 2:
            raise self._foreign()

    def _foreign(self) -> LLMError:
        return LLMError(f"{self._path}:1: not a cassette; its first line would be {_HEADER.decode().strip()}")

    def _damaged(self, number: int, what: str) -> LLMError:
        return LLMError(
            f"{self._path}:{number}: the cassette is damaged ({what}); cassettes are not edited by hand: "
            "restore the file, or record anew"
        )


def _is_cut(last: bytes) -> bool:
    """Whether a line that has no end is not all there either."""
    try:
        json.loads(last.decode("utf-8"))
    except (ValueError, RecursionError):
        return True
    return False


def _lines(value: dict[str, Any], known: dict[str, str]) -> Iterator[bytes]:
    """The lines of an entry, those of its new texts first."""
    fresh: dict[str, str] = {}

    def name(text: str) -> str:
        fresh[_sha256(text)] = text
        return _sha256(text)

    entry = _replace_texts(value, name)
    for sha256, text in fresh.items():
        if sha256 not in known:
            yield _dump({"text": sha256})
            yield from map(_text_line, text.split("\n"))
    yield _dump({"entry": entry})


def _text_line(line: str) -> bytes:
    parts = _BETWEEN_SURROGATES.split(line)
    return _dump(parts if len(parts) > 1 else line)


def _dump(value: Any) -> bytes:
    """One line of JSON."""
    text = json.dumps(value, ensure_ascii=False, allow_nan=False)
    return _ESCAPED.sub(lambda found: f"\\u{ord(found[0]):04x}", text).encode() + b"\n"


def _replace_texts(value: Any, new: Callable[[str], str]) -> Any:
    """A copy of JSON data in which all values of keys `text` are replaced."""
    if isinstance(value, dict):
        return {k: new(v) if k == "text" else _replace_texts(v, new) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_replace_texts(item, new) for item in value]
    return value


def _sha256(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()
