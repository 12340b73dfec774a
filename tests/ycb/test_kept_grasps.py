"""Grasps of a body that stands alone: measured once for all runs, and what the screen makes of them."""

import dataclasses
import json
import subprocess
import sys

import numpy as np
import pytest

from proc3s import Action, PlanBatch, Pose, Problem
from proc3s.domain.world import make_world
from proc3s.plugins.registry import open_registry
from proc3s.search.rollout import rollout
from proc3s_tabletop.catalogue.body_specs import bodies_of
from proc3s_tabletop.screens.grasp_cache import GraspCache, GraspVerdict
from proc3s_tabletop.screens.grasps import grasps
from proc3s_tabletop.screens.lone_grasps import LoneGrasps
from proc3s_tabletop.tasks.grasp_sampler import GraspSampler, pool

YCB = open_registry().domain("ycb")
SCENE = YCB.scene(YCB.spec.tasks["packing"], 0)
BODIES = bodies_of(YCB.spec.world.args["bodies"])
SIGNATURES = YCB.signatures(SCENE)
PICK = next(k for k, s in enumerate(SIGNATURES) if s.skill == "pick")

ADD = """
import sys
from pathlib import Path
from proc3s_tabletop.screens.grasp_cache import GraspCache, GraspVerdict
store = GraspCache(sys.argv[2], Path(sys.argv[1]))
for k in range(50):
    store.add({(k / 10, 0.0, 0.0, 0.0, 0.0, float(sys.argv[3])): GraspVerdict(k / 100, 0.5, k % 2 == 0)})
"""


@pytest.fixture
def fresh(tmp_path, monkeypatch):
    """A cache folder with the bodies, but nothing known of grasps."""
    (tmp_path / "meshes").mkdir()
    monkeypatch.setenv("PROC3S_CACHE", str(tmp_path))
    return tmp_path / "meshes"


def test_the_pool_has_one_grasp_in_every_cell():
    u = (np.stack(np.meshgrid(*[np.arange(8)] * 3, indexing="ij"), -1).reshape(-1, 3) + 0.5) / 8
    assert len(np.unique(GraspSampler().decode(u), axis=0)) == len(pool()) == 512
    share = (pool()[:, [0, 1, 5]] / [0.02, 0.02, np.pi] + 1) / 2
    assert (np.floor(share * 8) == np.floor(u * 8)).all()


def test_verdicts_are_kept_under_their_key(tmp_path):
    found = {
        (0.1, 0.0, 0.0, 0.0, 0.0, 0.5): GraspVerdict(0.001, 0.6),
        (0.2,) * 6: GraspVerdict(0.0, 1.0, True),
    }
    GraspCache("a", tmp_path).add(found)
    assert GraspCache("a", tmp_path).read() == found
    assert GraspCache("b", tmp_path).read() == {}


def test_a_damaged_file_is_begun_anew(tmp_path):
    (tmp_path / "grasps.sqlite").write_bytes(b"no database, but long enough to be read as one" * 100)
    store = GraspCache("a", tmp_path)
    assert store.read() == {}
    store.add({(0.0,) * 6: GraspVerdict(0.0, 1.0)})
    assert len(store.read()) == 1


def test_a_file_with_a_damaged_page_is_begun_anew(tmp_path):
    store = GraspCache("a", tmp_path)
    store.add({(k / 7, *(0.1,) * 5): GraspVerdict(0.0, 1.0) for k in range(500)})
    path = tmp_path / "grasps.sqlite"
    content = bytearray(path.read_bytes())
    content[5000:9000] = b"\xff" * 4000
    path.write_bytes(content)
    assert store.read() == {}


def test_processes_add_at_once(tmp_path):
    command = [sys.executable, "-c", ADD, tmp_path, "a"]
    running = [subprocess.Popen([*command, str(k)]) for k in range(3)]
    assert [process.wait(60) for process in running] == [0, 0, 0]
    assert len(GraspCache("a", tmp_path).read()) == 150


def test_what_was_measured_is_not_measured_again(fresh, monkeypatch):
    first = LoneGrasps(BODIES["strawberry"], 0.0, 0.0)
    fits, holds = first.fits(pool()[:20]), first.holds(pool()[:5])
    again = LoneGrasps(BODIES["strawberry"], 0.0, 0.0)
    monkeypatch.setattr("proc3s_tabletop.bullet.engine.HandScene", None)  # no simulator
    assert (again.fits(pool()[:20]) == fits).all()
    assert (again.holds(pool()[:5]) == holds).all()
    with pytest.raises(TypeError):
        again.fits(pool()[20:21])


def test_grasps_of_a_programs_own_are_measured_but_not_kept(fresh, monkeypatch):
    own = np.array([[0.0, 0.0, 0.005, 0.0, np.pi, 0.3], [0.0, 0.07, 0.005, 0.0, np.pi, 0.3]])
    measured = LoneGrasps(BODIES["strawberry"], 0.0, 0.0).fits(own)
    assert measured[0].tolist() == [0.0, pytest.approx(1.0, abs=0.2)]
    assert measured[1, 1] == 0.0
    again = LoneGrasps(BODIES["strawberry"], 0.0, 0.0)
    monkeypatch.setattr("proc3s_tabletop.bullet.engine.HandScene", None)  # no simulator
    with pytest.raises(TypeError):
        again.fits(own)


def batch_of(name, wanted):
    """One pick a plan."""
    choices = SIGNATURES[PICK].params[0].choices
    values = np.column_stack([np.full(len(wanted), choices.index(name)), wanted])
    count = np.arange(len(wanted) + 1)
    return PlanBatch(SIGNATURES, count, np.full(len(wanted), PICK, np.uint8), 7 * count, values.ravel())


@pytest.fixture(scope="module")
def world():
    made = make_world(YCB)
    yield made
    made.close()


def verdicts_of_world(world, name, wanted):
    scene, task = json.dumps(YCB.states.dump(SCENE)), YCB.spec.tasks["packing"]
    problem = Problem(YCB, task, scene, goal="", seed=0, samples=1)
    for grasp in wanted:
        yield rollout(world, problem, (Action("pick", (name, Pose(*grasp.tolist()))),)).violations


@pytest.mark.parametrize("name", SCENE.objects)
def test_the_screen_rejects_only_what_the_world_rejects_and_says_the_same(name, world):
    wanted = pool()[np.random.default_rng(1).permutation(512)[:40]]
    screened = grasps(SCENE, batch_of(name, wanted), YCB)
    assert any(screened)
    assert not all(screened)
    for said, found in zip(screened, verdicts_of_world(world, name, wanted), strict=True):
        if said is not None:
            assert found
            assert found[0].constraint == "grasp" == said.constraint
            assert said.text.split(" slips")[0] == found[0].text.split(" slips")[0]


@pytest.mark.slow
def test_what_the_screen_lets_pass_mostly_holds(world):
    wanted = pool()[::4]
    screened = grasps(SCENE, batch_of("object_0", wanted), YCB)
    passed = np.array([said is None for said in screened])
    held = [not found for found in verdicts_of_world(world, "object_0", wanted[passed])]
    assert np.mean(held) > 0.9


def test_a_verdict_does_not_depend_on_the_batch():
    wanted = pool()[:60]
    together = grasps(SCENE, batch_of("object_2", wanted), YCB)
    alone = [grasps(SCENE, batch_of("object_2", wanted[k : k + 1]), YCB)[0] for k in range(60)]
    assert together == alone


@pytest.mark.slow
def test_a_second_pick_of_an_object_is_left_to_the_world():
    bad = np.array([0.0, 0.07, 0.005, 0.0, np.pi, 0.0])
    one = batch_of("object_1", bad[None])
    assert (
        grasps(SCENE, one, YCB)[0].text == "the grasp fails: the fingers miss object_1 (the red strawberry)"
    )
    good = pool()[
        next(k for k, said in enumerate(grasps(SCENE, batch_of("object_1", pool()), YCB)) if not said)
    ]
    two = batch_of("object_1", np.array([good, bad]))
    two = dataclasses.replace(two, start=np.array([0, 2]))
    assert grasps(SCENE, two, YCB) == [None]


def test_a_pick_is_known_by_its_function_and_only_as_long_as_nothing_unknown_came_before():
    """Another skill may have tipped the object over."""
    pick = YCB.spec.skills["pick"]
    skills = {
        "hoist": pick.model_copy(update={"name": "hoist"}),
        "pick": pick.model_copy(update={"target": "proc3s_tabletop.actions.table:Table"}),
    }
    domain = dataclasses.replace(YCB, spec=YCB.spec.model_copy(update={"skills": skills}))
    bad = np.array([0.0, 0.07, 0.005, 0.0, np.pi, 0.0])
    batch = dataclasses.replace(
        batch_of("object_1", np.array([bad, bad])), signatures=domain.signatures(SCENE)
    )
    skill, start = np.array([0, 1], np.uint8), np.array([0, 2])
    hoist = grasps(SCENE, dataclasses.replace(batch, skill=skill, start=start), domain)[0]
    assert (hoist.constraint, hoist.step, hoist.skill) == ("grasp", 0, "hoist")
    later = dataclasses.replace(batch, skill=skill[::-1], start=start)
    assert grasps(SCENE, later, domain) == [None]
