"""A plugin that raises SystemExit, or what else no `except Exception` sees, is named; others go on."""

import json

import pytest

STAR = ("run", "drawing/star", "--llm", "replay")

PLUGIN = """
from proc3s import *
import numpy as np

class Stop(BaseException):
    pass

def quit(*args, **kwargs):
    raise RAISED

@hookimpl
def HOOK
"""
RAISED = ["SystemExit(0)", "Stop('enough')"]


def write(here, hook, raised="SystemExit(0)", name="mine"):
    """A plugin with one hook beside `quit`, which raises."""
    path = here / f"{name}.py"
    path.write_text(PLUGIN.replace("RAISED", raised).replace("HOOK", hook))
    return path


@pytest.mark.slow
@pytest.mark.parametrize("raised", RAISED)
@pytest.mark.parametrize(
    "text",
    [
        "on_event(event): pass\nquit()",
        "register_domains(register): quit()",
        "register_skills(register): quit()",
        "register_solvers(register): quit()",
        "register_templates(register): quit()",
    ],
)
@pytest.mark.parametrize("command", [STAR, ("list",), ("plugins",), ("plugins", "--strict")])
def test_a_plugin_that_ends_the_process_is_listed_and_others_go_on(cli, here, raised, text, command):
    write(here, text, raised, "proc3s_plugins")
    result = cli(*command)
    said = " ".join((result.stdout + result.stderr).split())
    assert result.code == (2 if "--strict" in command else 0)
    assert raised.partition("(")[0] in said
    assert {"run": "solved", "list": "drawing", "plugins": "loaded"}[command[0]] in said


@pytest.mark.slow
@pytest.mark.parametrize("raised", RAISED)
def test_hooks_that_are_called_later_end_nothing_either(cli, here, raised):
    for hook in ("on_event(event): quit()", "prompt_context(problem, method): quit()"):
        write(here, hook, raised, "proc3s_plugins")
        result = cli(*STAR)
        assert result.code == 0
        assert "plugin proc3s_plugins" in result.stderr
        assert raised.partition("(")[0] in result.stderr


def test_a_file_that_was_named_is_said_at_once(cli, here):
    result = cli(*STAR, "--plugin", write(here, "on_event(event): pass\nquit()"))
    assert result.code == 2
    assert "mine.py:9: plugin mine: raised SystemExit: 0" in result.stderr


PARTS = {
    "constraint calm": """register_constraints(register):
    register(ConstraintSpec(name="calm", says="not calm", target="mine:quit", domains=("drawing",)))
""",
    "solver": """register_solvers(register):
    register(SolverSpec(name="mine", summary="", target="mine:Solver"))

class Solver:
    def __init__(self, space, budget, rng, options): self.dim = space.dim
    def ask(self, limit): quit()
    def tell(self, trials): pass
""",
    "solver made": """register_solvers(register):
    register(SolverSpec(name="mine", summary="", target="mine:quit"))
""",
    "solver told": """register_solvers(register):
    register(SolverSpec(name="mine", summary="", target="mine:Solver"))

class Solver:
    def __init__(self, space, budget, rng, options): self.dim = space.dim
    def ask(self, limit): return np.full((1, self.dim), 0.99)
    def tell(self, trials): quit()
""",
    "executor": """register_executors(register):
    register(ExecutorSpec(name="mine", summary="", target="mine:Executor"))

class Executor:
    def __init__(self, jobs): pass
    def map(self, problem, plans): quit()
    def close(self): pass
""",
}
OPTIONS = {
    "constraint calm": ["--no-screens"],
    "solver": ["--solver", "mine"],
    "solver made": ["--solver", "mine"],
    "solver told": ["--solver", "mine"],
    "executor": ["--executor", "mine"],
}


@pytest.mark.parametrize("raised", RAISED)
@pytest.mark.parametrize("part", [part for part in PARTS if part in OPTIONS])
def test_a_part_that_ends_the_process_is_an_error_that_names_it(cli, here, raised, part):
    path = write(here, PARTS[part], raised)
    result = cli(*STAR, "--plugin", path, *OPTIONS[part], "--json")
    assert result.code == 2
    error = result.json["error"]
    assert part.partition(" ")[0] in error
    assert f"mine.py:9: {part.partition(' made')[0].partition(' told')[0]}" in error
    assert f"raised {raised.partition('(')[0]}" in error


DOMAIN = """
spec_version: 1
name: toy
summary: Dots.
world: {target: "proc3s:World"}
state: Dots
types: {Dots: {summary: Dots., fields: {count: {type: int}}}}
skills: {add: {summary: Adds dots., target: "SKILL", params: {by: {type: float}}}}
samplers: [ContinuousSampler]
constraints: {few: {says: too many dots, target: "CONSTRAINT"}}
screens: SCREENS
tasks: {three: {instruction: Make three dots., initial: {target: "INITIAL"}, judge: [{target: "JUDGE"}]}}
budget: {paper: 10}
"""
FUNCTIONS = """register_domains(register):
    from pathlib import Path
    register(load_domain(Path(__file__).with_name("toy.yaml")))

def none(rng): return {"count": 0}
def add(world, by): pass
def few(transition): return 3.0
def fine(state, plan): return Score(True, "fine")
def check(state, batch): return [None] * len(batch)
"""
PLAIN = {"SKILL": "add", "CONSTRAINT": "few", "INITIAL": "none", "JUDGE": "fine", "SCREENS": "check"}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("part", "named", "jobs"),
    [
        ("SKILL", "skill add", 1),
        ("SKILL", "skill add", 2),
        ("CONSTRAINT", "constraint few", 1),
        ("INITIAL", "scene of three", 1),
        ("JUDGE", "judge mine:quit of toy/three", 1),
        ("SCREENS", "screen mine", 1),
    ],
)
def test_parts_of_a_domain(cli, here, part, named, jobs):
    text = DOMAIN
    for key, name in {**PLAIN, part: "quit"}.items():
        screen = f'[{{name: mine, exact: true, target: "mine:{name}"}}]'
        text = text.replace(key, screen if key == "SCREENS" else f"mine:{name}")
    (here / "toy.yaml").write_text(text)
    path = write(here, FUNCTIONS)
    (here / "program.py").write_text(
        "def gen_plan(initial, by):\n    return [Action('add', [by])]\n\n"
        "def gen_domain(initial):\n    return {'by': ContinuousSampler(0, 1)}\n"
    )
    given = ("--sketch", "program.py", "--plugin", path, "--preset", "paper", "--samples", 5)
    result = cli("solve", "toy/three", *given, "--jobs", jobs, "--json")
    assert result.code == 2
    assert f"mine.py:9: {named}: raised SystemExit: 0" in result.json["error"]


def test_a_target_whose_module_ends_the_process(cli, here):
    (here / "toy.yaml").write_text(
        DOMAIN.replace("SCREENS", "[]")
        .replace("SKILL", "json:loads")
        .replace("CONSTRAINT", "json:loads")
        .replace("JUDGE", "json:loads")
        .replace("INITIAL", "leaving.inside:scene")
    )
    package = here / "leaving"
    package.mkdir()
    (package / "__init__.py").write_text("raise SystemExit(3)\n")
    result = cli("check", "toy.yaml")
    assert result.code == 2
    assert "leaving.inside" in result.stdout + result.stderr


def test_a_template_that_calls_what_ends_the_process(cli, here):
    (here / "mine/partials").mkdir(parents=True)
    (here / "mine/partials/task.j2").write_text("{{ leave() }}")
    path = write(here, "prompt_context(problem, method): return {'leave': quit}", name="given")
    result = cli("render-prompt", "drawing/star", "--template-dir", "mine", "--plugin", path)
    assert result.code == 2
    assert "task.j2:1" in result.stderr
    assert "SystemExit" in result.stderr


def test_events_are_still_written_when_a_listener_ends_the_process(cli, here):
    write(here, "on_event(event): quit()", name="proc3s_plugins")
    cli(*STAR, "--out", "run")
    assert json.loads((here / "run/summary.json").read_text())["solved"] is True


@pytest.mark.parametrize(("made", "decoded"), [("quit", "no"), ("no", "quit")])
def test_a_sampler(cli, here, made, decoded):
    path = write(
        here,
        f"""register_samplers(register):
    register(SamplerSpec(name="Die", summary="", params={{}}, domains=("drawing",), target="mine:Die"))

def no(*args): return args[-1]

class Die:
    dim = 1
    def __init__(self): {made}(self)
    def decode(self, u): return {decoded}(u)
""",
    )
    (here / "program.py").write_text(
        "def gen_plan(initial, x):\n    return [Action('draw_line', [x, 1.0, 2.0, 2.0])]\n\n"
        "def gen_domain(initial):\n    return {'x': Die()}\n"
    )
    result = cli("solve", "drawing/star", "--sketch", "program.py", "--plugin", path, "--json")
    assert result.code == 2
    assert "Die" in result.json["error"]
    assert "raised SystemExit: 0" in result.json["error"]
