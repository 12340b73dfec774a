import json

import pytest


def test_pending_then_answered(cli, here, answers):
    args = ("run", "drawing/star", "--llm", "manual:desk", "-L", "wait=0")
    pending = cli(*args, "--json")
    assert pending.code == 4
    (prompt,) = (here / "desk").iterdir()
    assert prompt.name.endswith(".prompt.md")
    assert "Draw a star" in prompt.read_text()
    answer = prompt.with_name(prompt.name.replace(".prompt.", ".answer."))
    assert str(prompt.relative_to(here)) in pending.json["error"]
    assert str(answer.relative_to(here)) in pending.json["error"]
    assert json.loads((here / pending.json["run_dir"] / "summary.json").read_text()) == pending.json
    answer.write_text(answers.star)
    done = cli(*args, "--json")
    assert (done.code, done.json["llm_source"], done.json["goal_reached"]) == (0, "manual", True)


def test_a_pending_run_goes_on_when_the_answer_is_there(cli, here, answers):
    args = ("run", "drawing/star", "--llm", "manual:desk", "-L", "wait=0", "--out", "mine")
    pending = cli(*args)
    assert pending.code == 4
    assert "proc3s run --resume mine" in pending.stderr
    assert cli("run", "--resume", "mine").code == 4
    (here / "desk/drawing.star.proc3s.seed0.answer.md").write_text(answers.star)
    result = cli("run", "--resume", "mine")
    assert result.code == 0, result.stderr


def test_an_answer_of_nothing_but_space_is_none_yet(cli, here):
    (here / "desk").mkdir()
    (here / "desk/drawing.star.proc3s.seed0.answer.md").write_text(" \n\n")
    assert cli("run", "drawing/star", "--llm", "manual:desk", "-L", "wait=0").code == 4


def test_a_feedback_round_asks_again(cli, here, answers):
    args = ("run", "drawing/star", "--llm", "manual:desk", "-L", "wait=0", "--samples", 20)
    cli(*args)
    (here / "desk/drawing.star.proc3s.seed0.answer.md").write_text(answers.outside)
    assert cli(*args).code == 4
    later = here / "desk/drawing.star.proc3s.seed0.round1.prompt.md"
    assert "the x coordinate leaves the canvas" in later.read_text()
    (here / "desk/drawing.star.proc3s.seed0.round1.answer.md").write_text(answers.star)
    result = cli(*args, "--samples", 500, "--json")
    assert (result.code, result.json["rounds"]) == (0, 1)


@pytest.mark.parametrize("other", [["--seed", "1"], ["--method", "cap"]])
def test_seeds_and_methods_have_prompts_of_their_own(cli, here, other):
    args = ("run", "drawing/star", "--llm", "manual:desk", "-L", "wait=0")
    cli(*args)
    cli(*args, *other)
    assert len(list((here / "desk").glob("*.prompt.md"))) == 2


def test_an_answer_to_another_goal_is_not_taken(cli, here, answers):
    args = ("run", "drawing/free", "--llm", "manual:desk", "-L", "wait=0")
    cli(*args, "--goal", "Draw a star.")
    (answer,) = [p.with_name(p.name.replace(".prompt.", ".answer.")) for p in (here / "desk").iterdir()]
    answer.write_text(answers.star)
    assert cli(*args, "--goal", "Draw a house.").code == 4


def test_an_answer_that_is_no_text(cli, here):
    (here / "desk").mkdir()
    (here / "desk/drawing.star.proc3s.seed0.answer.md").write_bytes(b"\xff\xfe\x00caf\xe9")
    result = cli("run", "drawing/star", "--llm", "manual:desk", "-L", "wait=0")
    assert result.code == 3
    assert "answer.md" in result.stderr


def test_waiting(background, eventually, here, answers):
    with background("run", "drawing/star", "--llm", "manual:desk", "--json") as process:
        eventually(lambda: list(here.glob("desk/*.prompt.md")))
        assert process.poll() is None
        (here / "desk/drawing.star.proc3s.seed0.answer.md").write_text(answers.star)
        stdout, stderr = process.communicate(timeout=30)
    assert process.returncode == 0
    assert json.loads(stdout)["llm_source"] == "manual"
    assert "answer.md" in stderr


def test_waiting_ends(cli):
    result = cli("run", "drawing/star", "--llm", "manual:desk", "-L", "wait=0.2", "--json")
    assert result.code == 4
