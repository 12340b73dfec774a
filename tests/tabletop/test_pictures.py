"""Pictures show what happened, and change nothing."""

import json
import subprocess
import sys
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.colors import CSS4_COLORS, is_color_like, to_rgba
from PIL import Image
from test_world import PICK, PLACE, START

from proc3s import Pose
from proc3s_tabletop.bullet.pictures import Studio
from proc3s_tabletop.bullet.scene import Snapshot
from proc3s_tabletop.engine.looks import SIZE, UNKNOWN, color_of
from proc3s_tabletop.objects.body import Body
from proc3s_tabletop.objects.shapes import Bowl, Box, Cylinder
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.skills import pick, place
from proc3s_tabletop.world import ExecutionWorld, ReferenceWorld

PLAN = (PICK, PLACE)
UPRIGHT = (0.0, 0.0, 0.0, 1.0)


@pytest.fixture(params=[ReferenceWorld, ExecutionWorld])
def world(request):
    made = request.param(SimpleNamespace(skill={"pick": pick, "place": place}.__getitem__))
    yield made
    made.close()


@pytest.fixture
def studio():
    """Makes studios and closes them."""
    studios = []

    def make(bodies, colors):
        studios.append(Studio(bodies, colors))
        return studios[-1]

    yield make
    for made in studios:
        made.close()


def pixels(picture):
    return np.asarray(picture.convert("RGB"), float)


def spot(picture, color):
    """The middle of the pixels in about the hue of an RGB colour, and their number."""
    image, wanted = pixels(picture), np.array(color[:3])
    # Light and shadow change the length of a colour, hardly its direction.
    cosine = (image @ wanted) / (np.linalg.norm(image, axis=2) * np.linalg.norm(wanted) + 1e-9)
    rows, columns = np.nonzero(cosine > 0.985)
    return np.array([columns.mean(), rows.mean()]) if len(rows) else None, len(rows)


def test_there_is_a_picture_of_the_end_and_of_every_step(world, tmp_path):
    world.reset(START)
    for action in PLAN:
        world.step(action)
    world.render(PLAN, tmp_path / "plan.png")
    assert [path.name for path in tmp_path.iterdir()] == ["plan.png"]
    film = json.loads(json.dumps(world.film()))
    world.close()  # nothing is simulated for a film
    world.render_film(START, {tmp_path / f"{k}.png": frame for k, frame in enumerate(film)})
    steps = [Image.open(tmp_path / f"{k}.png") for k in range(3)]
    assert {step.size for step in steps} == {SIZE}
    assert (pixels(steps[2]) == pixels(Image.open(tmp_path / "plan.png"))).all()
    # The blue block goes from the right to the left of the picture, as the camera faces the robot.
    before, after = (spot(step, color_of("blue"))[0] for step in (steps[0], steps[2]))
    assert before[0] > after[0] + 80


@pytest.mark.slow
def test_a_picture_changes_no_later_step(world, tmp_path):
    world.reset(START)
    first = [world.step(action) for action in PLAN]
    world.reset(START)
    world.render((), tmp_path / "start.png")
    again = [world.step(PICK)]
    world.render((PICK,), tmp_path / "middle.png")
    assert [*again, world.step(PLACE)] == first


def test_a_film_begins_where_the_world_was_put_last():
    world = ReferenceWorld(SimpleNamespace(skill={"pick": pick, "place": place}.__getitem__))
    world.reset(START)
    world.step(PICK)
    carrying = world.snapshot
    world.reset(START)
    world.resume(carrying)
    world.step(PLACE)
    assert len(world.film()) == 2
    world.reset(START)
    assert len(world.film()) == 1
    world.close()


def test_bodies_are_seen_in_their_colours_where_they_are(studio):
    bodies = {"cube": Body(Box((0.06, 0.06, 0.06)), 0.1), "can": Body(Cylinder(0.03, 0.1), 0.1)}
    made = studio(bodies | {"bowl": Body(Bowl(), 0.3)}, {"cube": "red", "can": "green", "bowl": "purple"})
    places = {"cube": (-0.2, -0.6, 0.03), "can": (0.0, -0.65, 0.05), "bowl": (0.2, -0.6, 0.025)}
    picture = made.picture(Snapshot(tuple((name, Frame(at, UPRIGHT)) for name, at in places.items())))
    found = {name: spot(picture, color_of(name)) for name in ("red", "green", "purple")}
    assert all(count > 150 for _, count in found.values()), found
    columns = [found[name][0][0] for name in ("red", "green", "purple")]
    assert columns == sorted(columns)


def test_the_arm_is_where_its_joints_are(studio):
    made = studio({}, {})
    home, turned = Snapshot(()), Snapshot((), q=(-1.0, -1.2, 1.8, -2.2, -1.6, 0.0))
    pictures = [pixels(made.picture(snapshot)) for snapshot in (home, turned, home)]
    assert (pictures[0] == pictures[2]).all()
    assert (np.abs(pictures[0] - pictures[1]).max(axis=2) > 30).mean() > 0.05


def test_the_whole_table_is_in_view(studio):
    corners = {
        f"c{k}": (x, y) for k, (x, y) in enumerate([(-0.3, -0.8), (0.3, -0.8), (-0.3, -0.2), (0.3, -0.2)])
    }
    made = studio(dict.fromkeys(corners, Body(Box((0.05, 0.05, 0.05)), 0.1)), dict.fromkeys(corners, "red"))
    for name in corners:
        away = {other: Frame((0.0, 9.0, 9.0), UPRIGHT) for other in corners}
        frames = away | {name: Frame((*corners[name], 0.025), UPRIGHT)}
        (x, y), count = spot(made.picture(Snapshot(tuple(frames.items()))), color_of("red"))
        assert count > 100, name
        assert 5 < x < SIZE[0] - 5, name
        assert 5 < y < SIZE[1] - 5, name


def test_no_edge_of_the_table_is_out_of_view(studio):
    picture = pixels(studio({}, {}).picture(Snapshot(())))
    edges = np.concatenate([picture[-1], picture[:, 0], picture[:, -1]])
    assert (edges[:, 2] > edges[:, 0]).all()  # the sky is blue, and wood is not


def test_names_of_colours_are_what_they_say():
    red, green, blue, yellow = (np.array(color_of(name)[:3]) for name in ("red", "green", "blue", "yellow"))
    assert (red.argmax(), green.argmax(), blue.argmax(), yellow.argmin()) == (0, 1, 2, 2)
    assert color_of("mauve-ish") == color_of("") == UNKNOWN


@pytest.mark.parametrize("name", [*CSS4_COLORS, "tab:blue", "C1", "r", "0.5", "#abc", "#aabbcc80"])
def test_colours_are_those_of_matplotlib_softer_ones_first(name):
    softer = "gold" if name == "yellow" else f"tab:{name}" if is_color_like(f"tab:{name}") else name
    assert color_of(name) == pytest.approx(to_rgba(softer), abs=0.002)


def test_nothing_is_loaded_for_pictures_that_nobody_asks_for():
    code = (
        "import sys, proc3s_tabletop.actions.execution;"
        "assert not {'pybullet', 'airo_models', 'PIL', 'matplotlib'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


def test_objects_without_a_colour_are_drawn_too(tmp_path):
    world = ReferenceWorld(SimpleNamespace(skill=None))
    grey = replace(START, objects={"thing": SimpleNamespace(category="block", pose=Pose(0.0, -0.5, 0.02))})
    world.reset(grey)
    world.render((), tmp_path / "grey.png")
    assert (tmp_path / "grey.png").stat().st_size > 10_000
    world.close()


def test_a_studio_leaves_no_client_behind(tmp_path):
    import pybullet

    def connected():
        return sum(pybullet.isConnected(client) for client in range(64))

    before = connected()
    for _ in range(3):
        Studio({}, {}).close()
    assert connected() == before
