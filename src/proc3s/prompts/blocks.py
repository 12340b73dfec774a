"""The blocks of code in a model's answer, found line by line: nothing here parses or compiles code."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from proc3s.sandbox.text import lines_of

# possessive, and blank within a line: no answer, however long, makes them search long
_OPENING = re.compile(
    r"(?P<before>(?:[^`~]|`{1,2}+(?!`)|~{1,2}+(?!~))*+)(?P<fence>`{3,}+|~{3,}+)[ \t]*+"
    r"(?P<language>[\w+#.-]*+)(?P<rest>[^`]*+)$"
)
_CONTAINER = re.compile(r"(?:[ \t]|>|[-+](?=[ \t])|\d++[.)](?=[ \t])|[*_])*+$")
"""Quote, list or emphasis: what may stand before a fence that begins a line."""
_INTRODUCED = (":", ".", "!", "*", "_")
_CODE = re.compile(r"[ \t]*+((?:import|from|def|class|async)[ \t]|gen_plan[ \t]*+[=:])")
_ONE_LINE = re.compile(
    r"(?<!`)`{3,}+[ \t]*+(?:python3?|py)?[ \t]*+(?P<code>gen_plan[ \t]*+(?::[^=`]*+)?=[^`]*+)`{3}"
)
_QUOTE_MARK = re.compile(r"""\\.|\"{3}|'{3}|["'#]""")
_STATEMENT = re.compile(
    r"""import[ ][\w., ]++$|from[ ][\w.]++[ ]import[ ]|(?:async[ ])?def[ ]\w|class[ ]\w++[(:]|@\w
    |(?:for|while|if|elif|with)[ ].*:|(?:else|try|finally|except)\b.*:|(?:assert|del|raise|pass|return)\b
    |[)\]}"'#]|[\w.]++(?:\[[^]]*+\])?(?:\ ?:[ ][\w.\[\], |]++)?[ ]?[-+*/|&]?=(?!=)
    |[\w.]++\(.*[(\[{,)][ \t]*$""",
    re.VERBOSE,
)
_ENTITIES = {"&lt;": "<", "&gt;": ">", "&quot;": '"', "&#39;": "'", "&amp;": "&"}


@dataclass(frozen=True)
class Block:
    """A block of code and the language that it is said to be, in lower case."""

    language: str
    code: str


def fenced(text: str) -> list[Block]:
    """The blocks in fences; one that is never closed reaches to the next opening, or to the end."""
    lines, blocks, at = lines_of(text), [], 0
    strings = True
    while at < len(lines):
        if inline := _ONE_LINE.search(lines[at]):
            blocks.append(Block("python", inline["code"]))
        elif opening := _opening(lines[at]):
            depth = opening["before"].count(">")
            fence, first = opening["fence"], _first_line(opening)
            end, strings = _end(lines, at + 1, fence, depth, strings)
            inner = [_unquoted(line, depth) for line in lines[at + 1 : end]]
            if end < len(lines) and not _opening(lines[end], named=True):
                inner.append(_before_fence(lines[end], fence))
                end += 1
            language = "" if first and not first[1] else opening["language"].lower()
            blocks.append(Block(language, _flush_left([first[0], *inner] if first else inner)))
            at = end
            continue
        at += 1
    return blocks


def marked_up(text: str) -> Iterator[Block]:
    """What stands in `<code>` elements."""
    at = 0
    while (start := text.find("<code", at)) >= 0 and (begin := text.find(">", start) + 1):
        end = text.find("</code>", begin)
        end = len(text) if end < 0 else end
        code = text[begin:end]
        for entity, character in _ENTITIES.items():
            code = code.replace(entity, character)
        yield Block("", _flush_left(lines_of(code)))
        at = end


def bare(text: str, first: re.Pattern[str]) -> Block | None:
    """The statements of a text without fences, less the prose around them; None unless `first` is found."""
    lines = lines_of(text)
    margin = next((_margin(line) for line in lines if first.match(line.lstrip(" \t"))), None)
    if margin is None:
        return None
    kept, keeping, quote = [], False, None
    for line in lines:
        if quote is None and line.strip() and _margin(line) <= margin:
            keeping = bool(_STATEMENT.match(line[margin:]))
        if keeping:
            kept.append(line)
            quote = _open_string(line, quote)
        elif kept and not line.strip():
            kept.append("")
    return Block("", _flush_left(kept).rstrip("\n"))


def _opening(line: str, named: bool = False) -> re.Match[str] | None:
    """The line as one that opens a block; `named` wants a language and nothing before."""
    found = _OPENING.match(line)
    if not found:
        return None
    before, language = found["before"], found["language"]
    if _CONTAINER.match(before):
        return found if language or not named else None
    if named or found["fence"][0] == "~" or found["rest"].strip():
        return None
    return found if language or before.rstrip().endswith(_INTRODUCED) else None


def _first_line(opening: re.Match[str]) -> tuple[str, bool] | None:
    """Code that follows the fence on its line, and whether a language stood between them."""
    whole = opening["language"] + opening["rest"]
    if _CODE.match(whole):
        return whole, False
    return (opening["rest"].lstrip(), True) if _CODE.match(opening["rest"]) else None


def _end(lines: list[str], start: int, fence: str, depth: int, strings: bool) -> tuple[int, bool]:
    """Where a block ends: the first fence that is in no string of the code.

    A string that is never closed is none, so the first fence in it counts. Without `strings` they are not
    looked at; so it is once they have misled, and no answer is read often.
    """
    quote: str | None = None
    within: int | None = None  # the first fence in the string that is open
    for at in range(start, len(lines)):
        line = _unquoted(lines[at], depth)
        if _closes(line, fence):
            if quote is None:
                return at, strings
            within = at if within is None else within
        elif quote is None and _opening(line, named=True):
            return at, strings
        quote = _open_string(line, quote) if strings else None
        within = within if quote else None
    return (len(lines), strings) if within is None else (within, False)


def _closes(line: str, fence: str) -> bool:
    """Whether a line is a closing fence, or code that ends in one."""
    mark = line.rstrip(" \t*_")
    if len(mark) - len(mark.rstrip(fence[0])) < len(fence):
        return False
    before = _before_fence(line, fence)
    return not before or (fence[0] == "`" and "`" not in before and "#" not in before)


def _before_fence(line: str, fence: str) -> str:
    """The code that ends on the line of a closing fence."""
    before = line.rstrip(" \t*_").rstrip(fence[0])
    return before if before.strip(" \t>*_") else ""


def _open_string(line: str, quote: str | None) -> str | None:
    """The marks of the string that is still open after a line, if it is one of several lines."""
    for found in _QUOTE_MARK.finditer(line):
        mark = found[0]
        if quote:
            quote = None if mark.startswith(quote) else quote
        elif mark == "#":
            break
        elif mark[0] != "\\":
            quote = mark
    return quote if quote and len(quote) == 3 else None


def _unquoted(line: str, depth: int) -> str:
    """A line without the marks of so many quotes around it."""
    for _ in range(depth):
        inner = line.lstrip(" \t")
        if not inner.startswith(">"):
            break
        line = inner[1:].removeprefix(" ")
    return line


def _margin(line: str) -> int:
    return len(line) - len(line.lstrip(" \t"))


def _flush_left(lines: list[str]) -> str:
    """Code moved left until its first line begins there; text in strings may begin further left."""
    margin = next((_margin(line) for line in lines if line.strip()), 0)
    moved = (line[min(margin, _margin(line)) :] if line.strip() else "" for line in lines)
    return "\n".join(moved).strip("\n")
