"""A table-top domain of one's own: YAML alone, but for the lines that register it."""

import pytest

DOMAIN = """
spec_version: 1
name: cans
summary: A robot arm moves cans and a tray on a table.
world: {target: "proc3s_tabletop.world:ReferenceWorld", args: {bodies: &bodies {
  can: {shape: cylinder, radius: 0.025, height: 0.06, mass: 0.15},
  tray: {shape: box, size: [0.12, 0.12, 0.01], mass: 0.2}}}}
execution: {target: "proc3s_tabletop.world:ExecutionWorld", args: {bodies: *bodies}}
state: Belief
objects: objects
types:
  Pose:
    summary: A pose.
    fields: {x: {type: float}, y: {type: float}, z: {type: float},
             roll: {type: float}, pitch: {type: float}, yaw: {type: float}}
    methods: "proc3s_tabletop.tasks.state_methods:PoseMethods"
  Thing:
    summary: A thing.
    fields: {category: {type: str}, color: {type: str}, pose: {type: Pose}, body: {type: str}}
    methods: "proc3s_tabletop.tasks.state_methods:ObjectMethods"
  Belief:
    summary: All things.
    fields: {objects: {type: "dict[Thing]"}}
    methods: "proc3s_tabletop.tasks.state_methods:BeliefMethods"
use: [pick, place, kinematic, collision, grasp, placement]
skills: {}
constraints: {}
samplers: [ContinuousSampler]
tasks:
  serve:
    instruction: Put the can on the tray.
    initial:
      target: "proc3s_tabletop.tasks.scenes:scene"
      args: {bodies: *bodies, objects: [{category: tray, at: [0.0, -0.6]}, {category: can, apart: 0.2}]}
    judge:
      - target: "proc3s_tabletop.tasks.judges:on"
        args: {bodies: *bodies, what: {category: can}, below: {category: tray}}
      - {target: "proc3s_tabletop.tasks.judges:upright", args: {bodies: *bodies}}
budget: {paper: 50, release: 50}
"""
PLUGIN = """
from pathlib import Path
from proc3s import hookimpl, load_domain

@hookimpl
def register_domains(register):
    register(load_domain(Path(__file__).parent / "domain.yaml"))
"""
SKETCH = """
def gen_plan(initial, x):
    tray, can = initial["object_0"], initial["object_1"]
    return [Action("pick", can.point), Action("place", [tray.pose.x + x, tray.pose.y, can.pose.z])]

def gen_domain(initial):
    return {"x": ContinuousSampler(-0.02, 0.02)}
"""


@pytest.fixture
def cans(here):
    """The files of the domain in the working directory; returns the options of a run."""
    (here / "domain.yaml").write_text(DOMAIN)
    (here / "cans.py").write_text(PLUGIN)
    (here / "serve.py").write_text(SKETCH)
    return ("solve", "cans/serve", "--sketch", "serve.py", "--plugin", "cans.py", "--json", "--out", "run")


def test_it_needs_no_python_of_its_own(cans, cli):
    summary = cli(*cans).json
    assert (summary["solved"], summary["goal_reached"]) == (True, True), summary
    assert "object_1 (the can)" in summary["goal_reason"]


def test_a_mistake_in_a_body_is_named(cans, cli, here):
    (here / "domain.yaml").write_text(DOMAIN.replace("height: 0.06", "hight: 0.06"))
    result = cli(*cans)
    assert result.code == 2
    assert "bodies.can: hight: unknown key 'hight'; did you mean 'height'" in result.json["error"]


def test_a_mesh_of_ones_own_lies_beside_the_spec(cans, cli, here):
    import trimesh

    (here / "meshes").mkdir()
    trimesh.creation.cylinder(radius=25, height=60).export(here / "meshes/can.stl")
    box = "{shape: cylinder, radius: 0.025, height: 0.06, mass: 0.15}"
    mesh = "{shape: mesh, path: ./meshes/can.stl, scale: 0.001, mass: 0.15}"
    (here / "domain.yaml").write_text(DOMAIN.replace(box, mesh))
    summary = cli(*cans).json
    assert (summary["solved"], summary["goal_reached"]) == (True, True), summary
    (here / "meshes/can.stl").unlink()
    assert "there is no file" in cli(*cans[:-1], "again").json["error"]


@pytest.mark.parametrize("place", ["[0.0, -0.9]", "[0.0, -0.6, -0.01]"])
def test_a_scene_that_no_plan_can_begin_from_is_refused_before_anybody_is_asked(cans, cli, here, place):
    (here / "domain.yaml").write_text(DOMAIN.replace("[0.0, -0.6]", place))
    (here / "stub.json").write_text('{"answers": ["no program"]}')
    command = ("run", "cans/serve", "--llm", "stub:stub.json", "--plugin", "cans.py", "--json")
    for result in (cli(*cans), cli(*command, "--out", "asked")):
        assert result.code == 2
        said = "100 mm" if "0.9" in place else "15 mm deep in the table"
        assert "the scene of cans/serve, seed 0: object_0 (the tray) " in result.json["error"]
        assert said in result.json["error"]
        assert (
            result.json["samples"],
            result.json["proposals" if "proposals" in result.json else "rounds"],
        ) == (0, 0)
    checked = cli("check", "cans", "--plugin", "cans.py")
    assert checked.code == 2
    assert said in checked.stdout
