"""The program in a model's answer: which of its blocks define it."""

import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain

from proc3s.prompts.blocks import Block, bare, fenced, marked_up
from proc3s.prompts.names import Names, names_of, unquoted
from proc3s.sandbox.errors import SketchContractError

_MARK = "\ufeff"
"""A byte-order mark: nothing that is seen, and no Python."""
_PYTHON = {"python", "python3", "py"}
_ROLES = ("gen_plan", "gen_domain")
_PROGRAM = re.compile(r"(?:async[ \t]++)?def gen_plan\b|gen_plan[ \t]*+(?::[^=\n]*+)?=(?!=)")
_DEFINITION = re.compile(
    r"^(?:(?:async[ \t]++)?def|class)[ \t]++(\w++)|^(\w++)[ \t]*+(?::[^=\n]*+)?=(?!=|[ \t]*+None\b)"
    r"|^(?:from[ \t]++[\w.]++[ \t]++)?import[ \t]++(.*+)$",
    re.MULTILINE,
)
_STUB = re.compile(
    r"^def \w++\([^)]{0,2000}+\)[^:\n]*+:\s*+(?:#[^\n]*+\n\s*+)*+"
    r"(?:(?:\"{3}(?:(?!\"{3})[\s\S]){0,2000}+\"{3}|'{3}(?:(?!'{3})[\s\S]){0,2000}+'{3}|\"[^\"\n]++\"|'[^'\n]++')\s*+)?+"
    r"(?:#[^\n]*+\n\s*+)*+(?:\.\.\.|pass|raise NotImplementedError[^\n#]*+)[ \t]*+(?:#[^\n]*+)?"
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
_CODE = re.compile(
    r"^[ \t>]*+(?:`{3}|~{3})|^[ \t]*+(?:async[ \t]++)?def gen_|^gen_plan[ \t]*+=", re.MULTILINE
)
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
    cut, depth = 0, 0
    for tag in tags:
        if cut and not depth and _CODE.search(answer, cut, tag.start()):
            break  # the program has begun
        depth = max(depth - 1, 0) if tag[1] else depth + 1
        cut = tag.end() if tag[1] else cut
    return answer[cut or tags[0].end() :].lstrip()


@dataclass(frozen=True)
class _Part:
    """A block as a part of the program: what it defines at its margin, and its names as they are read."""

    block: Block
    defined: set[str]
    names: Names

    @property
    def is_version(self) -> bool:
        """Whether it defines gen_plan or gen_domain: where it is not the last that does, it is a draft."""
        return not self.defined.isdisjoint(_ROLES)

    @property
    def may_help(self) -> bool:
        """Whether others may use what it defines: it is Python, and does not merely call the program."""
        called = _USE.search(unquoted(self.block.code))
        return self.block.language in {"", *_PYTHON} and (not called or self.is_version)


def _chosen(blocks: Sequence[Block]) -> list[int]:
    """Numbers of the blocks that make up the program, in order; none if nothing defines gen_plan."""
    parts = [_Part(block, _defined(block.code), names_of(block.code)) for block in blocks]
    latest: dict[str, int] = {}
    for i in sorted(range(len(parts)), key=lambda i: (blocks[i].language in _PYTHON, i)):
        latest.update(dict.fromkeys(parts[i].defined.intersection(_ROLES), i))
    if "gen_plan" not in latest:
        return []
    helping = {i: part for i, part in enumerate(parts) if part.may_help}
    chosen, last = set(latest.values()), max(latest.values())
    while more := set(_helpers(parts, chosen, helping, last)) - chosen:
        chosen |= more
    return sorted(chosen)


def _helpers(
    parts: Sequence[_Part], chosen: set[int], helping: Mapping[int, _Part], last: int
) -> Iterator[int]:
    """Blocks that define, last of all, a name which the chosen ones use and do not define.

    A draft helps only with what nothing chosen binds anywhere; any other block before the program's `last`
    helps with whatever a scope of it may use, by what it binds, changes or imports unnamed.
    """
    taken = [parts[i] for i in chosen]
    codes = [_uncommented(part.block.code) for part in taken]
    surely = set(chain.from_iterable(map(_WORD.findall, codes)))
    given = set(chain.from_iterable(part.names.bound for part in taken))
    surely -= given.union(*map(_bound, codes))
    needed = set(chain.from_iterable(part.names.free for part in taken))
    wanted = needed - given
    latest: dict[str, int] = {}
    for i, part in helping.items():
        found = part.defined & surely
        if not part.is_version:
            found |= part.names.bound & (surely | wanted if i < last else surely)
        latest.update(dict.fromkeys(found, i))
    yield from latest.values()
    bound = {name: i for i in sorted(chosen) for name in parts[i].names.bound & needed}
    for i, part in helping.items():
        if i < last and not part.is_version:
            changes = part.names.changed & needed
            if part.names.imports_all or any(bound.get(name, i) < i for name in changes):
                yield i


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
