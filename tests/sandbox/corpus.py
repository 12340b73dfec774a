"""Programs in files whose header says what must happen.

# In words: what it tries.
# expect: plan | plan: FIRST PLAN | KIND [line N][: PART OF THE MESSAGE]
# friendly: the same, where it differs with the friendly layer on
# installed: the same, where shapely is installed
# answer: sketch (default) | program | plan
# scene: drawing (default) | tabletop
# log: what the first sample prints
"""

import re
from dataclasses import dataclass, replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from proc3s.sandbox import BoxedSketch, Limits, SketchError

from .conftest import program
from .tabletop import TABLETOP

FIELD = re.compile(r"^# (expect|friendly|installed|answer|scene|log): (.*)$", re.MULTILINE)
VERDICT = re.compile(r"(?P<kind>\w+)(?: line (?P<line>\d+))?(?:: (?P<text>.*))?$")
SHORT = Limits(load=1.5, call=0.5, memory=128 << 20)


@dataclass(frozen=True)
class Case:
    """A program and what must come of it."""

    name: str
    source: str
    fields: dict[str, str]

    @property
    def program(self):
        """The program in its scene."""
        scene = TABLETOP if self.fields.get("scene") == "tabletop" else {}
        # not dedented, so that line numbers are those of the file
        return replace(program("", self.fields.get("answer", "sketch"), **scene), source=self.source)


def cases(folder):
    """All programs of a folder."""
    paths = sorted((Path(__file__).parent / folder).glob("*.py"))
    texts = ((path, path.read_text(encoding="utf-8")) for path in paths)
    return [Case(path.stem, text, dict(FIELD.findall(text))) for path, text in texts]


@dataclass(frozen=True)
class Result:
    """The first error, or the plan and the printed text of the first sample."""

    kind: str
    line: int | None
    text: str
    log: str = ""


def run(case, limits, friendly):
    """Load a program, ask it for two batches of three samples, and close it."""
    try:
        with BoxedSketch(case.program, limits, friendly=friendly) as sketch:
            u = np.random.default_rng(0).random((3, sketch.space.dim))
            for _ in range(2):
                batch = sketch.plans(u)
                for error in batch.errors.values():
                    raise error
            text = "; ".join(map(str, batch.plan(0)))
            return Result("plan", None, text, batch.logs.get(0, ""))
    except SketchError as error:
        return Result(error.kind, error.line, str(error))


def _keys(friendly):
    """Fields that may hold the verdict, the closest first."""
    return ["installed"] * bool(find_spec("shapely")) + ["friendly"] * friendly + ["expect"]


def check(case, result, friendly):
    """The verdict of the header holds."""
    wanted = case.fields[next(key for key in _keys(friendly) if key in case.fields)]
    match = VERDICT.match(wanted)
    assert match, wanted
    assert result.kind == match["kind"], result
    assert match["line"] is None or result.line == int(match["line"]), result
    text = match["text"] or ""
    assert result.text == text if text and result.kind == "plan" else text in result.text, result
    assert case.fields.get("log", result.log.strip()) == result.log.strip()
    assert result.text.replace("\n", "").isprintable()
    assert len(result.text) < 20_000
