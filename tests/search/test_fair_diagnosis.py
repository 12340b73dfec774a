"""A screen that is not exact may name another failure than the world; the diagnosis does not."""

import dataclasses
from pathlib import Path

import pytest

from proc3s import Action, ScreenSpec, Trial, Violation
from proc3s.feedback.diagnosis import diagnose
from proc3s.plugins.loose_files import import_loose_file

HINDSIGHT = ScreenSpec(name="hindsight", target="shaky:hindsight")


def failed(constraint, step, text, screen=None):
    return Trial(violations=(Violation(constraint, step, "hop", -1.0, text),), reached=step, screen=screen)


SCREENED = [failed("on_line", 4, "went too far", "hindsight")] * 60
WORLD = [failed("no_pit", 1, "fell into pit 1")] * 20
EXACT = [failed("no_pit", 0, "fell into pit 0", "listed")] * 20


@pytest.fixture
def made(problem):
    import_loose_file(Path(__file__).with_name("shaky.py"))
    exact = problem("listed")
    spec = exact.domain.spec
    return dataclasses.replace(
        exact,
        domain=dataclasses.replace(
            exact.domain, spec=spec.model_copy(update={"screens": (*spec.screens, HINDSIGHT)})
        ),
    )


def table(diagnosis):
    return [(f.kind, f.step, f.text, f.share) for f in diagnosis.failures]


def test_those_reviewed_stand_for_all_that_were_rejected(made):
    reviewed = [failed("no_pit", 2, "fell into pit 2")] * 3 + [failed("no_pit", 1, "fell into pit 1")]
    found = diagnose([*SCREENED, *WORLD, *EXACT], None, made, None, reviewed)
    assert table(found) == [
        ("no_pit", 2, "fell into pit 2", 45),
        ("no_pit", 1, "fell into pit 1", 35),
        ("no_pit", 0, "fell into pit 0", 20),
    ]
    assert found.never_violated == ("on_line",)
    assert [(report.constraint, report.share) for report in found.constraints] == [("no_pit", 100)]


def test_one_that_the_world_accepts_is_no_failure(made):
    passed = Trial((Action("hop", (3.0,)),))
    reviewed = [passed, failed("no_pit", 2, "fell into pit 2")]
    found = diagnose(SCREENED, None, made, None, reviewed)
    assert (table(found), found.reached) == ([("no_pit", 2, "fell into pit 2", 50)], 2)
    assert table(diagnose(SCREENED, None, made, None, [passed])) == []


def test_with_exact_screens_nothing_changes(made):
    trials = [*WORLD, *EXACT]
    assert diagnose(trials, None, made) == diagnose(trials, None, made, None, ())


PROGRAM = """
def gen_plan(initial, first, second):
    return [Action("hop", [first]), Action("hop", [second]), Action("hop", [30.0])]


def gen_domain(initial):
    return {"first": ContinuousSampler(7, 11), "second": ContinuousSampler(1, 2)}
"""


def test_a_round_is_diagnosed_as_without_screens(cli, here):
    """Every sample falls into the first pit with its first hop."""
    folder = Path(__file__).parent
    text = (folder / "walk.yaml").read_text().replace("name: walk", "name: watched")
    (here / "domain.yaml").write_text(f'{text}\nscreens: [{{name: hindsight, target: "shaky:hindsight"}}]\n')
    (here / "program.py").write_text(PROGRAM)
    files = (folder / "walk.py", folder / "shaky.py", here / "domain.yaml")
    loose = [part for path in files for part in ("--plugin", path)]

    def run(*options):
        return cli(
            "solve", "watched/far", *loose, "--sketch", "program.py", "--samples", 50, "--json", *options
        )

    plain, screened = run("--no-screens").json, run().json
    assert screened["rejected_by"] == {"hindsight": 50}
    assert screened["violations"] == plain["violations"]
    nearest = screened["nearest"]["violations"][0]
    assert (nearest["constraint"], nearest["step"], nearest["text"]) == ("no_pit", 0, "fell into pit 0")
    assert plain["violations"][0]["text"] == "fell into pit 0"
