"""What a target does not take, and details that no margin carries, are said before anybody is asked."""

import sys

import pytest

DOMAIN = """\
spec_version: 1
name: toy
summary: Dots.
world: {target: "proc3s:World"}
state: Dots
types: {Dots: {summary: Dots., fields: {count: {type: int}}}}
skills: {add: {summary: Adds., target: "toys:add", params: {by: {type: float}}}}
samplers: [ContinuousSampler]
constraints:
  few: {says: "too many near {other}", target: "toys:few"}
tasks: {three: {instruction: Three., initial: {target: "toys:none"}, judge: [{target: "toys:fine"}]}}
budget: {paper: 10, release: 10}
"""
TOYS = """
from proc3s import Margin, Score

WORD = "no function"

def none(rng): return {"count": 0}
def add(world, by): pass
def few(transition, most=3): return Margin(1.0, {"other": "x"})
def fine(state, plan): return Score(True, "fine")
"""


@pytest.fixture(autouse=True)
def _toys_of_another_test_are_not_found(here, monkeypatch):
    monkeypatch.syspath_prepend(here)
    monkeypatch.delitem(sys.modules, "toys", raising=False)
    yield
    sys.modules.pop("toys", None)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("{other}", "{othr}", ["domain.yaml:10", "constraints.few.says", "'othr'", "did you mean 'other'?"]),
        ("toys:few", "toys:fwe", ["domain.yaml:10", "toys has no 'fwe'", "did you mean 'few'?"]),
        ("toys:few", "toys:WORD", ["domain.yaml:10", "no function or class"]),
        ("toys:few", "toys:fine", ["domain.yaml:10", "missing a required argument: 'plan'"]),
        ('toys:few"', 'toys:few", args: {msot: 3}', ["domain.yaml:10", "unexpected keyword argument 'msot'"]),
        ('toys:fine"', 'toys:fine", args: {msot: 3}', ["domain.yaml:11", "judge.0", "'msot'"]),
        ("by: {type: float}", "", ["domain.yaml:7", "skills.add", "missing a required argument: 'by'"]),
        ("toys:fine", "toys:nothing", ["domain.yaml:11", "toys has no 'nothing'"]),
    ],
)
def test_said_by_check_and_before_the_first_question(cli, here, old, new, words):
    assert old in DOMAIN
    (here / "domain.yaml").write_text(DOMAIN.replace(old, new))
    (here / "toys.py").write_text(TOYS)
    checked = cli("check", here, "--seconds", 0)
    asked = cli("run", "toy/three", "--llm", "manual:asked", "--plugin", "domain.yaml")
    assert (checked.code, asked.code) == (2, 2)
    assert not (here / "asked").exists()
    for word in words:
        assert word in " ".join(checked.stdout.split())
        assert word in asked.stderr


def test_what_fits_is_not_refused(cli, here):
    (here / "domain.yaml").write_text(DOMAIN.replace('toys:few"', 'toys:few", args: {most: 3}'))
    (here / "toys.py").write_text(TOYS)
    (here / "program.py").write_text("def gen_plan(initial):\n    return [Action('add', [1.0])]\n")
    given = ("--sketch", "program.py", "--method", "cap", "--plugin", "domain.yaml")
    assert cli("solve", "toy/three", *given).code == 0
