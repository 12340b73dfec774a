"""Worked examples of a domain, turn by turn."""

import re
from pathlib import Path

from proc3s.errors import Issue, SpecError
from proc3s.search.problem import Problem
from proc3s.specs.domain import ExampleSpec
from proc3s.textfiles import read_text

_TURN = re.compile(r"^<!-- (answer|feedback) -->\n", re.MULTILINE)


def example_turns(problem: Problem, example: ExampleSpec, kind: str) -> list[tuple[str, str]]:
    """(answer | feedback, text) of a worked example for one kind of answer, in order.

    They stand in `examples/NAME.KIND.md`; a line `<!-- feedback -->` or `<!-- answer -->` starts a turn.
    """
    folder = problem.domain.spec.folder or Path()
    path = folder / "examples" / f"{example.name}.{kind}.md"
    if not path.is_file():
        raise SpecError([Issue(str(path), f"examples.{example.name}", "is missing")])
    parts = _TURN.split("<!-- answer -->\n" + read_text(path))[1:]
    return [(turn, text.strip() + "\n") for turn, text in zip(parts[::2], parts[1::2], strict=True)]
