"""How two prompts differ, as a person reads them."""

import difflib
import re
from collections.abc import Iterator, Sequence
from itertools import zip_longest

from proc3s import Message

_MOST_LINES = 60
_CONTROL = re.compile("[\x00-\x08\x0a-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff]")


def difference(old: Sequence[Message], new: Sequence[Message]) -> str:
    """A unified diff, message by message; what goes beyond sixty lines is counted only."""
    lines = ["--- recorded", "+++ now", *_changes(old, new)]
    if (more := len(lines) - _MOST_LINES) > 0:
        lines[_MOST_LINES:] = [f"… {more} more line{'s' if more > 1 else ''}"]
    return "\n".join(lines)


def _changes(old: Sequence[Message], new: Sequence[Message]) -> Iterator[str]:
    """The lines of the diff; messages that are equal do not appear."""
    before, after = ([(m.role, m.text) for m in messages] for messages in (old, new))
    matcher = difflib.SequenceMatcher(a=before, b=after, autojunk=False)
    for tag, first, last, begin, end in matcher.get_opcodes():
        if tag == "equal":
            continue
        for number, pair in enumerate(zip_longest(old[first:last], new[begin:end]), start=begin + 1):
            yield from _change(number, *pair)


def _change(number: int, old: Message | None, new: Message | None) -> Iterator[str]:
    """One message: a line that says which, and the diff of its text."""
    what = "only recorded" if new is None else "only now" if old is None else "changed"
    message = new or old
    yield f"== message {number}{f' ({message.role}, {message.kind})' if message else ''}: {what} =="
    yield from list(difflib.unified_diff(_lines(old), _lines(new), lineterm="", n=2))[2:]


def _lines(message: Message | None) -> list[str]:
    """The lines of a message, with what a terminal would not show or would obey written out."""
    if message is None:
        return []
    return [_CONTROL.sub(lambda c: f"\\u{ord(c[0]):04x}", line) for line in message.text.split("\n")]
