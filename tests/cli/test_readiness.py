"""Whatever can be missing is missed before anybody is asked."""

import textwrap

import pytest

MODEL = """
from pathlib import Path
from proc3s import LLM, LLMSpec, answer, hookimpl


class Counting(LLM):
    def __init__(self, model, options):
        pass

    def complete(self, request):
        Path("asked").touch()
        return answer("no program", "counting")


@hookimpl
def register_llms(register):
    target = "counting:Counting"
    register(LLMSpec(name="counting", summary="Notes that it was asked.", usage="counting", target=target))
"""
BROKEN = """
from pathlib import Path
from proc3s import World, hookimpl, load_domain

class Canvas(World):
    def __init__(self, domain):
        raise OSError("no simulator here")

class Screen:
    def __init__(self, domain):
        raise OSError("no screen here")

def line(world, length):
    world.state = world.state

def scene(rng):
    return {}

def bad_scene(rng):
    raise OSError("no scene here")

@hookimpl
def register_domains(register):
    register(load_domain(Path(__file__).with_name("broken.yaml")))
"""
SPEC = """
spec_version: 1
name: broken
summary: Nothing works.
world: {target: "proc3s.domain.world:World"}
state: Sheet
types: {Sheet: {summary: A sheet., fields: {ink: {type: float, default: 1.0}}}}
skills: {line: {summary: Draws., target: "broken:line", params: {length: {type: float}}}}
samplers: [ContinuousSampler]
constraints: {}
tasks: {any: {instruction: Draw., initial: {target: "broken:scene"}}}
budget: {paper: 10, release: 10}
"""
CHANGES = {
    "world": ("proc3s.domain.world:World", "broken:Canvas", "no simulator here"),
    "execution": ("samplers:", 'execution: {target: "broken:Canvas"}\nsamplers:', "no simulator here"),
    "screen": (
        "samplers:",
        'screens: [{name: s, target: "broken:Screen", stateful: true}]\nsamplers:',
        "no screen here",
    ),
    "missing screen": ("samplers:", 'screens: [{name: s, target: "broken:Scren"}]\nsamplers:', "Scren"),
    "constraint": ("constraints: {}", 'constraints: {c: {says: "c", target: "broken:c"}}', "broken"),
    "judge": ('"broken:scene"}', '"broken:scene"}, judge: [{target: "broken:judge"}]', "broken"),
    "scene": ("broken:scene", "broken:bad_scene", "no scene here"),
}


@pytest.fixture
def counting(here):
    (here / "counting.py").write_text(MODEL)
    return ("--llm", "counting", "--plugin", "counting.py")


@pytest.mark.parametrize("missing", [("pybullet", "mujoco"), ("airo_models",)])
def test_an_extra_that_is_missing_costs_no_answer(shell, here, counting, missing):
    hidden = here / "hidden"
    hidden.mkdir()
    for name in missing:
        (hidden / f"{name}.py").write_text(
            f"raise ModuleNotFoundError('No module named {name}', name={name!r})"
        )
    result = shell("run", "blocks/pyramid", *counting, env={"PYTHONPATH": str(hidden)})
    assert result.code == 2
    assert f"the table-top needs {missing[0]}: pip install 'proc3s[tabletop]'" in result.stderr
    assert not (here / "asked").exists()
    assert not (here / "runs").exists()


@pytest.mark.parametrize("part", CHANGES)
def test_a_part_that_does_not_work_costs_no_answer(cli, here, counting, part):
    old, new, words = CHANGES[part]
    (here / "broken.py").write_text(textwrap.dedent(BROKEN))
    (here / "broken.yaml").write_text(SPEC.replace(old, new))
    result = cli("run", "broken/any", "--plugin", "broken.py", *counting)
    assert (result.code, words in result.stderr) == (2, True), result.stderr
    assert not (here / "asked").exists()


def test_a_domain_that_works_is_asked_about(cli, here, counting):
    (here / "broken.py").write_text(textwrap.dedent(BROKEN))
    (here / "broken.yaml").write_text(SPEC)
    assert cli("run", "broken/any", "--plugin", "broken.py", *counting, "--feedback", 0).code == 1
    assert (here / "asked").exists()
