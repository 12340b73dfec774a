"""The program in a model's answer."""

import re
from collections.abc import Iterator
from textwrap import dedent

from proc3s.sketch.errors import SketchContractError

# possessive, and blank within a line: no answer, however long, makes them search long
_OPENING = re.compile(r"\s*+(?P<fence>`{3,}+|~{3,}+)\s*+(?P<language>[\w+.-]*+)[^`]*+$")
_PYTHON = {"python", "python3", "py"}
_PROGRAM = re.compile(r"^[ \t]*+(def gen_plan\b|gen_plan[ \t]*+(:[^=\n]*+)?=)", re.MULTILINE)


def extract_program(answer: str) -> str:
    """The program in an answer: its python fences joined, else all fences, else the text if it is a program.

    Raises SketchContractError if there is none.
    """
    fences = list(_fences(answer))
    program = "\n\n".join(
        [code for language, code in fences if language in _PYTHON] or [c for _, c in fences]
    )
    if not program.strip() and _PROGRAM.search(answer):
        program = answer
    if not program.strip():
        raise SketchContractError(
            "the answer contains no program: expected a ```python block that defines gen_plan"
        )
    return program


def _fences(answer: str) -> Iterator[tuple[str, str]]:
    """Language and code of each fenced block; one that is never closed reaches to the end."""
    lines = iter(answer.splitlines())
    for line in lines:
        if opening := _OPENING.match(line):
            code = []
            for inner in lines:
                if _closes(inner, opening["fence"]):
                    break
                code.append(inner)
            yield opening["language"].lower(), dedent("\n".join(code)).strip("\n")


def _closes(line: str, fence: str) -> bool:
    mark = line.strip()
    return len(mark) >= len(fence) and set(mark) == {fence[0]}
