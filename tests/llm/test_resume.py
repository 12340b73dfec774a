"""Going on with a run that was broken off."""

import json
import signal

import pytest

from proc3s.runs.reading import read_events

FAULT = {"fault": "auth", "message": "the key is wrong"}


def test_nothing_is_asked_or_searched_twice(cli, script, texts, asked, events, here):
    args = script(texts.outside, texts.outside, FAULT, texts.star)
    flags = ("--samples", 60, "--preset", "paper")
    broken = cli("run", "drawing/star", *args, *flags, "--out", "r")
    assert broken.code == 3
    assert "proc3s run --resume r" in broken.stderr
    result = cli("run", "--resume", "r", "--json")
    assert (result.code, result.json["rounds"], len(asked())) == (0, 2, 4)
    kept = [(e["round"], e["samples"]) for e in events(here / "r", "attempt_ended")]
    assert kept[:2] == [(0, 60), (1, 60)]
    assert result.json["samples"] == sum(samples for _, samples in kept)
    assert result.json["error"] is None
    assert json.loads((here / "r/summary.json").read_text()) == result.json


def test_it_comes_to_what_an_unbroken_run_comes_to(cli, script, texts, here):
    flags = ("--samples", 60, "--json")
    whole = cli("run", "drawing/star", *script(texts.outside, texts.star), *flags).json
    (here / "script.asked").unlink()
    assert (
        cli("run", "drawing/star", *script(texts.outside, FAULT, texts.star), *flags, "--out", "r").code == 3
    )
    resumed = cli("run", "--resume", "r", "--json").json
    same = ("plan", "samples", "evaluations", "rejected_by", "rounds", "goal_reason")
    assert [resumed[key] for key in same] == [whole[key] for key in same]
    assert resumed["seconds"]["solve"] > 0


def test_an_answer_that_was_paid_for_is_used(cli, script, texts, asked, here):
    """The run was killed while it searched: the answer is there, the search begins again."""
    assert cli("run", "drawing/star", *script(texts.star), "--out", "r").code == 0
    lines = (here / "r/events.jsonl").read_text().splitlines(keepends=True)
    upto = next(i for i, line in enumerate(lines) if '"sketch_loaded"' in line)
    (here / "r/events.jsonl").write_text("".join(lines[:upto]) + lines[upto][:20])
    result = cli("run", "--resume", "r", "--json")
    assert (result.code, len(asked())) == (0, 1)
    assert result.json["usage"]["calls"] == 1
    assert read_events(here / "r")[-1]["event"] == "run_ended"


@pytest.mark.slow
@pytest.mark.parametrize("kept", [1, 2, 3, 4, 6])
def test_a_run_that_was_cut_off_anywhere(cli, script, texts, here, kept):
    args = script(*[texts.outside] * 2, *[texts.star] * 3)
    assert cli("run", "drawing/star", *args, "--samples", 60, "--out", "r").code == 0
    plan = json.loads((here / "r/plan.json").read_text())
    lines = (here / "r/events.jsonl").read_text().splitlines(keepends=True)
    (here / "r/events.jsonl").write_text("".join(lines[:kept]))
    (here / "script.asked").write_text("" if kept < 4 else "{}\n")
    result = cli("run", "--resume", "r", "--json")
    assert (result.code, result.json["plan"]) == (0, plan)


def test_killed_for_good(background, cli, eventually, script, texts, asked, here):
    slow = [{"texts": [texts.star], "seconds": 60}, texts.star]
    args = script(texts.outside, *slow)
    with background("run", "drawing/star", *args, "--samples", 60, "--out", "r") as process:
        eventually(lambda: len(asked()) == 2)
        process.send_signal(signal.SIGKILL)
        process.wait(10)
    result = cli("run", "--resume", "r", "--json")
    assert (result.code, result.json["rounds"], len(asked())) == (0, 1, 3)


@pytest.mark.slow
def test_the_budget_counts_what_was_spent_before(cli, script, texts, asked):
    args = script(texts.outside, texts.outside, texts.star)
    assert cli("run", "drawing/star", *args, "--samples", 60, "--max-calls", 1, "--out", "r").code == 1
    again = cli("run", "--resume", "r", "--json")
    assert (again.code, len(asked())) == (1, 1)
    more = cli("run", "--resume", "r", "--max-calls", 3, "--json")
    assert (more.code, len(asked())) == (0, 3)


def test_another_llm_may_go_on(cli, script, texts, stub):
    assert cli("run", "drawing/star", *script(texts.outside, FAULT), "--samples", 60, "--out", "r").code == 3
    result = cli("run", "--resume", "r", "--llm", stub("", texts.star), "--json")
    assert (result.code, result.json["llm_source"]) == (0, "authored")


def test_what_came_to_its_end_does_not_go_on(cli, script, texts):
    cli("run", "drawing/star", *script(texts.star), "--out", "r")
    result = cli("run", "--resume", "r")
    assert result.code == 2
    assert "came to its end" in result.stderr


def test_what_was_never_solved_does_not_go_on_either(cli, script, texts):
    cli("run", "drawing/star", *script(texts.outside), "--feedback", 0, "--samples", 20, "--out", "r")
    assert cli("run", "--resume", "r").code == 2


@pytest.mark.parametrize("option", [["--seed", 3], ["--samples", 9], ["--method", "cap"], ["--out", "x"]])
def test_a_run_keeps_what_it_is(cli, script, texts, option):
    cli("run", "drawing/star", *script(FAULT), "--out", "r")
    result = cli("run", "--resume", "r", *option)
    assert result.code == 2
    assert option[0].strip("-") in result.stderr


def test_another_task(cli, script):
    cli("run", "drawing/star", *script(FAULT, FAULT), "--out", "r")
    assert cli("run", "drawing/star", "--resume", "r").code == 3
    wrong = cli("run", "drawing/arrow", "--resume", "r")
    assert (wrong.code, "a run of drawing/star" in wrong.stderr) == (2, True)


def test_no_run(cli, here):
    assert cli("run", "--resume", "nowhere").code == 2
    assert not (here / "nowhere").exists()
    assert cli("run").code == 2


def test_a_solve_has_nothing_to_go_on_with(cli, here):
    (here / "x.py").write_text("def gen_plan(initial): return []\ndef gen_domain(initial): return {}\n")
    cli("solve", "drawing/star", "--sketch", "x.py", "--out", "r")
    assert cli("run", "--resume", "r").code == 2


def test_two_at_once(background, cli, eventually, script, texts, asked):
    with background("run", "drawing/star", *script({"texts": [""], "seconds": 60}), "--out", "r"):
        eventually(asked)
        result = cli("run", "--resume", "r")
    assert result.code == 2
    assert "another process" in result.stderr


def test_a_picture_of_the_past_in_the_prompt(cli, script, texts):
    """`render-prompt --round` shows what a resumed run is asked."""
    args = script([texts.hopeless, texts.outside], FAULT)
    cli("run", "drawing/star", *args, "--candidates", 2, "--samples", 60, "--out", "r")
    shown = cli("render-prompt", "drawing/star", "--round", 1, "--from", "r")
    assert shown.code == 0, shown.stderr
    assert texts.outside.strip() in shown.stdout
    assert texts.hopeless.strip() not in shown.stdout


def test_options_of_one_llm_do_not_go_to_another(cli, script, stub, texts, here):
    """An address, and with it a key, is meant for the model that it was given with."""
    (here / "desk").mkdir()
    assert cli("run", "drawing/star", "--llm", "manual:desk", "-L", "wait=0", "--out", "r").code == 4
    result = cli("run", "--resume", "r", "--llm", stub(texts.star), "--json")
    assert (result.code, result.json["llm_source"]) == (0, "authored")


def test_budgets_are_changed_one_by_one(cli, script, texts, asked):
    price = ("-L", "prompt_price=1", "-L", "completion_price=1")
    args = script(
        *[{"texts": [texts.outside], "usage": {"prompt_tokens": 500_000, "completion_tokens": 0}}] * 5
    )
    flags = ("--samples", 20, "--max-calls", 1, "--max-cost", 1, "--out", "r")
    assert cli("run", "drawing/star", *args, *price, *flags).code == 1
    result = cli("run", "--resume", "r", "--max-calls", 5, "--json")
    assert (result.json["stopped"], len(asked())) == ("budget", 1 + 1)
    assert "--max-cost" in result.json["error"]


@pytest.mark.slow
def test_what_was_changed_stays_changed(cli, script, texts, asked):
    args = script(*[texts.outside] * 3, texts.star)
    assert cli("run", "drawing/star", *args, "--samples", 60, "--max-calls", 1, "--out", "r").code == 1
    assert cli("run", "--resume", "r", "--max-calls", 2).code == 1
    result = cli("run", "--resume", "r", "--json")
    assert "2 of 2 calls" in result.json["error"]


def test_candidates_that_came_are_kept_when_it_is_killed(
    background, cli, eventually, script, texts, here, events
):
    """Answers are logged as they come, whichever is slow."""
    slow = {"texts": [texts.hopeless], "seconds": 30}
    args = script([texts.hopeless], slow, texts.outside, texts.star, texts.star)
    flags = ("--candidates", 4, "--llm-jobs", 3, "--samples", 60, "--out", "r")
    with background("run", "drawing/star", *args, *flags) as process:
        eventually(
            lambda: (here / "r/events.jsonl").is_file() and len(events(here / "r", "answer_received")) == 3
        )
        process.send_signal(signal.SIGKILL)
        process.wait(10)
    numbers = sorted(e["candidate"] for e in events(here / "r", "answer_received"))
    assert len(numbers) == len(set(numbers)) == 3


def test_control_c_makes_no_further_calls(background, eventually, script, texts, asked):
    slow = [{"texts": [texts.hopeless], "seconds": 3}] * 5
    with background(
        "run", "drawing/star", *script(*slow), "--candidates", 5, "--llm-jobs", 1, "--out", "r"
    ) as process:
        eventually(lambda: len(asked()) == 2)
        process.send_signal(signal.SIGINT)
        process.wait(2.5)
    assert process.returncode == 130
    assert len(asked()) == 2


def test_a_log_with_options_that_nobody_knows(cli, script, here):
    cli("run", "drawing/star", *script(FAULT), "--out", "r")
    log = (here / "r/events.jsonl").read_text()
    (here / "r/events.jsonl").write_text(log.replace('"options": {', '"options": {"zz": 1, ', 1))
    result = cli("run", "--resume", "r", "--json")
    assert (result.code, "zz" in result.json["error"]) == (2, True)


def test_replay_takes_the_best_of_several_programs(cli, script, texts):
    args = script([texts.outside, "no program"])
    cli("run", "drawing/star", *args, "--candidates", 2, "--feedback", 0, "--samples", 20, "--out", "r")
    assert cli("replay", "r", "--json").json["samples"] == 20
