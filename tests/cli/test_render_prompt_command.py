import hashlib
import json
import os
import sys

import pytest

from proc3s.prompts import prompter

TASKS = ["star", "arrow", "letters", "enclosed", "free"]
METHODS = ["proc3s", "proc3s-nf", "cap", "cap-gaussian", "llm3", "llm3-nf", "llm3-gaussian"]


def goal(task):
    return ["--goal", "Draw a house."] if task == "free" else []


@pytest.mark.parametrize("method", METHODS)
def test_every_task_renders_for_every_method_byte_by_byte(cli, method):
    seen = set()
    for task, seed in [*((task, 0) for task in TASKS), ("star", 3)]:
        result = cli("render-prompt", f"drawing/{task}", "--method", method, "--seed", seed, *goal(task))
        assert result.code == 0
        seen.add(result.stdout)
    assert len(seen) == len(TASKS) + 1
    again = cli("render-prompt", "drawing/star", "--method", method, "--seed", 3)
    assert again == result


def test_the_parts_of_a_prompt(cli):
    text = cli("render-prompt", "drawing/star").stdout
    for part in (
        "CANVAS_SIZE = 100.0",
        "class Obstacle",
        "`draw_line(p1_x",
        "gen_domain",
        "ContinuousSampler",
    ):
        assert part in text.split("Goal: Draw a square")[0]
    assert text.rstrip().endswith("Goal: Draw a star with at least five points.")


def test_formats(cli):
    text, markdown, data = (
        cli("render-prompt", "drawing/star", "--format", f) for f in ("text", "markdown", "json")
    )
    messages = json.loads(data.stdout)
    assert [m["role"] for m in messages] == ["system", "user", "assistant", "user"]
    for rendering in (text, markdown):
        for message in messages:
            assert message["text"].rstrip() in rendering.stdout
    assert len({r.stderr for r in (text, markdown, data)}) == 1


def test_the_hash_and_the_size_go_to_stderr(cli, here, events):
    from proc3s import Message, digest

    result = cli("render-prompt", "drawing/star", "--format", "json")
    messages = [Message.model_validate(m) for m in json.loads(result.stdout)]
    assert digest(messages) in result.stderr
    assert "tokens" in result.stderr
    run = cli("run", "drawing/star", "--json")
    (prompt,) = events(here / run.json["run_dir"], "prompt_rendered")
    assert prompt["sha256"] in result.stderr
    assert len(prompt["sha256"]) == len(hashlib.sha256().hexdigest())


def test_markdown_is_what_the_run_folder_keeps(cli, here):
    run = cli("run", "drawing/star", "--seed", 2, "--json")
    rendering = cli("render-prompt", "drawing/star", "--seed", 2, "--format", "markdown")
    assert (here / run.json["run_dir"] / "prompt-0.md").read_text() == rendering.stdout


def test_the_goal_and_the_scene_may_be_ones_own(cli):
    text = cli("render-prompt", "drawing/star", "--goal", "Draw a cat.", "-D", "count=1").stdout
    assert "Goal: Draw a cat." in text
    assert "object_1" not in text.split("Goal: Draw a square")[1].split("assistant")[1]


def test_a_task_without_an_instruction_needs_a_goal(cli):
    result = cli("render-prompt", "drawing/free")
    assert (result.code, result.stdout) == (2, "")
    assert "--goal" in result.stderr


@pytest.fixture
def failed_run(cli, stub, answers):
    """A run of three rounds that all failed."""
    llm = stub(answers.outside, "no code", answers.outside.replace("-1, 1", "1, -1"))
    result = cli(
        "run",
        "drawing/star",
        "--preset",
        "paper",
        "--feedback",
        2,
        "--samples",
        30,
        "--llm",
        llm,
        "--out",
        "failed",
    )
    assert result.code == 1
    return "failed"


@pytest.mark.parametrize("round_", [1, 2])
def test_feedback_rounds_are_rendered_from_a_run(cli, here, failed_run, round_):
    result = cli(
        *("render-prompt", "drawing/star", "--round", round_, "--from", failed_run, "--format", "markdown")
    )
    assert result.code == 0
    assert result.stdout == (here / failed_run / f"prompt-{round_}.md").read_text()


def test_even_the_round_that_was_not_asked_any_more(cli, failed_run):
    result = cli("render-prompt", "drawing/star", "--round", 3, "--from", failed_run)
    assert result.code == 0
    assert "the y coordinate leaves the canvas" in result.stdout


def test_a_round_that_the_run_does_not_have(cli, failed_run):
    result = cli("render-prompt", "drawing/star", "--round", 4, "--from", failed_run)
    assert (result.code, result.stdout) == (2, "")
    assert "3 failed round(s)" in result.stderr


def test_a_later_round_is_that_of_the_runs_own_method_seed_and_goal(cli, here, stub, answers):
    llm = stub(answers.literal(-1), answers.literal(1))
    args = ("--method", "llm3", "--seed", 3, "--goal", "Two lines.", "--llm", llm)
    cli("run", "drawing/free", *args, "--out", "first")
    result = cli("render-prompt", "drawing/free", "--round", 1, "--from", "first", "--format", "markdown")
    assert result.stdout == (here / "first/prompt-1.md").read_text()


def test_a_rendering_of_another_task_than_the_runs_is_refused(cli, failed_run):
    assert cli("render-prompt", "drawing/arrow", "--round", 1, "--from", failed_run).code == 2


@pytest.mark.parametrize("format_", ["text", "markdown", "json"])
def test_no_difference_to_itself(cli, here, format_):
    rendering = cli("render-prompt", "drawing/star", "--format", format_).stdout
    (here / "old").write_text(rendering)
    result = cli("render-prompt", "drawing/star", "--format", format_, "--diff", "old")
    assert (result.code, result.stdout) == (0, "")


def test_a_difference_to_a_file(cli, here):
    (here / "old.txt").write_text(cli("render-prompt", "drawing/star").stdout)
    result = cli("render-prompt", "drawing/arrow", "--diff", "old.txt")
    assert result.code == 0
    assert result.stdout.startswith("--- old.txt\n+++ ")
    assert "\n-Goal: Draw a star" in result.stdout
    assert "\n+Goal: Draw an arrow" in result.stdout
    assert "sha256" in result.stderr


@pytest.mark.parametrize("format_", ["text", "markdown", "json"])
def test_the_format_of_a_file_is_recognized(cli, here, format_):
    (here / "old").write_text(cli("render-prompt", "drawing/star", "--format", format_).stdout)
    same = cli("render-prompt", "drawing/star", "--diff", "old")
    assert (same.code, same.stdout) == (0, "")
    changed = cli("render-prompt", "drawing/star", "--goal", "Draw a cat.", "--diff", "old").stdout
    assert sum(line[0] in "+-" for line in changed.splitlines()) == 4


def test_a_format_that_is_given_is_used_all_the_same(cli, here):
    (here / "old").write_text(cli("render-prompt", "drawing/star").stdout)
    result = cli("render-prompt", "drawing/star", "--diff", "old", "--format", "markdown")
    assert "\n-[system: system]\n" in result.stdout
    assert "\n+<!-- system: system -->\n" in result.stdout


@pytest.mark.parametrize("format_", ["text", "markdown"])
def test_a_difference_to_a_pipe(cli, here, format_):
    text = cli("render-prompt", "drawing/star", "--format", format_).stdout
    reading, writing = os.pipe()
    os.write(writing, text.replace("five points", "six points").encode())
    os.close(writing)
    try:
        result = cli("render-prompt", "drawing/star", "--diff", f"/dev/fd/{reading}")
    finally:
        os.close(reading)
    assert result.code == 0
    changed = [line for line in result.stdout.splitlines() if line[0] in "+-"][2:]
    assert [line[-12:] for line in changed] == [" six points.", "five points."]


def test_what_cannot_be_compared_with(cli, here):
    (here / "folder").mkdir()
    (here / "picture").write_bytes(b"\x89PNG\r\n\x1a\n\xff")
    (here / "secret").write_text("x")
    (here / "secret").chmod(0)
    said = {"folder": "no run folder", "picture": "no UTF-8 text", "nowhere": "no rendering or run nowhere"}
    if os.geteuid():
        said["secret"] = "Permission denied"
    for name, words in said.items():
        result = cli("render-prompt", "drawing/star", "--diff", name)
        assert (result.code, result.stdout) == (2, "")
        assert words in result.stderr
        assert name in result.stderr


def test_a_difference_to_a_run(cli):
    cli("run", "drawing/star", "--out", "first")
    assert cli("render-prompt", "drawing/star", "--diff", "first").stdout == ""
    result = cli("render-prompt", "drawing/star", "--goal", "Draw a cat.", "--diff", "first")
    assert result.code == 0
    changed = [line for line in result.stdout.splitlines() if line[0] in "+-"][2:]
    assert changed == ["-Goal: Draw a star with at least five points.", "+Goal: Draw a cat."]


def test_a_difference_of_a_later_round_to_the_run_it_is_from(cli, failed_run):
    result = cli("render-prompt", "drawing/star", "--round", 1, "--from", failed_run, "--diff", failed_run)
    assert (result.code, result.stdout) == (0, "")


@pytest.mark.slow
def test_approving_and_checking(cli, here):
    assert cli("render-prompt", "--check", "approved").code == 2
    assert cli("render-prompt", "--check", "approved", "--update").code == 0
    names = {str(p.relative_to(here / "approved")) for p in (here / "approved").rglob("*.md")}
    tasks = cli("list", "tasks", "--json").json["tasks"]
    domains = {task.partition("/")[0] for task in tasks}
    assert names == {
        *(f"{t}.{m}.md" for t in tasks for m in ("proc3s", "cap", "llm3")),
        *(f"{d}/feedback/{m}.md" for d in domains for m in ("proc3s", "llm3")),
    }
    result = cli("render-prompt", "--check", "approved")
    assert (result.code, result.stdout) == (0, "")


@pytest.mark.slow
def test_a_rendering_that_differs_is_shown(cli, here):
    cli("render-prompt", "--check", "approved", "--update")
    path = here / "approved/drawing/star.cap.md"
    before = path.read_text()
    path.write_text(before.replace("Draw a star", "Draw a planet"))
    result = cli("render-prompt", "--check", "approved")
    assert result.code == 2
    assert "\n-Goal: Draw a planet" in result.stdout
    assert "\n+Goal: Draw a star" in result.stdout
    assert "star.cap.md" in result.stdout
    assert "arrow" not in result.stdout
    assert cli("render-prompt", "--check", "approved", "--update").code == 0
    assert path.read_text() == before


@pytest.mark.slow
def test_an_approved_file_that_is_missing_or_too_much(cli, here):
    cli("render-prompt", "--check", "approved", "--update")
    (here / "approved/drawing/star.cap.md").rename(here / "approved/drawing/planet.cap.md")
    result = cli("render-prompt", "--check", "approved")
    assert result.code == 2
    assert "planet.cap.md" in result.stdout
    cli("render-prompt", "--check", "approved", "--update")
    assert not (here / "approved/drawing/planet.cap.md").exists()


@pytest.mark.slow
def test_approving_leaves_other_files_alone(cli, here):
    (here / "approved/notes").mkdir(parents=True)
    for name in ("README.md", "notes/why.md", "drawing.md"):
        (here / "approved" / name).write_text("mine")
    cli("render-prompt", "--check", "approved", "--update")
    for name in ("README.md", "notes/why.md", "drawing.md"):
        assert (here / "approved" / name).read_text() == "mine"
    assert cli("render-prompt", "--check", "approved").code == 0


@pytest.mark.slow
def test_checking_one_method_says_nothing_about_the_others(cli, here):
    cli("render-prompt", "--check", "approved", "--update")
    assert cli("render-prompt", "--check", "approved", "--method", "cap").code == 0
    cli("render-prompt", "--check", "approved", "--method", "cap", "--update")
    assert (here / "approved/drawing/star.proc3s.md").exists()


@pytest.mark.parametrize("within", ["drawing", "drawing/star"])
def test_checking_a_part(cli, here, within):
    cli("render-prompt", within, "--check", "approved", "--update")
    found = {p.name for p in (here / "approved").rglob("*.md")}
    assert "star.cap.md" in found
    assert ("arrow.cap.md" in found) == (within == "drawing")
    assert cli("render-prompt", within, "--check", "approved").code == 0


def test_the_prompt_names_the_python_that_runs_the_program(cli):
    version = f"Python {sys.version_info.major}.{sys.version_info.minor} "
    assert version in cli("render-prompt", "drawing/star").stdout
    assert version in cli("render-prompt", "drawing/star", "--method", "cap").stdout
    assert "Python 3" not in cli("render-prompt", "drawing/star", "--method", "llm3").stdout


def test_what_was_approved_on_another_python_is_as_approved(cli, here, monkeypatch):
    check = ("render-prompt", "drawing/star", "--check", "approved", "--method", "cap")
    cli(*check, "--update")
    before = (here / "approved/drawing/star.cap.md").read_text()
    monkeypatch.setattr(prompter, "PYTHON", "3.99")
    assert "Python 3.99 " in cli("render-prompt", "drawing/star", "--method", "cap").stdout
    assert cli(*check).code == 0
    assert cli(*check, "--update").code == 0
    assert (here / "approved/drawing/star.cap.md").read_text() == before
    (here / "approved/drawing/star.cap.md").write_text(before.replace("Draw a star", "Draw a planet"))
    assert cli(*check).code == 2


@pytest.mark.slow
def test_approving_in_a_place_that_cannot_be_written(cli, here):
    (here / "file").write_text("")
    result = cli("render-prompt", "--check", "file", "--update")
    assert result.code == 2
    assert "file" in result.stderr


def test_templates_of_ones_own(cli, here):
    (here / "mine/methods").mkdir(parents=True)
    (here / "mine/methods/cap.j2").write_text("SHORT {{ domain.name }}\n")
    result = cli("render-prompt", "drawing/star", "--method", "cap", "--template-dir", "mine")
    assert result.stdout.startswith("[system: system]\nSHORT drawing\n")
    assert "Draw a star" in result.stdout


def test_what_a_plugin_adds_to_the_prompt(cli, here):
    (here / "mine/methods").mkdir(parents=True)
    (here / "mine/methods/cap.j2").write_text("{{ weather }}\n")
    (here / "ear.py").write_text(
        "from proc3s import hookimpl\n\n@hookimpl\ndef prompt_context(problem, method):\n"
        "    return {'weather': f'{problem.name} in the rain'}\n"
    )
    args = ("render-prompt", "drawing/star", "--method", "cap", "--template-dir", "mine")
    assert "drawing/star in the rain" in cli(*args, "--plugin", "ear.py").stdout


def test_rendering_writes_nothing(cli, here):
    cli("render-prompt", "drawing/star")
    assert list(here.iterdir()) == []


def test_a_device_without_an_end_is_no_rendering(cli):
    done = cli("render-prompt", "drawing/star", "--diff", "/dev/zero")
    assert (done.code, done.stdout) == (2, "")
    assert "/dev/zero is no rendering of a prompt: it has more than 10,000,000 bytes" in done.stderr


def test_a_folder_of_approved_prompts_must_be_there(cli, here):
    done = cli("render-prompt", "drawing", "--check", "prompts")
    assert (done.code, done.stdout) == (2, "")
    assert "there is no folder prompts; --update makes it" in done.stderr
