"""Programs that fail in the same way in every sample, and those that only hang now and then."""

import itertools
import json
import re

import pytest

HEAD = "```python\ndef gen_plan(initial, x):\n"
TAIL = '\n\ndef gen_domain(initial):\n    return {"x": ContinuousSampler(0, 100)}\n```'
LINE = '    return [Action("draw_line", [x, 1.0, x, 2.0])]'
OUTSIDE = LINE.replace("2.0", "-2.0")


@pytest.fixture
def told(cli, tmp_path):
    """What a run of a program comes to: the summary, and the next question."""
    numbers = itertools.count()

    def run(body, *options):
        stub, folder = tmp_path / "stub.json", tmp_path / f"run{next(numbers)}"
        stub.write_text(json.dumps([HEAD + body + TAIL] * 2))
        done = cli(
            *("run", "drawing/free", "--goal", "a line", "--llm", f"stub:{stub}", "--out", folder),
            *("--json", "--feedback", 1, *options),
        )
        prompt = folder / "prompt-1.md"
        question = prompt.read_text().rpartition("```")[2] if prompt.exists() else ""
        return done.json, question

    return run


@pytest.mark.parametrize("preset", ["best", "paper"])
def test_a_round_ends_when_its_first_samples_all_raise_alike(told, preset):
    summary, question = told("    return [Action('draw_line', [x, x, x, undefined])]", "--preset", preset)
    assert summary["samples"] == 2 * 64
    assert "all of the first 64 samples raised the same exception at the same line" in question
    assert "name 'undefined' is not defined" in question


@pytest.mark.slow
def test_other_types_or_lines_are_no_such_end(told):
    for body in (
        "    raise (ValueError if x < 50 else TypeError)('no')",
        "    if x < 50:\n        raise ValueError('no')\n    raise ValueError('no')",
        "    if x < 80:\n        raise ValueError('no')\n" + OUTSIDE,
    ):
        summary, question = told(body, "--samples", 100)
        assert summary["samples"] == 200, body
        assert "all of the first" not in question


def test_a_program_that_is_empty_in_the_middle_is_solved(told):
    summary, _ = told(f"    if x > 60:\n    {LINE}\n    return []")
    assert summary["solved"]


def test_what_fails_in_some_samples_is_told_with_share_and_parameters(told):
    summary, question = told(f"    if x < 60:\n        return []\n{OUTSIDE}", "--samples", 200)
    told_of = (
        r"(55|60|65) % stopped with an error, with `x` between \d\.\d+ and (59\.\d|60\.0): the plan is empty"
    )
    assert re.search(told_of, question)
    (error,) = (e for e in summary["program_errors"] if e["message"] == "the plan is empty")
    assert error["parameters"].startswith("with `x` between ")


def test_why_a_round_ended_is_said(cli, tmp_path):
    (tmp_path / "x.py").write_text("def gen_plan(s, x):\n    return nothing\n\n" + TAIL[2:-4])
    done = cli("solve", "drawing/star", "--sketch", tmp_path / "x.py", "--out", tmp_path / "run")
    assert "no more were drawn: all of the first 64 raised the same exception" in done.stderr
    said = cli("explain", tmp_path / "run").stdout
    assert "no more were drawn, since all of the first 64 raised the same exception at the same line" in said


def test_a_program_that_hangs_now_and_then_is_solved(told):
    body = f"    while 47 < x < 52: pass\n    assert x > 97\n{LINE}"
    summary, _ = told(body, "--limit", "call=0.2")
    assert summary["solved"]


@pytest.mark.slow
def test_a_program_that_hangs_often_is_given_up(told):
    body = f"    while x < 30: pass\n{OUTSIDE}"
    summary, question = told(body, "--limit", "call=0.1", "--samples", 1000)
    assert 0 < summary["samples"] < 200
    assert "one call of gen_plan took longer than 0.1 s, as 3 samples had before" in question


@pytest.mark.parametrize("method", ["cap", "cap-gaussian"])
def test_a_plan_that_is_never_made_is_an_error_and_no_solution(cli, tmp_path, method):
    stub = tmp_path / "stub.json"
    stub.write_text(json.dumps(["```python\ndef gen_plan(initial):\n    return undefined\n```"] * 6))
    done = cli(
        *("run", "drawing/free", "--goal", "a line", "--llm", f"stub:{stub}", "--method", method, "--json"),
        *("--out", tmp_path / "run"),
    )
    assert done.code == 1
    assert not done.json["solved"]
    assert [e["message"] for e in done.json["program_errors"]] == [
        "NameError: name 'undefined' is not defined"
    ]
