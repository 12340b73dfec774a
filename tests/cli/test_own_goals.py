"""An instruction of one's own has no bundled answer: the message says how to go on, in commands that run."""

import shlex
import shutil

import pytest

import proc3s


def commands(text):
    return [shlex.split(line) for line in text.splitlines() if line.startswith("    ")]


def slow(*case):
    return pytest.param(*case, marks=pytest.mark.slow)


@pytest.mark.parametrize(
    ("args", "why"),
    [
        (("drawing/star", "--goal", "It's a house."), "fit the task's own sentence only"),
        slow(("drawing/free", "--goal", "It's a house."), "fit tasks with a sentence of their own only"),
        slow(("drawing/free",), "has no instruction of its own; give one with --goal"),
        slow(
            ("drawing/star", "--goal", "House", "--method", "cap", "--seed", "2"), "the task's own sentence"
        ),
    ],
)
def test_every_way_on_runs_as_it_is_printed(args, why, cli, here, monkeypatch):
    monkeypatch.delenv("ANTHROPIC_API_KEY", raising=False)
    told = cli("run", *args, "--samples", "300")
    assert (told.code, why in told.stderr) == (2, True), told.stderr
    assert not (here / "runs").exists()
    model, manual, copy, solve, *rest = commands(told.stderr)
    asked = cli(*model[1:])
    assert (asked.code, "ANTHROPIC_API_KEY" in asked.stderr) == (3, True), asked.stderr
    assert "pending: read answers/drawing." in cli(*manual[1:], "-L", "wait=0").stderr
    assert copy[0] == "cp"
    shutil.copy(*copy[1:])
    assert cli(*solve[1:], "--json").json["goal_reached"] is None
    assert (rest == []) == ("drawing/free" in args or "cap" in args)
    assert all("--goal" not in each and cli(*each[1:]).code == 0 for each in rest)


def test_the_other_options_are_kept(cli, here):
    (here / "more.py").write_text("")
    options = [
        "-D",
        "count=4",
        "--no-screens",
        "--candidates",
        "2",
        "--max-calls",
        "3",
        "--plugin",
        "more.py",
    ]
    told = cli("run", "drawing/star", "--goal", "A house.", *options)
    _, manual, _, solve, _ = commands(told.stderr)
    assert {"count=4", "--no-screens", "more.py", "--candidates", "--max-calls"} <= set(manual)
    assert {"count=4", "--no-screens", "more.py"} <= set(solve)
    assert not {"--candidates", "--max-calls"} & set(solve)


def test_python_says_the_same(here):
    with pytest.raises(proc3s.UsageError, match=r"own sentence only(.|\n)*--llm manual:answers"):
        proc3s.run("drawing/star", goal="A house.")
    with pytest.raises(proc3s.UsageError, match=r"no instruction of its own(.|\n)*--llm manual:answers"):
        proc3s.render_prompt("drawing/free")


def test_an_answer_is_taken_as_a_program(cli, here):
    (here / "answer.md").write_text("No program at all.\n")
    none = cli("solve", "drawing/star", "--sketch", "answer.md")
    assert (none.code, "answer.md: the answer contains no program" in none.stderr) == (2, True)
