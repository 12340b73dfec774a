"""Lines that a terminal breaks between words, below their own beginning."""

from rich.console import Console
from rich.padding import Padding
from rich.text import Text


def print_line(out: Console, line: str) -> None:
    """Print a line of markup; where no terminal breaks it, it stays one line for other programs."""
    if not (out.is_terminal and line):
        out.print(line, soft_wrap=True, emoji=False)
        return
    text = Text.from_markup(line, emoji=False)
    indent = len(text.plain) - len(text.plain.lstrip())
    out.print(Padding(text[indent:], (0, 0, 0, indent), expand=False), soft_wrap=False)
