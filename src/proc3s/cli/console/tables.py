"""Tables that a terminal can show: one that is too wide is turned, or its columns stand in parts."""

from collections.abc import Iterator, Sequence

from rich.console import Console
from rich.markup import escape
from rich.table import Table

Lines = Sequence[Sequence[str]]
_UNBOUNDED = 100_000


def print_table(out: Console, head: Sequence[str], lines: Lines, keys: int = 1) -> None:
    """Print a table within the width; the first `keys` columns say what a line is of.

    A cell in `**` is bold. Nothing is cut.
    """
    if _fits(out, head, lines):
        out.print(_table(head, lines))
    elif keys == 1 and _fits(out, *_turned(head, lines)):
        out.print(_table(*_turned(head, lines)))
    else:
        for part in _parts(out, head, lines, keys):
            out.print(_table([head[k] for k in part], [[line[k] for k in part] for line in lines]))


def _turned(head: Sequence[str], lines: Lines) -> tuple[list[str], Lines]:
    """Lines as columns."""
    rows = [[name, *(line[k] for line in lines)] for k, name in enumerate(head)]
    return rows[0], rows[1:]


def _parts(out: Console, head: Sequence[str], lines: Lines, keys: int) -> Iterator[list[int]]:
    """Columns that go side by side: the keys, and as many others as there is room for."""
    part = list(range(keys))
    for column in range(keys, len(head)):
        wider = [*part, column]
        if len(part) > keys and not _fits(
            out, [head[k] for k in wider], [[x[k] for k in wider] for x in lines]
        ):
            yield part
            wider = [*range(keys), column]
        part = wider
    yield part


def _fits(out: Console, head: Sequence[str], lines: Lines) -> bool:
    """Whether no cell must be broken."""
    return out.measure(_table(head, lines), options=out.options.update_width(_UNBOUNDED)).maximum <= out.width


def _table(head: Sequence[str], lines: Lines) -> Table:
    table = Table(box=None, pad_edge=False)
    for name in head:
        table.add_column(escape(name), overflow="fold")
    for line in lines:
        table.add_row(*map(_marked, line))
    return table


def _marked(cell: str) -> str:
    return f"[bold]{escape(cell[2:-2])}[/]" if cell.startswith("**") else escape(cell)
