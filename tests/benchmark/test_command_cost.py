"""What whole runs cost, measured from outside."""

import json
import sys

import pytest

SUMMARY = {"solved": True, "cpu_seconds": {"llm": 0.0, "solve": 0.002, "execute": 0.0, "total": 0.002}}


@pytest.fixture
def python(tmp_path):
    """Stands for the Python of another environment: prints, and ends with an exit code."""

    def make(text, code=0):
        path = tmp_path / "python"
        path.write_text(f"#!/bin/sh\ncat <<'END'\n{text}\nEND\necho 'no such scene' >&2\nexit {code}\n")
        path.chmod(0o755)
        return path

    return make


@pytest.mark.slow
def test_a_run_is_measured_by_stage_beside_that_of_another_environment(cli, here):
    args = ("bench", "command", "--tasks", "drawing/star", "--seeds", 2, "--preset", "release")
    result = cli(*args, "--against", sys.executable, "--out", "cost")
    assert result.code == 0, result.stderr
    document = json.loads((here / "cost/results.json").read_text())
    assert [(run["task"], run["seed"], run["solved"]) for run in document["runs"]] == [
        ("drawing/star", seed, True) for seed in (0, 0, 1, 1)
    ]
    for run in document["runs"]:
        assert run["cpu"].keys() == {"start and end", "llm", "solve", "execute"}
        assert run["cpu"]["start and end"] > 0.1  # numpy alone takes as long
        assert run["total"] == pytest.approx(sum(run["cpu"].values()))
    assert "drawing/star" in result.stdout


def test_the_cheaper_environment_is_named_with_its_ratio(cli, here, python):
    args = ("bench", "command", "--tasks", "drawing/star", "--seeds", 1)
    result = cli(*args, "--against", python(json.dumps(SUMMARY)), "--json")
    assert result.code == 0, result.stderr
    other, this = result.json["rows"]
    assert other["total"] < this["total"]
    assert other["cheaper"]["mean"] == pytest.approx(this["total"] / other["total"])
    assert this["cheaper"]["mean"] == pytest.approx(other["total"] / this["total"])


def test_a_run_that_does_not_come_to_its_end_is_told_with_its_last_words(cli, here, python):
    args = ("bench", "command", "--tasks", "drawing/star", "--seeds", 1)
    result = cli(*args, "--against", python("", code=2), "--out", "cost")
    assert result.code == 2
    assert "exit code 2: no such scene" in result.stderr
    assert json.loads((here / "cost/results.json").read_text())["error"]


def test_the_other_python_is_found_from_where_the_command_is_given(cli, here, python):
    (here / "there").symlink_to(python(json.dumps(SUMMARY)))
    args = ("bench", "command", "--tasks", "drawing/star", "--seeds", 1, "--against")
    assert cli(*args, "./there", "--out", "cost").code == 0
    missing = cli(*args, "./nowhere")
    assert (missing.code, missing.stderr) == (
        2,
        "proc3s: --against: there is no Python ./nowhere that can be run\n",
    )


@pytest.mark.parametrize(
    ("name", "said"),
    [("drawing/moon", "no task 'moon'"), ("moon", "moon"), ("drawing/free", "has no bundled answer")],
)
def test_tasks_are_those_with_a_bundled_answer(cli, here, name, said):
    result = cli("bench", "command", "--tasks", name)
    assert result.code == 2
    assert said in result.stderr
