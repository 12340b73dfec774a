"""`--improve`: after a plan is found, samples around it are tried for one with more room."""

import pytest


def counts(summary):
    return [summary[name] for name in ("samples", "evaluations", "rehearsals", "rounds")]


@pytest.fixture
def first(cli):
    """The first plan of a star."""
    return cli("run", "drawing/star", "--improve", 0, "--json", "--out", "first").json


def test_the_plan_that_is_carried_out_has_more_room_than_the_first(cli, first):
    better = cli("run", "drawing/star", "--json", "--out", "better").json
    assert better["solved"]
    assert better["goal_reached"]
    assert better["plan"] != first["plan"]
    assert better["room"]["value"] > first["room"]["value"]
    assert first["improved"] is None
    assert better["improved"]["room_before"] == pytest.approx(first["room"]["value"])
    assert better["improved"]["room_after"] == pytest.approx(better["room"]["value"])
    assert 0 < better["improved"]["samples"] <= 24


def test_its_samples_are_counted_apart(cli, first):
    better = cli("run", "drawing/star", "--improve", 6, "--json", "--out", "better").json
    assert counts(better) == counts(first)
    assert better["improved"]["samples"] <= 6


def test_the_presets_of_the_paper_take_the_first_plan(cli):
    summary = cli("run", "drawing/star", "--preset", "paper", "--json", "--out", "paper").json
    assert summary["improved"] is None
    assert summary["room"]["value"] > 0


def test_it_is_the_same_again_with_workers_and_in_a_replay(cli, here):
    one = cli("run", "drawing/star", "--json", "--out", "one").json
    two = cli("run", "drawing/star", "--jobs", 2, "--json", "--out", "two").json
    again = cli("replay", "one", "--json").json
    for other in (two, again):
        assert [other[k] for k in ("plan", "room", "improved")] == [
            one[k] for k in ("plan", "room", "improved")
        ]


def test_console_explanation_and_report_name_what_is_tightest(cli, here):
    shown = cli("run", "drawing/star", "--out", "run").stdout
    assert "room     " in shown
    assert "improved from " in shown
    assert "Its room is " in cli("explain", "run").stdout
    assert cli("report", "run").code == 0
    assert "Its room is " in (here / "run/report.html").read_text()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--improver", "rejection"), "--improver: rejection looks for progress; take one of roomier"),
        (("--solver", "roomier"), "--solver: roomier looks for room; take one of rejection"),
        (("--improver", "romier"), "--improver: there is no solver 'romier'; did you mean 'roomier'"),
    ],
)
def test_a_solver_does_what_it_is_for(cli, options, said):
    done = cli("run", "drawing/star", *options)
    assert done.code == 2
    assert said in done.stderr
    assert len(done.stderr.splitlines()) == 1


BROKEN = """
import numpy as np

from proc3s import SolverSpec, hookimpl


class Broken:
    def __init__(self, space, budget, rng, options):
        self.dim = space.dim

    def tell(self, trials):
        pass

    def ask(self, limit):
        {ask}


@hookimpl
def register_solvers(register):
    register(SolverSpec(name="broken", summary="Fails.", target="broken:Broken", objective="room"))
"""


@pytest.mark.parametrize(
    ("ask", "said"),
    [
        ("raise RuntimeError('no idea')", "RuntimeError: no idea"),
        ("return 'hello'", "an array of numbers"),
        ("return np.full((1, self.dim), 2.0)", "points of the unit cube"),
        ("raise KeyboardInterrupt", "interrupted"),
    ],
)
def test_what_goes_wrong_while_improving_costs_no_plan(cli, here, first, ask, said):
    (here / "broken.py").write_text(BROKEN.replace("{ask}", ask))
    done = cli("run", "drawing/star", "--improver", "broken", "--plugin", "broken.py", "--out", "run")
    assert done.code == 0, done.stderr
    words = " ".join(done.stdout.split())
    assert "improved not: no roomier plan among 0 samples around the first plan; ended early: " in words
    assert said in words
    assert cli("explain", "run", "--json").json["executed"]["plan"] == first["plan"]


def test_an_option_without_effect_is_told(cli, here):
    told = cli("run", "drawing/star", "--preset", "paper", "--improver", "roomier").stderr
    assert "--improver changes nothing: --improve is 0 with preset paper" in " ".join(told.split())
    told = cli("run", "drawing/star", "--method", "cap", "--improve", 4).stderr
    assert "cap draws no samples, so --improve changes nothing" in " ".join(told.split())


def test_a_replay_may_look_for_more_room(cli, here, first):
    again = cli("replay", "first", "--improve", 24, "--json").json
    assert again["room"]["value"] > first["room"]["value"]


@pytest.mark.slow
def test_whether_the_plan_passes_its_rehearsals_is_told(cli, here):
    summary = cli("run", "blocks/line", "--seed", 2, "--json", "--out", "line").json
    assert summary["improved"]["held"] in (True, False)
    assert "pass" in " ".join(cli("explain", "line").stdout.split())
