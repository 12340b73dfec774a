import json

import pytest

RESULT = ("plan", "samples", "evaluations", "solved", "executed", "goal_reached", "violations")


def same(one, two):
    return [one.json[k] for k in RESULT] == [two.json[k] for k in RESULT]


@pytest.mark.parametrize("method", ["proc3s", "cap-gaussian", "llm3"])
def test_a_replay_and_its_replay_give_the_identical_plan(cli, here, method):
    first = cli("run", "drawing/star", "--method", method, "--json", "--out", "first")
    second = cli("replay", "first", "--json", "--out", "second")
    third = cli("replay", "second", "--json", "--out", "third")
    assert (first.code, second.code, third.code) == (0, 0, 0)
    assert list(second.json) == list(first.json)
    assert same(first, second)
    assert same(first, third)
    assert second.json["method"] == method


def test_a_run_with_a_feedback_round(cli, stub, answers):
    llm = stub(answers.outside, answers.star)
    first = cli(
        "run", "drawing/star", "--seed", 4, "--samples", 200, "--llm", llm, "--json", "--out", "first"
    )
    second = cli("replay", "first", "--json", "--out", "second")
    third = cli("replay", "second", "--json", "--out", "third")
    assert first.json["rounds"] == 1
    assert first.json["plan"] == second.json["plan"] == third.json["plan"] is not None


def test_a_gaussian_run_with_a_feedback_round(cli, stub, answers):
    llm = stub(answers.literal(-9999), answers.literal(-0.5))
    args = ("--method", "llm3-gaussian", "--samples", 300, "--llm", llm, "--json")
    first = cli("run", "drawing/free", "--goal", "two lines", *args, "--out", "first")
    second = cli("replay", "first", "--json", "--out", "second")
    assert (first.json["rounds"], first.json["solved"]) == (1, True)
    assert first.json["plan"] == second.json["plan"]


def test_a_fallback(cli, stub, answers):
    llm = stub(answers.literal(-1), answers.literal(-2))
    first = cli(
        *(
            "run",
            "drawing/star",
            "--method",
            "llm3",
            "--feedback",
            1,
            "--llm",
            llm,
            "--json",
            "--out",
            "first",
        )
    )
    second = cli("replay", "first", "--json", "--out", "second")
    assert (first.code, second.code) == (1, 1)
    assert second.json["executed"] == "fallback"
    assert first.json["plan"] == second.json["plan"]


def test_a_fallback_of_an_earlier_round_than_the_last(cli, stub, answers):
    llm = stub(answers.literal(-1), "```python\ngen_plan = [\n```")
    first = cli(
        *(
            "run",
            "drawing/star",
            "--preset",
            "paper",
            "--method",
            "llm3",
            "--feedback",
            1,
            "--llm",
            llm,
            "--json",
            "--out",
            "first",
        )
    )
    assert first.json["executed"] == "fallback"
    second = cli("replay", "first", "--json", "--out", "second")
    assert second.json["plan"] == first.json["plan"]


def test_nobody_is_asked_again(cli, here, stub, answers):
    cli("run", "drawing/star", "--llm", stub(answers.star), "--out", "first")
    (here / "answers.json").unlink()
    assert cli("replay", "first").code == 0


def test_a_replay_says_where_its_program_is_from(cli):
    cli("run", "drawing/star", "--out", "first")
    assert cli("replay", "first", "--json").json["llm_source"] == "authored"


def test_options_may_change(cli, stub, answers):
    cli(
        "run",
        "drawing/star",
        "--llm",
        stub(answers.outside),
        "--feedback",
        0,
        "--samples",
        100,
        "--out",
        "first",
    )
    result = cli("replay", "first", "--samples", 7, "--solver", "gaussian", "-S", "first=2", "--json")
    assert (result.code, result.json["samples"], result.json["solver"]) == (1, 7, "gaussian")


def test_a_scene_with_options_is_the_same_scene(cli, stub, answers):
    llm = stub(answers.star)
    first = cli("run", "drawing/star", "-D", "count=7", "--seed", 2, "--llm", llm, "--json", "--out", "first")
    assert cli("replay", "first", "--json").json["plan"] == first.json["plan"]


def test_a_solved_program_can_be_replayed(cli, here, answers):
    (here / "mine.py").write_text(answers.star.split("```python\n")[1].split("```")[0])
    first = cli("solve", "drawing/free", "--sketch", "mine.py", "--json", "--out", "first")
    second = cli("replay", "first", "--json")
    assert first.json["plan"] == second.json["plan"]
    assert second.json["llm_source"] == "none"


def test_a_run_without_a_program(cli, stub):
    cli("run", "drawing/star", "--llm", stub("no code"), "--feedback", 0, "--out", "first")
    result = cli("replay", "first", "--json")
    assert result.code == 2
    assert "no program" in result.json["error"]


@pytest.mark.slow
@pytest.mark.parametrize("keep", [0, 1, 3, 4, 8])
def test_a_run_that_was_cut_off_anywhere_can_be_read(cli, here, keep):
    cli("run", "drawing/star", "--out", "first")
    whole = (here / "first/events.jsonl").read_bytes()
    lines = whole.splitlines(keepends=True)
    assert len(lines) == 10
    (here / "cut").mkdir()
    (here / "cut/events.jsonl").write_bytes(b"".join(lines[:keep]) + lines[keep][:25])
    result = cli("replay", "cut", "--json")
    assert result.code == (0 if keep > 3 else 2), result.stderr
    assert len(result.stderr.splitlines()) <= 1


def test_the_answers_of_a_run_answer_the_same_prompts(cli, stub, answers):
    llm = stub(answers.outside, answers.star)
    first = cli("run", "drawing/star", "--samples", 200, "--llm", llm, "--json", "--out", "first")
    again = cli("run", "drawing/star", "--samples", 200, "--llm", "replay:first", "--json")
    assert same(first, again)
    other = cli("run", "drawing/star", "--seed", 1, "--llm", "replay:first")
    assert other.code == 3
    assert "no answer for drawing/star, method proc3s, seed 1" in other.stderr


def test_a_relative_plugin_is_found_from_elsewhere(cli, here, monkeypatch):
    (here / "mine.py").write_text(
        "from proc3s import MethodSpec, hookimpl\n\n@hookimpl\ndef register_methods(register):\n"
        "    register(MethodSpec(name='mine', summary='', template='proc3s', answer='sketch'))\n"
    )
    assert cli("run", "drawing/star", "--method", "mine", "--plugin", "mine.py", "--out", "first").code == 0
    (here / "elsewhere").mkdir()
    monkeypatch.chdir(here / "elsewhere")
    assert cli("replay", "../first").code == 0


def test_the_log_of_a_replay_names_what_it_replays(cli, here):
    cli("run", "drawing/star", "--out", "first")
    cli("replay", "first", "--out", "second")
    assert json.loads((here / "second/summary.json").read_text())["task"] == "drawing/star"
    assert (here / "second/program-0.py").read_text() == (here / "first/program-0.py").read_text()
