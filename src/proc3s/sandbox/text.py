"""Text that a program or a model wrote, made fit for terminals, logs, pages and prompts."""

import re
from dataclasses import dataclass
from functools import cached_property

MESSAGE_LENGTH = 600
LINE_LENGTH = 200
_INVISIBLE = re.compile(
    "[\u034f\u115f\u1160\u17b4\u17b5\u180b-\u180f\u2800\u3164\ufe00-\ufe0f\uffa0\U000e0100-\U000e01ef]"
)
"""Characters that Python takes for printable and that show nothing: fillers, joiners, variation selectors."""


def clean(text: str, length: int, keep: str = "\n\t") -> str:
    """`text` cut to `length` characters, without control, bidirectional, zero-width ones."""
    if len(text) > length:
        text = text[: length - 1] + "…"
    text = _INVISIBLE.sub("?", text)
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() or c in keep else "?" for c in text)


def message(text: str) -> str:
    """An error message of the program on one line."""
    return clean(" ".join(text[: 2 * MESSAGE_LENGTH].split()), MESSAGE_LENGTH)


def lines_of(text: str) -> list[str]:
    """The lines of a program as Python counts them: of all that break lines elsewhere, only these do."""
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


@dataclass(frozen=True)
class Source:
    """Our own copy of a program's text, to quote lines from: the worker only ever says which."""

    text: str

    @cached_property
    def lines(self) -> list[str]:
        """The lines as Python counts them."""
        return lines_of(self.text)

    def quote(self, line: int | None) -> tuple[int | None, str | None]:
        """The line number and its text, or (None, None) if the program has no such line."""
        if line is None or not 1 <= line <= len(self.lines):
            return None, None
        return line, clean(self.lines[line - 1].strip(), LINE_LENGTH)
