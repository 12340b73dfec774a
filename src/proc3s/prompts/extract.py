"""The program in a model's answer: which of its blocks define it."""

import re
import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain

from proc3s.prompts.blocks import Block, bare, fenced, marked_up
from proc3s.sandbox.errors import SketchContractError

_MARK = "\ufeff"
"""A byte-order mark: nothing that is seen, and no Python."""
_PYTHON = {"python", "python3", "py"}
_ROLES = ("gen_plan", "gen_domain")
_PROGRAM = re.compile(r"(?:async[ \t]++)?def gen_plan\b|gen_plan[ \t]*+(?::[^=\n]*+)?=(?!=)")
_DEFINITION = re.compile(
    r"^(?:(?:async[ \t]++)?def|class)[ \t]++(\w++)|^(\w++)[ \t]*+(?::[^=\n]*+)?=(?!=)"
    r"|^(?:from[ \t]++[\w.]++[ \t]++)?import[ \t]++(.*+)$",
    re.MULTILINE,
)
_STUB = re.compile(
    r"^def \w++\([^)]{0,2000}+\)[^:\n]*+:\s*+(?:#[^\n]*+\n\s*+)*+(?:\.\.\.|pass)[ \t]*+(?:#[^\n]*+)?"
    r"(?=\n++\S|\s*\Z)",
    re.MULTILINE,
)
"""A function that only says where the real one goes."""
_BINDING = re.compile(
    r"\b(?:def|class)[ \t]++(\w++)(?:\(([^)]{0,2000}+)\))?|\bfor\b([^\n:]{0,200}?)\bin\b"
    r"|^[ \t]*+([\w ,()]++)(?::[^=\n]*+)?=(?!=)",
    re.MULTILINE,
)
_USE = re.compile(r"\bgen_(?:plan|domain)[ \t]*+\(")
_WORD = re.compile(r"[^\W\d]\w*+")
_THINKING = re.compile(r"<(/?)(think|thinking|thought|reasoning)>", re.IGNORECASE)


@dataclass(frozen=True)
class Extract:
    """A program, and which blocks of the answer it was taken from where there was a choice."""

    program: str
    blocks: str = ""


def extract_program(answer: str) -> str:
    """The program in an answer. Raises SketchContractError if there is none."""
    return extract(answer).program


def extract(answer: str) -> Extract:
    """The blocks that define gen_plan and gen_domain, the last of each, with the helpers that they use.

    Blocks are fences, or else `<code>` elements, or else statements between prose. Where no block defines
    gen_plan, its python fences joined, else all fences. Raises SketchContractError if there is none.
    """
    answer = answer.replace(_MARK, "")
    fences = fenced(answer)
    for blocks in (fences, list(marked_up(answer))):
        if chosen := _chosen(blocks):
            return Extract("\n\n".join(blocks[i].code for i in chosen), _told(chosen, len(blocks)))
    if unfenced := bare(answer, _PROGRAM):
        return Extract(unfenced.code)
    code = [b.code for b in fences if b.language in _PYTHON] or [b.code for b in fences]
    if not (program := "\n\n".join(code)).strip():
        raise SketchContractError(
            "the answer contains no program: expected a ```python block that defines gen_plan"
        )
    return Extract(program)


def without_thinking(answer: str) -> str:
    """An answer less what the model thought aloud in tags before it; a tag never closed hides nothing."""
    tags = list(_THINKING.finditer(answer))
    if not tags or (not tags[0][1] and answer[: tags[0].start()].strip()):
        return answer  # it begins in no thought
    closing = [tag for tag in tags if tag[1]]
    return answer[closing[-1].end() if closing else tags[0].end() :].lstrip()


def _chosen(blocks: Sequence[Block]) -> list[int]:
    """Numbers of the blocks that make up the program, in order; none if nothing defines gen_plan."""
    defined = [_defined(block.code) for block in blocks]
    latest = {name: i for i, names in enumerate(defined) for name in names if name in _ROLES}
    if "gen_plan" not in latest:
        return []
    helping = [i for i, block in enumerate(blocks) if _may_help(block, defined[i])]
    chosen = set(latest.values())
    while more := set(_helpers(blocks, defined, chosen, helping)):
        chosen |= more
    return sorted(chosen)


def _may_help(block: Block, defined: set[str]) -> bool:
    """Whether others may use what a block defines: it is Python, and does not merely call the program."""
    called = _USE.search(_uncommented(block.code))
    return block.language in {"", *_PYTHON} and (not called or not defined.isdisjoint(_ROLES))


def _helpers(
    blocks: Sequence[Block], defined: Sequence[set[str]], chosen: set[int], helping: Sequence[int]
) -> Iterator[int]:
    """Blocks that define, last of all, a name which the chosen ones use and do not define."""
    codes = [_uncommented(blocks[i].code) for i in chosen]
    bound = set(chain.from_iterable(map(_bound, codes)))
    wanted = set(chain.from_iterable(map(_WORD.findall, codes))) - bound
    latest = {name: i for i in helping for name in defined[i] & wanted}
    yield from set(latest.values()) - chosen


def _defined(code: str) -> set[str]:
    """Names that code defines at its left margin, as Python reads them."""
    code = _STUB.sub("", unicodedata.normalize("NFKC", code))
    found = _DEFINITION.findall(code)
    return {name for function, variable, modules in found for name in (function, variable) if name} | {
        name for *_, modules in found for name in _WORD.findall(modules)
    }


def _bound(code: str) -> Iterator[str]:
    """Names that code gives a value anywhere: definitions, parameters, assignments, loops."""
    for found in _BINDING.finditer(code):
        yield from _WORD.findall(" ".join(filter(None, found.groups())))


def _uncommented(code: str) -> str:
    return re.sub(r"#[^\n]*+", "", code)


def _told(chosen: Sequence[int], count: int) -> str:
    """Which blocks were taken, where not all were."""
    if len(chosen) == count:
        return ""
    numbers = [str(i + 1) for i in chosen]
    listed = " and ".join(filter(None, [", ".join(numbers[:-1]), numbers[-1]]))
    return f"block{'s' if len(chosen) > 1 else ''} {listed} of {count}"
