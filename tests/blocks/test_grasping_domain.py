"""A domain of one's own whose skills name objects and grasps, from YAML to a plan that the world accepts."""

from pathlib import Path

import pytest
from test_own_domain import DOMAIN, PLUGIN

DOCS = Path(__file__).parents[2] / "docs" / "how-to" / "table-top-task.md"
SKILLS = (
    DOCS.read_text(encoding="utf-8")
    .split("## Name objects and grasps")[1]
    .split("```yaml")[1]
    .split("```")[0]
)
# at the paper's full scale of 1 m hardly any perturbed plan would hold
QUIET = SKILLS.replace("noise: 1.0", "noise: 0.01")
GRASPING = (
    DOMAIN.replace("skills: {}", QUIET)
    .replace("use: [pick, place, ", "use: [")
    .replace("samplers: [ContinuousSampler]", "samplers: [ContinuousSampler, GraspSampler]")
    .replace("PoseMethods", "RigidPoseMethods")
    .replace("Pose:", "ArrangePose:")
    .replace("type: Pose", "type: ArrangePose")
)
SKETCH = """
def gen_plan(initial, grasp, x):
    tray, can = initial["object_0"], initial["object_1"]
    spot = tray.pose.multiply(ArrangePose(x=x, y=0.0, z=can.pose.z, roll=0.0, pitch=0.0, yaw=0.0))
    return [Action("pick", ["object_1", grasp]), Action("place", ["object_1", np.array([*grasp]), spot])]

def gen_domain(initial):
    return {"grasp": GraspSampler(), "x": ContinuousSampler(-0.02, 0.02)}
"""
PROGRAM = """
def gen_plan(initial):
    grasp = ArrangePose(0.0, 0.0, 0.005, 0.0, np.pi, 0.0)
    spot = initial["object_0"].pose.multiply(ArrangePose(0.0, 0.0, 0.035, 0.0, 0.0, 0.0))
    return [Action("pick", ["object_1", grasp]), Action("place", ["object_1", grasp, spot])]
"""


@pytest.fixture
def cans(here):
    """The files of the domain in the working directory."""
    (here / "domain.yaml").write_text(GRASPING)
    (here / "cans.py").write_text(PLUGIN)
    (here / "serve.py").write_text(SKETCH)
    return ("cans/serve", "--plugin", "cans.py", "--json")


def test_grasps_are_drawn_until_one_holds(cans, cli):
    summary = cli("solve", *cans, "--sketch", "serve.py", "--out", "run").json
    assert (summary["solved"], summary["goal_reached"]) == (True, True), summary
    pick, place = summary["plan"]
    assert pick["args"][1] == place["args"][1]
    assert len(place["args"][2]) == 6


@pytest.mark.slow
def test_perturbed_grasps_of_a_pick_and_its_place_stay_one(cans, cli, stub):
    llm = stub(f"```python\n{PROGRAM}\n```")
    options = ("--method", "cap-gaussian", "--llm", llm, "--samples", "50", "--out", "run")
    summary = cli("run", *cans, *options, "--seed", "1").json
    assert summary["solved"], summary["error"]
    pick, place = summary["plan"]
    assert pick["args"][1] == place["args"][1]


def test_the_prompt_says_what_a_grasp_is_and_how_to_draw_one(cans, cli):
    rendered = cli("render-prompt", *cans[:-1]).stdout
    assert "def multiply(self, other" in rendered
    assert "`GraspSampler()`" in rendered
    assert "`g`: grasp; pose of the grasp point in the frame of the object" in rendered
