"""`proc3s check`: what it finds in domains that are wrong in one way each, and how it says it."""

import re
import shlex
import shutil
import sys
from pathlib import Path

import pytest

from proc3s.checks import judging
from proc3s.checks.domain import CHECKS, examine_one
from proc3s.checks.subject import Subject
from proc3s.plugins.registry import open_registry

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
    assert result.stdout.count("fine ") == 13
    assert cli("check", push / "domain.yaml", "--json").json == {
        "domain": "push",
        "errors": 0,
        "findings": [],
        "unchecked": {},
        "facts": [],
    }


def test_a_folder_called_like_a_known_domain_does_not_hide_it(push, cli, here):
    (here / "push").mkdir()
    known = cli("check", "push", "--plugin", push, "--seconds", 1)
    assert (known.code, "push: 0 errors" in known.stdout) == (0, True), known.stderr
    assert "push has no domain.yaml" in cli("check", "./push").stderr


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
        "domain.yaml",
        "proc3s.domain.world:World",
        "proc3s_push.worlds:Forgetful",
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
WORLDS = """
from dataclasses import replace

from proc3s import World


class Broken(World):
    def place(self, state):
        raise RuntimeError("no simulator")


class Forgetful(World):
    def place(self, state):
        super().place(state)
        self.steps = 0

    def step(self, action):
        self.steps += 1
        done = super().step(action)
        return replace(done, after=replace(done.after, half=done.after.half + 1e-6 * self.steps))
"""
NEVER = """
from proc3s import Violation


def never(state, batch):
    return [Violation("apart", 0, "push", -1.0, "never")] * len(batch)
"""


def _marked(case):
    """A check of everything takes seconds, twice; a few show that it works."""
    return pytest.param(case, marks=[] if case == "targets" else [pytest.mark.slow])


@pytest.mark.parametrize("check", [_marked(case) for case in BROKEN])
def test_what_is_wrong_is_found_with_its_place_and_how_to_fix_it(check, push, cli):
    name, old, new, words = BROKEN[check]
    check = check.partition(",")[0]
    replaced(push / name, old, new)
    (push / "never.py").write_text(NEVER)
    (push / "worlds.py").write_text(WORLDS)
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


AFTER_STEPS = {"snapshots", "margins", "programs"}
CAUSES = {
    "a judge that raises": (
        "domain.py",
        "def gathered(state, plan, reach):",
        "def gathered(state, plan, reach):\n    raise KeyError(state.pucks[0].x)",
        ("judges", "raised KeyError"),
        {"programs"},
    ),
    "a world whose reset fails": (
        "domain.yaml",
        "proc3s.domain.world:World",
        "proc3s_push.worlds:Broken",
        ("steps", "raised RuntimeError: no simulator"),
        AFTER_STEPS,
    ),
    "a constraint that raises": (
        "domain.py",
        "def on_table(transition):",
        "def on_table(transition):\n    1 / 0",
        ("steps", "raised ZeroDivisionError"),
        AFTER_STEPS,
    ),
    "a scene that raises": (
        "domain.py",
        "rng.permutation(spots)",
        "rng.permute(spots)",
        ("scenes", "has no attribute 'permute'"),
        {"states", "prompts", "judges", "skills", "refusals", "steps", "screens", *AFTER_STEPS},
    ),
    "a world that counts": (
        "domain.py",
        "    moved = [",
        "    world.count = getattr(world, 'count', 0) + 1\n    dx += 1e-6 * world.count\n    moved = [",
        ("steps", "in a world that was used before"),
        {"snapshots", "programs"},
    ),
    "a screen that is wrong": (
        "domain.yaml",
        "samplers: [Con",
        'screens: [{name: never, target: "proc3s_push.never:never"}]\nsamplers: [Con',
        ("screens", "never rejects what the world accepts"),
        {"programs"},
    ),
    "a program that does not load": (
        "answers/gather.proc3s.md",
        "def gen_plan(",
        "def gen_plan((",
        ("programs", "SyntaxError"),
        set(),
    ),
}


def _some(cause):
    """Two show that it works; each starts processes."""
    fast = ("a judge that raises", "a scene that raises")
    return pytest.param(cause, marks=[] if cause in fast else [pytest.mark.slow])


@pytest.mark.parametrize("cause", [_some(cause) for cause in CAUSES])
def test_one_cause_is_one_finding(cause, push, cli):
    name, old, new, (check, words), unchecked = CAUSES[cause]
    replaced(push / name, old, new)
    (push / "never.py").write_text(NEVER)
    (push / "worlds.py").write_text(WORLDS)
    result = cli("check", push, "--json")
    (found,) = result.json["findings"]
    assert (result.code, found["check"], words in found["text"]) == (2, check, True), found
    assert set(result.json["unchecked"]) == unchecked


def test_without_programs_there_is_one_note(push, cli):
    shutil.rmtree(push / "answers")
    spec = push / "domain.yaml"
    spec.write_text(spec.read_text().partition("examples:")[0])
    result = cli("check", push)
    assert (result.code, "push: 0 errors, 1 note, 5 checks not made" in result.stdout) == (0, True)
    assert "open   steps" in result.stdout
    assert "not checked: no program is bundled, see programs" in result.stdout


@pytest.mark.slow
def test_a_program_is_searched_as_a_run_would(push, cli):
    """A plan is found however many samples it takes; if none is, the samples and the command are said."""
    answer = push / "answers/gather.proc3s.md"
    replaced(answer, "ContinuousSampler(0.08, 0.19)", "ContinuousSampler(0.1995, 0.4)")
    replaced(push / "domain.yaml", "paper: 1000", "paper: 7")
    (found,) = cli("check", push, "--json").json["findings"]
    assert "after 7 samples of seed 0" in found["text"]
    command = found["mend"].partition("this runs it: proc3s ")[2]
    assert "after" not in command
    assert cli(*shlex.split(command)).code == 1
    replaced(push / "domain.yaml", "paper: 7", "paper: 1000")
    assert cli(*shlex.split(command)).code == 0
    assert cli("check", push, "--json").json["findings"] == []


@pytest.mark.slow
def test_the_command_for_an_example_is_none(push, cli):
    replaced(push / "examples/aside.sketch.md", "ContinuousSampler(", "ContinuousSampler(9 + ")
    (found,) = cli("check", push, "--json").json["findings"]
    assert "no bundled sketch leads to the goal of aside" in found["text"]
    assert found["where"].endswith("aside.sketch.md")
    assert "proc3s solve" not in found["mend"]


@pytest.mark.slow
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


def test_a_search_that_takes_too_long_decides_nothing(push, monkeypatch):
    monkeypatch.setattr(judging, "SECONDS", 1e-9)
    (check,) = [check for check in CHECKS if check.name == "programs"]
    found = examine_one(check, Subject(open_registry([push]), "push")).findings
    assert {finding.level for finding in found} == {"note"}
    assert "after 0 samples of seed 0" in found[0].text
