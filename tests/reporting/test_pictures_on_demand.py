"""Pictures are drawn when somebody looks, from the film of a run or by carrying its plan out again."""

import json

import pytest

import proc3s
from proc3s import UsageError
from proc3s.plugins.registry import open_registry
from proc3s.runs.pictures import FILM, OUTCOME
from proc3s.suites.page import report_of

PLUGIN = """
import proc3s

class Counter(proc3s.World):
    def render(self, plan, path):
        path.write_text(f"after {len(plan)} at {self.state.at}")

class Filmed(Counter):
    def reset(self, state):
        self.frames = []
        super().reset(state)

    def save(self):
        self.frames.append(self.state.at)
        return self.state

    def film(self):
        return self.frames

    def render_film(self, initial, frames):
        for path, at in frames.items():
            path.write_text(f"at {at} from {initial.at}")

def hop(world, by):
    world.state = type(world.state)(world.state.at + by)

def start(rng):
    return {"at": 1}

def fine(transition):
    return proc3s.Margin(1.0)

def spec(name, world):
    return proc3s.DomainSpec.model_validate({
        "spec_version": 1, "name": name, "summary": "A counter.", "world": {"target": world},
        "state": "Place",
        "types": {"Place": {"summary": "Where.", "fields": {"at": {"type": "float"}}}},
        "skills": {"hop": {"summary": "Hops.", "target": hop, "params": {"by": {"type": "float"}}}},
        "constraints": {"fine": {"says": "never", "target": fine}},
        "tasks": {"far": {"instruction": "go", "initial": {"target": start}}},
        "samplers": ["ContinuousSampler"],
        "budget": {"best": 5, "paper": 5, "release": 5},
    })

@proc3s.hookimpl
def register_domains(register):
    register(spec("plain", Counter))
    register(spec("filmed", Filmed))
"""
HOPS = """
def gen_plan(initial, x):
    return [Action("hop", [2.0]), Action("hop", [3.0])]

def gen_domain(initial):
    return {"x": ContinuousSampler(0, 1)}
"""


@pytest.fixture
def hopped(cli, here):
    """Makes a run of two hops in a domain of the plugin; gives its folder."""
    (here / "hops.py").write_text(HOPS)
    (here / "counter.py").write_text(PLUGIN)

    def run(domain, *more):
        args = ("solve", f"{domain}/far", "--sketch", "hops.py", "--out", "run", "--plugin", "counter.py")
        done = cli(*args, *more)
        assert done.code == 0, done.stdout + done.stderr
        return here / "run"

    return run


def drawn(run):
    return {path.name: path.read_text() for path in run.glob("*.png")}


STEPS = {f"plan-step{k}.png": f"at {at} from 1.0" for k, at in enumerate([1.0, 3.0, 6.0])}


def test_only_the_outcome_is_drawn_and_the_film_is_kept(hopped, cli):
    run = hopped("filmed")
    assert drawn(run) == {OUTCOME: "after 2 at 6.0"}
    assert json.loads((run / FILM).read_text()) == [1.0, 3.0, 6.0]
    assert "`proc3s pictures run` draws all of the plan" in cli("explain", "run").stdout


def test_the_others_are_drawn_when_somebody_asks_and_once(hopped, cli):
    run = hopped("filmed")
    done = cli("pictures", "run")
    assert done.stdout.split() == [f"run/{name}" for name in [*STEPS, OUTCOME]]
    assert drawn(run) == {**STEPS, "plan-step2.png": "after 2 at 6.0", OUTCOME: "after 2 at 6.0"}
    (run / "plan-step1.png").write_text("mine")
    assert cli("pictures", "run", "--json").json["pictures"][1] == "run/plan-step1.png"
    assert drawn(run)["plan-step1.png"] == "mine"
    assert "proc3s pictures" not in cli("explain", "run").stdout


@pytest.mark.parametrize(
    ("which", "names"), [("all", {*STEPS, OUTCOME}), ("last", {OUTCOME}), ("none", set())]
)
def test_a_run_draws_at_once_what_it_is_told_to(hopped, which, names):
    run = hopped("filmed", "--pictures", which)
    assert set(drawn(run)) == names
    assert (run / FILM).is_file()


def test_a_world_without_a_film_carries_the_plan_out_again(hopped, cli):
    run = hopped("plain", "--pictures", "none")
    assert drawn(run) == {}
    assert not (run / FILM).exists()
    assert cli("pictures", "run").code == 0
    assert drawn(run) == {OUTCOME: "after 2 at 6.0"}


def test_the_report_asks_for_them(hopped, cli):
    run = hopped("filmed", "--pictures", "none")
    assert cli("report", "run", "--plugin", "counter.py").code == 0
    assert set(drawn(run)) == {*STEPS, OUTCOME}
    assert (run / "report.html").read_text().count("data:image/png") == 3


def test_a_report_without_the_domain_says_what_it_lacks(hopped, cli):
    hopped("filmed")
    done = cli("report", "run")
    assert done.code == 0
    assert "some pictures are missing: there is no domain 'filmed'" in done.stderr


def test_the_page_of_an_episode_draws_the_outcome_alone(hopped, here):
    run = hopped("filmed", "--pictures", "none")
    assert report_of(run, open_registry([here / "counter.py"])) == "report.html"
    assert drawn(run) == {OUTCOME: "at 6.0 from 1.0"}


def test_there_are_none_without_a_plan(cli, here):
    (here / "counter.py").write_text(PLUGIN)
    (here / "hops.py").write_text("def gen_plan(initial):\n    return [Action('hop', [None])]\n")
    more = ("--out", "none", "--plugin", "counter.py", "--pictures", "none")
    assert cli("solve", "filmed/far", "--sketch", "hops.py", *more).code == 1
    done = cli("pictures", "none")
    assert (done.code, "has no pictures" in done.stderr) == (2, True)


def test_a_broken_film_is_said(hopped, cli):
    (hopped("filmed") / FILM).write_text("[1, ")
    done = cli("pictures", "run")
    assert done.code == 2
    assert "film.json: not valid JSON" in done.stderr


def test_a_canvas_looks_the_same_from_its_film(cli, here):
    cli("run", "drawing/star", "--out", "now")
    cli("run", "drawing/star", "--out", "later", "--pictures", "none")
    assert not (here / "later" / OUTCOME).exists()
    assert proc3s.load_run(here / "later").picture().size[0] > 100
    assert (here / "later" / OUTCOME).read_bytes() == (here / "now" / OUTCOME).read_bytes()


def test_a_result_draws_a_step(hopped):
    result = proc3s.load_run(hopped("filmed"))
    with pytest.raises(UsageError, match="no picture plan-step7"):
        result.picture(7)
    assert (result.run_dir / "plan-step1.png").is_file()
