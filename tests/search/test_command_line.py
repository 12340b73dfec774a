"""Screens, workers and loose files as the command line uses them."""

import json
import os
import shutil
import signal
from pathlib import Path

import pytest

from .conftest import LOOSE

STAR = """
def gen_plan(initial, x, y, radius, turn):
    angles = [turn + 0.8 * math.pi * k for k in range(6)]
    points = [(x + radius * math.cos(angle), y + radius * math.sin(angle)) for angle in angles]
    return [Action("draw_line", [*a, *b]) for a, b in zip(points, points[1:])]

def gen_domain(initial):
    where = ContinuousSampler(0, 100)
    return {"x": where, "y": where, "radius": ContinuousSampler(25, 45), "turn": ContinuousSampler(0, 1.2)}
"""
HOPS = """
def gen_plan(initial, a, b, c, d):
    return [Action("hop", [by]) for by in (a, b, c, d)]

def gen_domain(initial):
    return {name: ContinuousSampler(LOW, 40) for name in "abcd"}
"""


@pytest.fixture
def solve(cli, here):
    def run(task, program, *args):
        (here / "program.py").write_text(program)
        return cli("solve", task, "--sketch", "program.py", "--json", *args).json

    return run


def common(summary):
    return {k: summary[k] for k in ("solved", "plan", "samples", "violations")}


@pytest.mark.slow
def test_screens_and_jobs_change_no_result(solve):
    options = ("--preset", "paper", "--no-check-goal", "--solver", "rejection")
    screened = solve("drawing/star", STAR, *options)
    bare = solve("drawing/star", STAR, *options, "--no-screens")
    parallel = solve("drawing/star", STAR, *options, "--no-screens", "--jobs", 2)
    assert screened["solved"]
    assert screened["samples"] > 10
    assert common(screened) == common(bare) == common(parallel)
    assert screened["rejected_by"] == {"segments": screened["samples"] - screened["evaluations"]}
    assert bare["rejected_by"] == {"segments": 0}
    assert bare["evaluations"] == parallel["evaluations"] == bare["samples"]


def test_an_audit_of_the_drawing_screen_finds_nothing_wrong(solve, here, events):
    options = ("--preset", "paper", "--no-check-goal", "--solver", "rejection", "--audit", 25)
    summary = solve("drawing/star", STAR, *options)
    assert summary["rejected_by"]["segments"] > 0
    (audited,) = events(Path(summary["run_dir"]), "audited")
    assert audited["checked"] == min(25, summary["rejected_by"]["segments"])
    assert audited["wrong"] == []


def test_a_domain_in_a_loose_file_works_in_workers(solve):
    program = HOPS.replace("LOW", "0")
    alone, together = (solve("walk/far", program, "--plugin", LOOSE, "--jobs", jobs) for jobs in (1, 2))
    assert alone["solved"]
    assert {**common(alone), "n": alone["evaluations"]} == {**common(together), "n": together["evaluations"]}


@pytest.mark.slow
def test_a_loose_file_that_does_not_load_leaves_the_workers_alone(solve, here):
    (here / "proc3s_plugins.py").write_text("raise RuntimeError('half written')\n")
    program = HOPS.replace("LOW", "0")
    alone, together = (solve("walk/far", program, "--plugin", LOOSE, "--jobs", jobs) for jobs in (1, 2))
    assert together["error"] is None
    assert common(alone) == common(together)


def children(pid):
    listed = Path(f"/proc/{pid}/task").glob("*/children")
    return {int(child) for path in listed for child in path.read_text().split()}


def alive(pid):
    stat = Path(f"/proc/{pid}/stat")
    return stat.exists() and stat.read_text().rpartition(")")[2].split()[0] != "Z"


def test_workers_end_with_their_parent(background, here, eventually):
    shutil.copy(LOOSE, here / "walk.py")
    yaml = LOOSE.with_suffix(".yaml").read_text()
    slow = json.dumps({"target": "walk:Walk", "args": {"seconds": 0.05}})
    (here / "walk.yaml").write_text(yaml.replace('{target: "walk:Walk"}', slow))
    (here / "program.py").write_text(HOPS.replace("LOW", "30"))
    args = ("solve", "walk/far", "--sketch", "program.py", "--plugin", "walk.py", "--jobs", 2)
    with background(*args) as process:
        eventually(lambda: len(list(here.glob("runs/2*/events.jsonl"))) == 1)
        eventually(lambda: len(children(process.pid)) >= 3, 30)
        workers = children(process.pid)
        os.kill(process.pid, signal.SIGKILL)
        process.wait(timeout=20)
        eventually(lambda: not any(map(alive, workers)))
