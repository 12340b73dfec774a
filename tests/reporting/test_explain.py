"""`proc3s explain` on run folders of every kind."""

import pytest

from proc3s.errors import UsageError
from proc3s.plugins.registry import folders_of, open_registry
from proc3s.reporting.changes import line_changes
from proc3s.reporting.explanation import explain
from proc3s.reporting.formatting import sampler
from proc3s.reporting.history import read_story
from proc3s.wording import number


def test_two_rounds_in_plain_words(cli, two_rounds):
    done = cli("explain", "two")
    assert done.code == 0
    for sentence in (
        "drawing/free, seed 0, method proc3s: solved in round 1 after",
        "Instruction: two lines",
        "60 samples, none accepted.",
        '100 % broke "inside" at step 1: the x coordinate leaves the canvas. The nearest miss was off by 1.',
        "carried out 1 step before they failed",
        "Never broken: collision.",
        "Every sample failed in the same place, so other numbers will not help.",
        "Look at how program-0.py comes to step 1 (draw_line)",
        "What changed: 3 lines new, 3 lines gone, in gen_plan, gen_domain.",
        "new parameter `y`: ContinuousSampler(min=-3.0, max=1.0)",
        "parameter `x` was ContinuousSampler(min=0.0, max=1.0), is ContinuousSampler(min=0.0, max=2.0)",
        "The goal was not judged",
        "Picture in two: plan.png.",
    ):
        assert sentence in done.stdout


def test_the_same_as_data(cli, two_rounds):
    told = cli("explain", "two", "--json").json
    first, second = (round_["programs"][0] for round_ in told["rounds"])
    assert (told["solved"], first["ending"], second["ending"]) == (True, "failed", "solved")
    assert [(s["step"], s["skill"], s["constraint"], s["count"]) for s in first["steps"]] == [
        (1, "draw_line", "inside", 60)
    ]
    assert first["steps"][0]["nearest"] == first["steps"][0]["median"] == -1
    assert second["change"]["new_parameters"] == {"y": "ContinuousSampler(min=-3.0, max=1.0)"}
    assert "+        Action(" in second["change"]["diff"]
    assert [item["kind"] for item in first["look"]] == ["always"]
    assert [item["kind"] for item in told["look"]] == ["not_judged", "pictures"]


ALWAYS = """```python
def gen_plan(initial, k, x):
    o = initial.obstacles[min(int(k), 4)]
    return [Action("draw_line", [o.x_pos, o.y_pos + FAR * x * o.radius, o.x_pos, o.y_pos + o.radius])]

def gen_domain(initial):
    return {"k": ContinuousSampler(0, 5), "x": ContinuousSampler(0, 1)}
```"""


@pytest.mark.parametrize(("far", "helps"), [("0", False), ("0.01", False), ("0.99", True)])
def test_numbers_do_not_help_where_all_samples_fail_in_one_way_whatever_they_touch(cli, stub, far, helps):
    given = ("--goal", "lines", "--samples", 200, "--feedback", 0, "--out", "run")
    cli("run", "drawing/free", *given, "--llm", stub(ALWAYS.replace("FAR", far)))
    done = cli("explain", "run")
    assert "; line touches object_" in done.stdout
    assert ("Every sample failed in the same place, so other numbers" in done.stdout) is not helps
    assert ("Narrow it to that" in done.stdout or "Move that bound" in done.stdout) is helps


def test_what_separates_better_samples_from_worse(cli):
    cli("run", "drawing/enclosed", "--samples", 500, "--feedback", 0, "--out", "run")
    done = cli("explain", "run")
    assert "`spare` between" in done.stdout
    assert "Narrow it to that" in done.stdout
    assert "proc3s replay run --samples 5000" in done.stdout
    assert "unsolved after 1 round and 500 samples" in done.stdout


def test_an_error_of_the_program_is_shown_with_its_line(cli, stub, failing):
    cli("run", "drawing/star", "--samples", 5, "--feedback", 0, "--llm", stub(failing.broken), "--out", "run")
    done = cli("explain", "run")
    assert done.code == 0
    assert "Line 2 of program-0.py, `return [Action(" in done.stdout
    assert "nothing" in done.stdout


def test_candidates_are_told_apart(cli, stub, failing):
    answers = [[failing.outside, failing.broken, failing.wider]]
    ran = cli(
        *("run", "drawing/free", "--goal", "two", "--samples", 90, "--candidates", 3),
        *("--llm", stub(*answers), "--out", "run"),
    )
    assert ran.code == 0, ran.stderr
    done = cli("explain", "run")
    assert "Candidate 0, of 3" in done.stdout
    assert "Candidate 2, of 3" in done.stdout
    assert "program-0.1.py" in done.stdout


def test_advice_does_not_contradict_itself(cli, stub, failing):
    """All fail in one place, yet how narrowly depends on a number."""
    answer = failing.wider.replace("0.5, y, x", "-0.5, y, x")
    given = ("--goal", "two", "--samples", 90, "--feedback", 0)
    cli("run", "drawing/free", *given, "--llm", stub(answer), "--out", "run")
    (program,) = cli("explain", "run", "--json").json["rounds"][0]["programs"]
    assert [item["kind"] for item in program["look"]] == ["narrow"]


def test_a_plan_that_was_carried_out_though_it_violates(cli, stub, failing):
    cli("run", "drawing/star", "--method", "cap", "--llm", stub(CAP), "--out", "run")
    done = cli("explain", "run")
    assert 'It violates "inside" at step 0: the x coordinate leaves the canvas' in done.stdout
    assert "No plan was accepted; the one that was carried out violates constraints." in done.stdout
    assert "unsolved" in done.stdout


CAP = """
```python
def gen_plan(initial):
    return [Action("draw_line", [-2, 1, 2, 3])]
```
"""


def test_a_second_stage_alone(cli, here, failing):
    (here / "sketch.py").write_text(failing.wider.split("```python\n")[1].split("```")[0])
    cli("solve", "drawing/star", "--sketch", "sketch.py", "--samples", 50, "--out", "run")
    done = cli("explain", "run")
    assert "Round 0" in done.stdout
    assert "--resume" not in done.stdout


def test_every_beginning_of_a_log_can_be_explained(two_rounds):
    folders = folders_of(open_registry())
    log = two_rounds / "events.jsonl"
    lines = log.read_bytes().splitlines(keepends=True)
    for count in range(len(lines)):
        log.write_bytes(b"".join(lines[:count]) + lines[count][:20])
        told = explain(read_story(two_rounds), folders)
        assert "broken off, or still at work" in told
        assert ("proc3s run --resume" in told) == (count > 1), count


def test_a_log_of_an_earlier_version(cli, two_rounds, rewrite):
    for name in ("dims", "goal", "goal_expected", "rehearsals", "id", "log"):
        rewrite(two_rounds, lambda event, name=name: {k: v for k, v in event.items() if k != name})
    assert "solved in round 1" in cli("explain", "two").stdout


def test_a_log_that_cannot_be_understood(cli, two_rounds, rewrite):
    rewrite(two_rounds, lambda event: event | ({"u": 7} if event["event"] == "batch_evaluated" else {}))
    done = cli("explain", "two")
    assert done.code == 2
    assert "events.jsonl was not written by this version of proc3s" in done.stderr


def test_what_is_no_run_folder(cli, here):
    done = cli("explain", "nowhere")
    assert done.code == 2
    assert "no run folder" in done.stderr
    with pytest.raises(UsageError, match="no run folder"):
        read_story(here)


def test_a_program_cannot_write_to_the_terminal(cli, two_rounds, rewrite):
    def poison(event):
        if event["event"] == "sketch_loaded":
            event["parameters"] = {"x\x1b[2J\u202e": "ContinuousSampler(min=0.0, max=1.0)"}
        return event

    rewrite(two_rounds, poison)
    done = cli("explain", "two")
    assert done.code == 0
    assert not {"\x1b", "\u202e"} & set(done.stdout)


def test_a_round_that_was_begun_again_counts_once(cli, two_rounds):
    log = two_rounds / "events.jsonl"
    lines = log.read_text().splitlines(keepends=True)
    begun = next(i for i, line in enumerate(lines) if '"round": 1' in line)
    cut = next(i for i, line in enumerate(lines) if i > begun and "batch_evaluated" in line)
    before = cli("explain", "two").stdout
    log.write_text("".join([*lines[: cut + 1], *lines[begun:]]))
    assert cli("explain", "two").stdout == before


PLUGIN = """
from pathlib import Path
from proc3s import TemplatesSpec, hookimpl

@hookimpl
def register_templates(register):
    register(TemplatesSpec(name="mine", summary="My words.", folder=Path(__file__).parent / "mine"))
"""


def test_a_plugin_may_bring_other_words(cli, here, two_rounds):
    (here / "mine").mkdir()
    (here / "mine" / "explain.j2").write_text("{{ task }} took {{ samples }} samples")
    (here / "mine" / "report.css").write_text("body { color: teal }")
    (here / "words.py").write_text(PLUGIN)
    assert cli("explain", "two", "--plugin", "words.py").stdout.startswith("drawing/free took ")
    cli("report", "two", "--plugin", "words.py")
    assert "color: teal" in (two_rounds / "report.html").read_text()


def test_words_that_cannot_be_rendered_are_a_mistake_with_its_place(cli, here, two_rounds):
    (here / "mine").mkdir()
    (here / "mine" / "explain.j2").write_text("\n{% if %}")
    (here / "words.py").write_text(PLUGIN)
    done = cli("explain", "two", "--plugin", "words.py")
    assert done.code == 2
    assert "explain.j2:2" in done.stderr


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("", "", (0, 0, ())),
        ("def a():\n    x\n", "def a():\n    y\n", (1, 1, ("a",))),
        ("def a(\n    x,\n):\n    y\n", "def a(\n    z,\n):\n    y\n", (1, 1, ("a",))),
        ("def a():\n    x\n\nX = 1\n", "def a():\n    x\n\nX = 2\n", (1, 1, ())),
        ("", "class A:\n    def f(self):\n        pass\n", (3, 0, ("A",))),
    ],
)
def test_where_lines_changed(old, new, expected):
    assert line_changes(old, new) == expected


def test_numbers_as_people_read_them():
    assert number(1.84e-14) == number(-1e-12) == "0"
    assert number([0.123456, 2, "a"]) == "(0.1235, 2, a)"
    assert sampler("ContinuousSampler(min=1.84e-14, max=12.34567)") == "ContinuousSampler(min=0, max=12.35)"
