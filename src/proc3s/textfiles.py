"""Text files as people write them: with the marks and line ends that their editors put in."""

import codecs
import io
from pathlib import Path

_MARKS = {
    codecs.BOM_UTF8: "utf-8-sig",
    codecs.BOM_UTF16_LE: "utf-16",
    codecs.BOM_UTF16_BE: "utf-16",
}


def read_text(path: Path) -> str:
    """The text of a file, without a byte-order mark, lines ended by a line feed.

    UTF-8, or UTF-16 where a mark says so. Raises OSError, or UnicodeDecodeError if it is no text.
    """
    return decoded(path.read_bytes())


def decoded(data: bytes) -> str:
    """The same of the bytes of a file. Raises UnicodeDecodeError."""
    encoding = next((name for mark, name in _MARKS.items() if data.startswith(mark)), "utf-8")
    return io.StringIO(data.decode(encoding), newline=None).getvalue()
