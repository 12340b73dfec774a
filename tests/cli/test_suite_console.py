"""What a suite says while it runs, and its tables in a terminal of 80 columns."""

import io
import re

import pytest
from rich.console import Console

from proc3s.cli.console.lines import print_line
from proc3s.cli.console.suite import SuiteConsole
from proc3s.cli.console.tables import print_table
from proc3s.specs.suite import Cell, SuiteSpec
from proc3s.suites.episode import Episode
from proc3s.suites.outcomes import Unfinished

SPEC = SuiteSpec(name="mine", summary="Mine.", tasks=("drawing/star",), methods=("cap", "proc3s"), seeds=5)


def episode(seed, **more):
    return Episode(task="drawing/star", method="proc3s", preset="best", seed=seed, samples=9, **more)


MISSED = {"executed": "solution", "solved": True, "judged": True, "goal_reached": False}


@pytest.mark.parametrize(
    ("outcome", "said"),
    [
        (episode(3, **{**MISSED, "goal_reached": True}), "seed 3: solved, goal reached, 9 samples ("),
        (
            episode(3, **MISSED, goal_reason="four points"),
            "seed 3: solved, goal missed, 9 samples: four points (",
        ),
        (
            episode(3, judged=True, failure="step 0 (draw_line): line touches object_3"),
            "seed 3: unsolved, no plan, 9 samples: step 0 (draw_line): line touches object_3 (",
        ),
        (
            Unfinished(Cell("drawing/star", "proc3s", "best", 3), "llm", "no key"),
            "seed 3: not finished, error: no key (",
        ),
    ],
)
def test_a_line_says_how_far_it_is_what_it_costs_and_why(capsys, outcome, said):
    with SuiteConsole(SPEC, [episode(0)], quiet=False) as console:
        console.add(outcome, "0.0134")
    line = capsys.readouterr().err
    assert line.startswith(f"[2/10] drawing/star proc3s {said}")
    assert re.search(r"\(0\.0134 \$, about \d+ (s|min) left\)\n$", line)
    assert line.count("\n") == 1


def test_money_that_nothing_costs_is_not_told(capsys):
    with SuiteConsole(SPEC, [episode(seed) for seed in range(9)], quiet=False) as console:
        console.add(episode(9, **MISSED, goal_reason="four points"), "0.0000")
    assert capsys.readouterr().err.endswith("9 samples: four points\n")


def printed(head, lines, width=80, keys=1):
    out = io.StringIO()
    print_table(Console(file=out, width=width), head, lines, keys)
    return [line.rstrip() for line in out.getvalue().splitlines()]


def test_a_table_that_fits_is_printed_as_it_is():
    assert printed(("method", "star"), [("cap", "**1**")]) == ["method  star", "cap     1"]


def test_a_table_that_is_too_wide_is_turned():
    tasks = [f"drawing/task-of-a-long-name-{k}" for k in range(8)]
    lines = printed(("method", *tasks), [("cap", *"abcdefgh"), ("proc3s", *"ijklmnop")])
    assert lines[0].split() == ["method", "cap", "proc3s"]
    assert [line.split() for line in lines[1:3]] == [[tasks[0], "a", "i"], [tasks[1], "b", "j"]]


@pytest.mark.parametrize("keys", [1, 2])
def test_one_that_is_too_wide_both_ways_stands_in_parts_and_loses_nothing(keys):
    head = ["method", *(f"drawing/column-{k}" for k in "abcdefghijkl")]
    rows = [[f"method-{i}", *(f"{i}.{k} [0.1, 0.9]" for k in range(12))] for i in range(9)]
    lines = printed(head, rows, keys=keys)
    text = "\n".join(lines)
    assert max(map(len, lines)) <= 80
    assert "…" not in text
    assert all(text.count(name) == 1 for name in head[keys:])
    assert all(cell in text for row in rows for cell in row)
    assert all(line.startswith("method") for line in lines)


def test_a_terminal_breaks_lines_between_words_and_nobody_else_does():
    said = "  collision: the hand over the bowl touches the tall block that stands beside it"
    out, pipe = io.StringIO(), io.StringIO()
    print_line(Console(file=out, width=40, force_terminal=True), said)
    print_line(Console(file=pipe, width=40), said)
    lines = out.getvalue().splitlines()
    assert len(lines) > 1
    assert all(line.startswith("  ") and len(line) <= 40 for line in lines)
    assert " ".join(line.strip() for line in lines) == said.strip()
    assert pipe.getvalue() == said + "\n"
