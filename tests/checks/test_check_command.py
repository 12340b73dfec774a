"""`proc3s check`: what it finds in domains that are wrong in one way each, and how it says it."""

import re
import shutil
import sys
from pathlib import Path

import pytest

PUSH = Path(__file__).parents[1] / "example_plugin" / "proc3s_push"


@pytest.fixture
def push(here, monkeypatch):
    """A copy of the push domain to be broken; returns its folder. Its modules are imported anew."""
    for name in [name for name in sys.modules if name.startswith("proc3s_push")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(sys, "path", list(sys.path))
    shutil.copytree(PUSH, here / "proc3s_push", ignore=shutil.ignore_patterns("__pycache__"))
    yield here / "proc3s_push"
    for name in [name for name in sys.modules if name.startswith("proc3s_push")]:
        del sys.modules[name]


def replaced(path, old, new):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def test_a_sound_domain_is_fine_in_every_way(push, cli):
    result = cli("check", push)
    assert (result.code, "push: 0 errors, 0 notes" in result.stdout) == (0, True), result.stdout
    assert result.stdout.count("fine ") == 12
    assert cli("check", push / "domain.yaml", "--json").json == {
        "domain": "push",
        "errors": 0,
        "findings": [],
        "facts": [],
    }


BROKEN = {
    "targets": ("domain.py", "def on_table(", "def off_table(", "proc3s_push.domain has no 'on_table'"),
    "scenes": (
        "domain.py",
        "rng.permutation(spots)",
        "np.random.permutation(spots)",
        "another one when it is drawn",
    ),
    "scenes, infinite": ("domain.py", '"half": HALF', '"half": float("inf")', "a finite number"),
    "prompts": ("domain.yaml", "  aside:\n", "  beside:\n", "beside.sketch.md"),
    "programs": (
        "answers/gather.proc3s.md",
        "ContinuousSampler(0.08, 0.19)",
        "ContinuousSampler(0.3, 0.4)",
        "of gather",
    ),
    "steps": (
        "domain.py",
        "    moved = [",
        "    world.count = getattr(world, 'count', 0) + 1\n    dx += 1e-6 * world.count\n    moved = [",
        "in a world that was used before",
    ),
    "snapshots": (
        "domain.py",
        "    moved = [",
        "    world.count = getattr(world, 'count', 0) + 1\n    dx += 1e-6 * world.count\n    moved = [",
        "from its snapshot",
    ),
    "margins": (
        "domain.py",
        "Margin(transition.after.half - ",
        "Margin(float('inf') - ",
        "margin of on_table is inf",
    ),
    "judges": ("domain.yaml", "{reach: 0.2}", "{reach: 2.0}", "fulfils it already"),
    "screens": (
        "domain.yaml",
        "samplers: [Con",
        'screens: [{name: never, target: "proc3s_push.never:never"}]\nsamplers: [Con',
        "never rejects what the world accepts",
    ),
}
NEVER = """
from proc3s import Violation


def never(state, batch):
    return [Violation("apart", 0, "push", -1.0, "never")] * len(batch)
"""


def _marked(case):
    """A check of everything takes seconds, twice; a few show that it works."""
    return pytest.param(case, marks=[] if case in ("targets", "judges") else [pytest.mark.slow])


@pytest.mark.parametrize("check", map(_marked, BROKEN))
def test_what_is_wrong_is_found_with_its_place_and_how_to_fix_it(check, push, cli):
    name, old, new, words = BROKEN[check]
    check = check.partition(",")[0]
    replaced(push / name, old, new)
    (push / "never.py").write_text(NEVER)
    result = cli("check", push, "--json")
    if check == "targets":  # the spec's targets are looked at before it is a domain at all
        assert (result.code, words in result.stderr + result.stdout) == (2, True), result.stdout
        return
    assert result.code == 2
    findings = [f for f in result.json["findings"] if f["check"] == check and f["level"] == "error"]
    assert any(words in f["text"] + f["where"] for f in findings), result.json["findings"]
    for finding in findings:
        assert re.search(r"\.py:\d+$|domain\.yaml$|\.md$", finding["where"]), finding["where"]
        assert finding["why"]
        assert finding["mend"]
    shown = cli("check", push)
    assert (shown.code, f"wrong  {check}" in shown.stdout, "fix   " in shown.stdout) == (2, True, True)


def test_a_skill_nobody_uses_is_a_note(push, cli):
    replaced(
        push / "domain.yaml",
        "samplers: [Con",
        '  nudge: {summary: Nudges., target: "proc3s_push.domain:push", '
        "params: {puck: {type: object}, dx: {type: float}, dy: {type: float}}}\nsamplers: [Con",
    )
    result = cli("check", push, "--json")
    assert result.code == 0
    assert [f["text"] for f in result.json["findings"]] == ["no bundled program uses the skill nudge"]


@pytest.mark.parametrize(
    ("what", "words"),
    [
        ("drawin", "there is no domain 'drawin'; did you mean 'drawing'?"),
        ("nowhere/domain.yaml", "there is no file or folder"),
        (".", "has no domain.yaml"),
    ],
)
def test_what_is_not_there_is_said(what, words, cli):
    result = cli("check", what)
    assert (result.code, words in result.stderr) == (2, True)
