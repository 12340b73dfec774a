"""proc3s from Python: the functions that `import proc3s` offers, and what they return."""

import json
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import proc3s
from proc3s import Action, DomainSpec, Margin, Message, Score, SpecError, UsageError, World

PROGRAM = """
def gen_plan(initial, x):
    return [Action("slide", [x])]

def gen_domain(initial):
    return {"x": ContinuousSampler(0, 10)}
"""


class Track(World):
    """A cart on a rail."""


def slide(world, x):
    world.state = type(world.state)(x=x)
    return x


def short(transition):
    return Margin(5.0 - transition.telemetry)


def start(rng):
    return {"x": 0.0}


def far(final, plan):
    return Score(final.x > 4.0, f"the cart is at {final.x:.1f}")


def track(**changes):
    """A domain that is built in Python from functions."""
    return DomainSpec.model_validate(
        {
            "spec_version": 1,
            "name": "track",
            "summary": "A cart on a rail.",
            "world": {"target": Track},
            "types": {
                "Cart": {"summary": "It stands at x.", "fields": {"x": {"type": "float", "unit": "m"}}}
            },
            "state": "Cart",
            "skills": {"slide": {"summary": "Slides.", "target": slide, "params": {"x": {"type": "float"}}}},
            "samplers": ["ContinuousSampler"],
            "budget": {"paper": 200, "release": 200},
            "constraints": {"short": {"says": "too far", "target": short}},
            "tasks": {
                "far": {
                    "instruction": "go far",
                    "initial": {"target": start},
                    "judge": [{"target": far}],
                }
            },
            **changes,
        }
    )


def test_both_stages_and_every_field_of_the_result(here, capfd):
    result = proc3s.run("drawing/star", seed=3)
    assert (result.solved, result.goal_reached, result.error) == (True, True, None)
    assert "star" in result.reason
    assert all(isinstance(action, Action) for action in result.plan)
    assert "def gen_plan" in result.program
    assert len(result.states) == len(result.plan)
    assert len(result.states[-1].drawn_lines) == len(result.plan)
    assert result.picture().size[0] > 100
    assert result.cost.calls == 0
    assert "<img" in result._repr_html_()
    assert capfd.readouterr() == ("", "")
    assert list(here.iterdir()) == []


def test_the_command_line_finds_the_same_plan(here, cli):
    told = cli("run", "drawing/star", "--seed", 3, "--json").json
    result = proc3s.run("drawing/star", seed=3)
    assert [action.to_json() for action in result.plan] == told["plan"]
    assert result.summary.samples == told["samples"]


def test_trials_have_the_values_that_the_program_got(here):
    result = proc3s.run("drawing/star", seed=3)
    trials = result.trials
    assert len(trials) == result.summary.samples
    assert trials["accepted"].count(True) == 1
    turns, points = np.array(trials["turn"]), np.array(trials.u["turn"])
    assert np.allclose(turns / turns.max(), points / points.max())
    refused = [k for k, ok in enumerate(trials["accepted"]) if not ok]
    assert all(trials["violation"][k] and trials["margin"][k] < 0 for k in refused)
    table = trials.to_pandas()
    assert list(table["turn"]) == list(trials["turn"])
    assert "u.turn" in table


def test_a_run_folder_is_loaded_whoever_wrote_it(here, cli):
    cli("run", "drawing/star", "--seed", 3, "--out", "kept")
    loaded, again = proc3s.load_run("kept"), proc3s.run("drawing/star", seed=3, out="mine")
    assert loaded.plan == again.plan
    assert [repr(state) for state in loaded.states] == [repr(state) for state in again.states]
    assert (here / "mine" / "summary.json").is_file()
    with pytest.raises(UsageError, match="no run folder"):
        proc3s.load_run("elsewhere")


def test_a_run_of_a_log_without_samplers_still_has_its_points(here, cli):
    cli("run", "drawing/star", "--seed", 3, "--out", "old")
    log = here / "old" / "events.jsonl"
    events = [json.loads(line) for line in log.read_text().splitlines()]
    log.write_text(
        "".join(json.dumps({k: v for k, v in e.items() if k != "samplers"}) + "\n" for e in events)
    )
    trials = proc3s.load_run("old").trials
    assert trials["turn"] == [None] * len(trials)
    assert all(0 <= u < 1 for u in trials.u["turn"])


class First:
    """A solver of three lines: random samples, four at a time."""

    def __init__(self, space, budget, rng, options):
        self.space, self.rng = space, rng

    def ask(self, limit):
        return self.rng.random((min(limit, 4), self.space.dim))

    def tell(self, trials):
        """Learn nothing."""


def test_a_solver_of_ones_own(here):
    program = proc3s.run("drawing/star").program
    result = proc3s.solve("drawing/star", program, solver=First)
    assert result.solved
    assert result.summary.solver == "First"


def test_a_function_is_a_language_model(here):
    program, asked = proc3s.run("drawing/star").program, []

    def model(messages):
        asked.append(messages)
        return f"```python\n{program}\n```"

    result = proc3s.run("drawing/star", llm=model)
    assert result.solved
    assert all(isinstance(message, Message) for message in asked[0])
    assert asked[0] == proc3s.render_prompt("drawing/star")


def test_a_model_that_raises_ends_the_run_and_says_so(here):
    def model(messages):
        raise RuntimeError("out of coffee")

    result = proc3s.run("drawing/star", llm=model)
    assert not result.solved
    assert "out of coffee" in result.error


def test_a_domain_that_is_built_in_python(here):
    result = proc3s.solve("track/far", PROGRAM, domain=track())
    assert (result.solved, result.goal_reached) == (True, True)
    assert 4.0 < result.plan[0].args[0] <= 5.0
    assert result.states[0].x == result.plan[0].args[0]


def test_a_lambda_needs_one_process(here):
    constraints = {"short": {"says": "too far", "target": lambda t: 5.0 - t.telemetry}}
    assert proc3s.solve("track/far", PROGRAM, domain=track(constraints=constraints)).solved
    with pytest.raises(UsageError, match=r"constraints\.short.*jobs=1"):
        proc3s.solve("track/far", PROGRAM, domain=track(constraints=constraints), jobs=2)


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"sampels": 3}, "sampels"),
        ({"seed": -1}, "seed"),
        ({"solver": "rejektion"}, "did you mean 'rejection'"),
        ({"method": "nope"}, "method"),
    ],
)
def test_mistakes_are_typed_errors(here, wrong, says):
    with pytest.raises((UsageError, SpecError), match=says):
        proc3s.run("drawing/star", **wrong)


@pytest.mark.parametrize(
    ("program", "says"),
    [
        ("def gen_plan(:\n    pass", "Syntax"),
        (PROGRAM.replace("[x]", "[1 / 0]"), "division by zero"),
        (PROGRAM.replace("slide", "glide"), "glide"),
    ],
)
def test_a_program_that_fails_is_a_reason(here, program, says):
    result = proc3s.solve("track/far", program, domain=track())
    assert not result.solved
    assert says in result.reason
    assert "None" not in repr(result)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"program": "mine.py"}, "as its text"),
        ({"solver": First(None, 0, None, None)}, "a solver is given by name"),
    ],
)
def test_easy_mistakes_are_usage_errors(here, changes, says):
    with pytest.raises(UsageError, match=says):
        proc3s.solve(**{"task": "track/far", "program": PROGRAM, "domain": track(), **changes})


class Wide(First):
    """Asks for points of another space."""

    def ask(self, limit):
        return self.rng.random((2, 99))


class Beyond(First):
    """Asks for points outside the cube."""

    def ask(self, limit):
        return 2 + self.rng.random((2, self.space.dim))


@pytest.mark.parametrize("solver", [Wide, Beyond])
def test_a_solver_that_asks_for_no_points_of_the_cube_is_told(here, solver):
    assert "not points of" in proc3s.solve("track/far", PROGRAM, domain=track(), solver=solver).error


def test_a_function_that_gives_no_text_is_an_error_of_the_model(here):
    assert "returned None, not a text" in proc3s.run("drawing/star", llm=lambda messages: None).error


def test_states_of_a_run_whose_domain_was_an_object(here):
    proc3s.solve("track/far", PROGRAM, domain=track(), out="kept")
    with pytest.raises(UsageError, match="no domain 'track'"):
        _ = proc3s.load_run("kept").states
    assert len(proc3s.load_run("kept", domain=track()).states) == 1


def test_trials_are_shown_in_a_line(here):
    assert re.fullmatch(
        r"<\d+ trials?, 1 accepted, of x>", repr(proc3s.solve("track/far", PROGRAM, domain=track()).trials)
    )


def test_events_are_heard_in_order(here):
    heard = []
    proc3s.run("drawing/star", on_event=lambda event: heard.append(event.event))
    assert heard[0] == "run_started"
    assert heard[-1] == "run_ended"
    assert "batch_evaluated" in heard


def test_progress_is_shown_when_it_is_asked_for(here, capfd, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")  # what a terminal gets
    assert proc3s.run("drawing/star", progress=True).solved
    shown, told = capfd.readouterr()
    assert shown == ""
    assert "sampling" in told


def test_tasks_and_domains():
    assert "drawing/star" in proc3s.tasks()
    assert "pick" in proc3s.get_domain("blocks").spec.skills


def test_no_public_function_bears_the_name_of_a_subpackage():
    packages = {module.name for module in pkgutil.iter_modules(proc3s.__path__)}
    assert packages & set(proc3s.__all__) == set()


SCRIPT = """
import proc3s
result = proc3s.run("drawing/star", jobs=2)
print(result.solved, [action.to_json() for action in result.plan])
"""


@pytest.mark.slow
def test_a_script_without_a_main_guard_works_with_two_jobs(here):
    (here / "script.py").write_text(SCRIPT)
    done = subprocess.run([sys.executable, "script.py"], capture_output=True, text=True, timeout=120)
    plan = [action.to_json() for action in proc3s.run("drawing/star").plan]
    assert (done.stdout, done.stderr) == (f"True {plan}\n", "")


def test_importing_proc3s_loads_nothing_heavy():
    code = (
        "import proc3s, sys; print([m for m in ('numpy', 'pydantic', 'litellm', 'rich') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=Path("/"))
    assert done.stdout == "[]\n"
