"""The field test carries plans out in several engines with several errors, and says how often they hold."""

import json
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest

from proc3s.benchmark.execution_test import FieldTest
from proc3s.suites.hold_rates import chart, hold_rates
from proc3s.suites.room_rates import room_chart, room_rates

PLUGIN = Path(__file__).parents[1] / "support/pegs/domain.yaml"
AIM = ("--tasks", "pegs/middle.aim", "--plugin", PLUGIN)


@pytest.fixture
def bench(cli):
    def run(*args):
        return cli("bench", "execution", "--out", "field", *args)

    return run


def test_plans_of_programs_are_carried_out_in_each_engine_with_each_error(bench, here):
    result = bench(*AIM, "--engines", "felt,ice", "--error", "0,2,8", "--seeds", 2, "--times", 5)
    assert result.code == 0, result.stderr
    document = json.loads((here / "field/results.json").read_text())
    names = ("seed", "robust", "improve", "engine", "error_mm", "times")
    keys = [tuple(test[name] for name in names) for test in document["tests"]]
    conditions = [(e, mm, 5 if mm else 1) for e in ("felt", "ice") for mm in (0.0, 2.0, 8.0)]
    ways = ((0, 0), (0, 24))
    assert keys == [(seed, *way, *each) for seed in (0, 1) for way in ways for each in conditions]
    rows = {(r["program"], r["improve"], r["engine"], r["error_mm"]): r for r in document["rows"]}
    assert len(rows) == len(document["rows"]) == 2 * 2 * 6
    held = {mm: rows["all", 0, "felt", mm]["satisfied"] for mm in (0.0, 2.0)}
    assert held == {0.0: "2/2", 2.0: "10/10"}  # 2 mm off, or less, still reaches the goal
    assert rows["all", 0, "ice", 8.0]["share"] < rows["all", 0, "felt", 8.0]["share"] < 1
    lines = result.stdout.splitlines()
    assert lines[1].split() == [
        "program",
        "robust",
        "improve",
        "engine",
        "mm",
        "plans",
        "held",
        "%",
        "95",
        "%",
        "interval",
    ]
    assert lines[2].split() == [
        "pegs/middle.aim",
        "0",
        "0",
        "felt",
        "0",
        "2",
        "2/2",
        "100",
        "34",
        "to",
        "100",
    ]
    assert (
        result.stderr.splitlines()[0] == "[1/24] pegs/middle.aim seed 0, room 250.0, felt, 0 mm: 1 of 1 hold"
    )
    assert ElementTree.parse(here / "field/hold_rates.svg").getroot().tag.endswith("svg")


def test_the_same_field_test_gives_the_same_counts(bench):
    args = (*AIM, "--error", 3, "--seeds", 1, "--json")
    one, two = bench(*args).json, bench(*args).json
    assert one["tests"] == two["tests"]
    assert {test["times"] for test in one["tests"]} == {10}


def test_without_errors_or_engines_it_is_the_field_test_with_disturbances(bench, here):
    result = bench(*AIM, "--seeds", 1, "--times", 3)
    assert result.stdout.splitlines()[1].split() == [
        *("program", "rehearsals", "improve", "solved", "samples", "satisfied", "share")
    ]
    tests = json.loads((here / "field/results.json").read_text())["tests"]
    assert [(test["error_mm"], test["satisfied"]) for test in tests] == [(None, 3), (None, 3)]
    assert not (here / "field/hold_rates.svg").exists()


@pytest.fixture
def runs(cli, here):
    """Two runs with an accepted plan, one with a goal of its own, and one without a plan."""
    solve = ("--sketch", PLUGIN.parent / "bench/middle.aim.py", "--plugin", PLUGIN)
    for seed in (0, 1):
        cli("solve", "pegs/middle", *solve, "--seed", seed, "--out", f"mine/{seed}")
    cli("solve", "pegs/middle", *solve, "--goal", "Anywhere.", "--out", "mine/own")
    (here / "far.py").write_text(solve[1].read_text().replace("0.0002", "9", 1).replace("0.0002", "-8"))
    cli("solve", "pegs/middle", "--sketch", "far.py", "--plugin", PLUGIN, "--out", "mine/none")
    return here / "mine"


def test_the_plans_of_runs_are_taken_as_they_are(bench, runs):
    result = bench("--runs", runs, "--plugin", PLUGIN, "--error", "0,1", "--times", 2)
    assert result.code == 0, result.stderr
    assert "2 of 4 runs are left out: no accepted plan" in result.stderr
    lines = [line.split() for line in result.stdout.splitlines()[2:6]]
    assert [(line[0], line[4], line[6]) for line in lines] == [
        ("pegs/middle.proc3s", "0", "2/2"),
        ("pegs/middle.proc3s", "1", "4/4"),
        ("all", "0", "2/2"),
        ("all", "1", "4/4"),
    ]
    missing = bench("--runs", runs, "--plugin", PLUGIN, "--tasks", "peg")
    assert "these runs have no accepted plan for 'peg'; did you mean 'pegs'" in missing.stderr
    fewer = ("--runs", runs, "--plugin", PLUGIN, "--error", 0, "--json")
    assert len(bench(*fewer, "--tasks", "pegs/middle").json["tests"]) == 2


def test_a_plan_that_several_runs_have_counts_once_and_a_run_may_be_named_itself(bench, cli, runs, here):
    cli("replay", runs / "0", "--plugin", PLUGIN, "--out", "mine/again")
    result = bench("--runs", runs, "--plugin", PLUGIN, "--error", 0, "--engines", "ice,ice")
    assert "1 run more with the plan of another one: each plan counts once" in result.stderr
    tests = json.loads((here / "field/results.json").read_text())["tests"]
    assert len(tests) == 2
    assert {Path(test["run"]).parent.name for test in tests} == {"mine"}
    assert len(bench("--runs", runs / "1", "--plugin", PLUGIN, "--error", 0, "--json").json["tests"]) == 1


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (("--tasks", "drawing/star.open", "--error", 1), "a world with such errors"),
        (
            ("--tasks", "drawing/star.open", "--engines", "ice"),
            "--engines: the world of drawing has no engines to choose from",
        ),
        ((*AIM, "--engines", "sand"), "not 'sand'"),
        ((*AIM, "--error", "1,two"), "--error takes numbers with commas between them"),
        ((*AIM, "--error", "1,-2"), "an error is 0 to 50 mm, not -2"),
        ((*AIM, "--error", ""), "--error is empty"),
        (("--runs", "nowhere", "--error", 1), "there is no folder nowhere"),
        (("--runs", ".", "--seeds", 2), "leave --seeds out"),
        (("--runs", ".", "--robust", 2), "leave --robust out"),
        (("--runs", ".", "--improve", 2), "leave --improve out"),
        (("--runs", ".", "--tasks", "pegs"), "there is no run in ."),
    ],
)
def test_what_cannot_be_tested_is_a_usage_error_in_a_line(bench, here, args, said):
    result = bench(*args)
    assert result.code == 2
    assert said in result.stderr
    assert len(result.stderr.splitlines()) == 1
    assert not list(here.iterdir())


def made(engine, error_mm, satisfied, times=10, robust=0, case="a/b.c"):
    return FieldTest(case, None, robust, 0, 0, True, 5, 0, None, engine, error_mm, times, satisfied)


def test_rates_pool_the_plans_of_a_program_and_those_of_all():
    done = [made("one", 1.0, 9), made("one", 1.0, 6), made("one", 1.0, 0, case="a/b.d"), made("two", 1.0, 10)]
    rates = [(r.program, r.engine, r.held, r.times) for r in hold_rates(done)]
    assert rates == [
        ("a/b.c", "one", 15, 20),
        ("a/b.d", "one", 0, 10),
        ("a/b.c", "two", 10, 10),
        ("all", "one", 15, 30),
        ("all", "two", 10, 10),
    ]
    share = hold_rates(done)[0].rate
    assert (share.value, share.low, share.high) == pytest.approx((0.75, 0.5313, 0.8881), abs=1e-4)


def test_a_chart_has_a_line_for_each_engine_and_number_of_rehearsals_and_none_without_errors():
    rates = hold_rates(
        [made(e, mm, 9, robust=r) for e in ("one", "two") for mm in (0.0, 2.0) for r in (0, 2)]
    )
    assert chart(rates) == chart(rates)
    assert len(chart(rates)) > len(chart(rates[:-2]))
    assert chart(hold_rates([made("one", None, 9)])) is None
    assert chart(hold_rates([made("one", 1.0, 0, times=0)])) is None


def test_rates_are_given_by_room_too_and_a_plan_that_was_not_improved_counts_once():
    roomy = replace(made("one", 2.0, 10), room=3.2)
    tight = [
        replace(made("one", 2.0, held), room=room, seed=k) for k, held, room in ((0, 4, 0.2), (1, 6, 0.4))
    ]
    unknown = made("one", 2.0, 1)
    rates = room_rates([roomy, replace(roomy, robust=2, improve=24), *tight, unknown])
    found = [(r.room, r.engine, r.error_mm, r.held, r.times) for r in rates]
    assert found == [("0 to 0.5", "one", 2.0, 10, 20), ("3 and more", "one", 2.0, 10, 10)]
    assert [rates[0].of_seeds(odd).held for odd in (False, True)] == [4, 6]


def test_a_chart_has_the_rates_over_the_room_of_even_and_odd_seeds():
    tests = [replace(made("one", 2.0, 10), room=room, seed=k) for k, room in enumerate((0.2, 3.1, 1.4))]
    assert len(room_chart(room_rates(tests))) > len(room_chart(room_rates(tests[:1])))
    assert room_chart(room_rates([made("one", 2.0, 9)])) is None
