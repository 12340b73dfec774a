"""Feedback on a typical failure is what a program that fails so is told."""

import json

import pytest

from proc3s.plugins.registry import open_registry
from proc3s.specs.base import placeholders
from proc3s.specs.domain import DomainSpec

SKETCH = {"arguments", "exception", "gen-domain", "goal", "no-program", "syntax", "timeout"}
PLAN = {"arguments", "goal", "no-program", "syntax"}


@pytest.fixture
def rendered(cli):
    """The messages of round 1 after a typical failure."""

    def rendered(failure, *more, task="drawing/star"):
        result = cli("render-prompt", task, "--failure", failure, "--format", "json", *more)
        assert result.code == 0, result.stderr
        assert f"example of the failure {failure}" in result.stderr
        return json.loads(result.stdout)

    return rendered


@pytest.fixture
def names(cli):
    """The failures that a wrong name lists."""

    def names(*more, task="drawing/star"):
        result = cli("render-prompt", task, "--failure", "nothing-like-it", *more)
        assert (result.code, result.stdout) == (2, "")
        return set(result.stderr.strip().rpartition("there is ")[2].split(", "))

    return names


@pytest.mark.parametrize(
    ("failure", "method"),
    [
        ("exception", "proc3s"),
        *(
            pytest.param(name, "proc3s", marks=pytest.mark.slow)
            for name in sorted(SKETCH - {"goal", "exception"})
        ),
        *(pytest.param(name, "llm3", marks=pytest.mark.slow) for name in sorted(PLAN - {"goal"})),
    ],
)
def test_a_mistake_is_told_as_it_is_in_a_run(cli, here, stub, rendered, failure, method):
    messages = rendered(failure, "--method", method)
    assert [m["kind"] for m in messages[-2:]] == ["reply", "feedback"]
    llm = stub(messages[-2]["text"], "nothing more")
    cli("run", "drawing/star", "--method", method, "--feedback", 1, "--llm", llm, "--out", "run")
    shown = cli(
        *("render-prompt", "drawing/star", "--method", method, "--failure", failure, "--format", "markdown")
    )
    assert (here / "run/prompt-1.md").read_text() == shown.stdout


@pytest.mark.parametrize(
    ("task", "constraints"),
    [
        ("drawing/arrow", {"inside": "y coordinate", "collision": "line touches object_2"}),
        ("blocks/line", {"kinematic": "cannot reach", "collision": "the gripper collides with the table"}),
    ],
)
def test_every_constraint_has_a_failure(rendered, names, task, constraints):
    assert names(task=task) >= SKETCH | set(constraints)
    for name, words in constraints.items():
        *_, answer, feedback = rendered(name, task=task)
        assert "def gen_domain" in answer["text"]  # the bundled answer
        assert not answer["text"].startswith("---")
        assert f'the rule "{name}"' in feedback["text"]
        assert words in feedback["text"]


def test_every_installed_constraint_says_how_its_sentence_is_filled_in():
    registry = open_registry([])
    for name in registry.all(DomainSpec):
        for spec in registry.domain(name).spec.constraints.values():
            assert set(spec.example) == set(placeholders(spec.says)), f"{name}: {spec.name}"


def test_a_goal_is_missed_in_the_words_of_the_judge(rendered):
    feedback = rendered("goal")[-1]["text"]
    assert "missed the goal: nothing is drawn" in feedback


def test_failures_are_those_that_an_answer_of_the_kind_can_have(names):
    constraints = {"inside", "collision"}
    assert names() == SKETCH | constraints
    assert names("--method", "llm3") == PLAN | constraints
    assert names("--method", "cap") == SKETCH - {"gen-domain"} | constraints
    assert names("--preset", "paper") == SKETCH - {"goal"} | constraints
    assert names("--goal", "Draw a cat.") == SKETCH - {"goal"} | constraints


def test_without_a_bundled_answer_a_program_stands_for_one(rendered):
    answer = rendered("inside", "--goal", "Draw a cat.")[-2]["text"]
    assert answer == (
        "```python\ndef gen_plan(initial, ...):\n    ...\n\n\ndef gen_domain(initial):\n    ...\n```\n"
    )


def test_a_wrong_name(cli):
    result = cli("render-prompt", "drawing/star", "--failure", "time-out")
    assert result.code == 2
    assert "did you mean 'timeout'?" in result.stderr
    assert "exception" in result.stderr


@pytest.mark.parametrize(
    "more", [("--from", "run"), ("--round", 0), ("--round", 2), ("--check", "approved")], ids=str
)
def test_what_does_not_go_with_a_failure(cli, more):
    result = cli("render-prompt", "drawing/star", "--failure", "inside", *more)
    assert (result.code, result.stdout) == (2, "")
    assert "--failure" in result.stderr


def test_round_1_goes_with_a_failure_and_a_round_needs_one_or_a_run(cli, rendered):
    assert rendered("inside", "--round", 1) == rendered("inside")
    result = cli("render-prompt", "drawing/star", "--round", 1)
    assert result.code == 2
    assert "--from RUN" in result.stderr
    assert "--failure NAME" in result.stderr


def test_ones_own_feedback_template_is_used_and_checked(cli, here, rendered):
    check = ("render-prompt", "drawing", "--check", "approved", "--method", "proc3s")
    cli(*check, "--update")
    (here / "mine").mkdir()
    (here / "mine/feedback.j2").write_text("Mine: {{ diagnosis.samples }}.\n")
    assert rendered("inside", "--template-dir", "mine")[-1]["text"] == "Mine: 100.\n"
    result = cli(*check, "--template-dir", "mine")
    assert result.code == 2
    assert "approved/drawing/feedback/proc3s.md" in result.stdout
    assert "star.proc3s.md" not in result.stdout
    assert "\n+Mine: 100.\n" in result.stdout


def test_feedback_that_no_method_gets_any_more_is_an_orphan(cli, here):
    (here / "approved/ycb/feedback").mkdir(parents=True)
    (here / "approved/ycb/feedback/old.md").write_text("")
    result = cli("render-prompt", "drawing/star", "--check", "approved", "--method", "cap")
    assert "old.md" not in result.stdout  # only a part was asked for


def test_an_example_must_fit_its_sentence(cli, here):
    from proc3s import ConstraintSpec

    given = {"name": "few", "says": "too many {things}", "target": "json:loads"}
    ConstraintSpec(**given, example={"things": "pens"})
    with pytest.raises(ValueError, match="'thing', and `says` takes things"):
        ConstraintSpec(**given, example={"thing": "pens"})
