"""The pictures of an unsolved run, and that of a scene."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import proc3s
from proc3s import World
from proc3s.reporting.caption import write_below
from proc3s_drawing.world import Canvas

# two lines: one that is fine, one through the middle of object_0
THROUGH = """
def gen_plan(initial, x):
    o = initial.obstacles[0]
    return [Action("draw_line", [1, 1, 2, 1]), Action("draw_line", [o.x_pos, o.y_pos, o.x_pos + x, o.y_pos])]

def gen_domain(initial):
    return {"x": ContinuousSampler(0, 1)}
"""
MISS = "step 1 (draw_line): line touches object_0"
PICTURES = ("nearest_miss.png", "scene.png")


@pytest.fixture
def unsolved(cli, here):
    """Gives a run that comes to nothing, and what was said of it."""
    (here / "through.py").write_text(THROUGH)

    def run(*more):
        args = ("solve", "drawing/star", "--sketch", "through.py", "--samples", 5, "--out", "run")
        return cli(*args, *more)

    return run


def red(picture):
    """How many pixels are of pure red."""
    r, g, b = np.asarray(picture.convert("RGB"), int).transpose(2, 0, 1)
    return int(((r > 200) & (g < 60) & (b < 60)).sum())


def test_an_unsolved_run_shows_its_scene_and_its_nearest_miss(unsolved, here, cli):
    done = unsolved()
    assert done.code == 1
    assert f"nearest  {MISS}\npicture  run/nearest_miss.png\n" in done.stdout
    scene, miss = (Image.open(here / "run" / name) for name in ("scene.png", "nearest_miss.png"))
    assert red(miss) > red(scene) + 200  # the rim of the obstacle, the line and the sentence
    assert miss.height > scene.height
    assert "Pictures in run: nearest_miss.png, scene.png." in cli("explain", "run").stdout
    cli("report", "run")
    page = (here / "run" / "report.html").read_text()
    assert "The nearest miss" in page
    assert page.count("data:image/png") == 2


def test_the_result_shows_it(here):
    result = proc3s.solve("drawing/star", THROUGH, samples=5, out="run")
    assert result.picture().size == Image.open("run/nearest_miss.png").size
    assert "<img" in result._repr_html_()


def test_a_solved_run_has_none(cli, here):
    cli("run", "drawing/star", "--out", "run")
    assert not [name for name in PICTURES if (here / "run" / name).exists()]


def test_a_plan_that_is_carried_out_all_the_same_is_a_miss(cli, here, stub):
    plan = '[Action("draw_line", [1, 1, 2, 1]), Action("draw_line", [-1, 1, 3, 1])]'
    text = f"```python\ndef gen_plan(initial):\n    return {plan}\n```"
    done = cli("run", "drawing/star", "--method", "cap", "--llm", stub(*[text] * 9), "--out", "run")
    assert done.code == 1
    assert "nearest  step 1 (draw_line): the x coordinate leaves the canvas" in done.stdout
    assert (here / "run" / "nearest_miss.png").is_file()


def test_they_may_be_left_out_and_a_replay_has_them(unsolved, cli, here):
    assert "nearest" not in unsolved("--no-miss-picture").stdout
    assert not [name for name in PICTURES if (here / "run" / name).exists()]
    assert cli("replay", "run", "--out", "again").code == 1
    assert all((here / "again" / name).is_file() for name in PICTURES)


@pytest.fixture
def walk(here):
    """A domain whose world draws nothing, as a plugin."""
    for name in ("walk.py", "walk.yaml"):
        shutil.copy(Path(__file__).parents[1] / "search" / name, here)
    return ("--plugin", "walk.py")


def test_a_world_that_draws_nothing_is_not_asked_to(walk, cli, here):
    (here / "pit.py").write_text('def gen_plan(initial):\n    return [Action("hop", [8.0])]\n')
    done = cli("solve", "walk/far", "--sketch", "pit.py", "--samples", 1, "--out", "run", *walk)
    assert done.code == 1, done.stderr
    assert not list((here / "run").glob("*.png"))
    shown = cli("show", "walk/far", "--picture", *walk)
    assert (shown.code, shown.stderr) == (
        2,
        "proc3s: the world of walk draws no pictures: it has no `render`\n",
    )


def test_a_picture_that_cannot_be_drawn_changes_no_outcome(unsolved, cli, monkeypatch):
    def broken(*args):
        raise ValueError("no pen")

    monkeypatch.setattr(Canvas, "render", broken)
    monkeypatch.setattr(Canvas, "render_marked", broken)
    solved = cli("run", "drawing/star", "--json")
    assert (solved.code, solved.json["solved"], solved.json["error"]) == (0, True, None)
    done = unsolved()
    assert done.code == 1
    assert done.stdout.startswith("unsolved ")
    assert "the picture run/nearest_miss.png is missing" in done.stderr
    assert "raised ValueError: no pen" in done.stderr
    assert "broken off" not in cli("explain", "run").stdout


def test_a_world_that_knows_no_marks_draws_as_it_always_did(here):
    class Older(World):
        def render(self, plan, path):
            path.write_text(str(plan))

    domain = proc3s.get_domain("drawing")
    Older(domain).render_marked((), here / "x.png", ["object_0"])
    assert (here / "x.png").read_text() == "()"


def test_only_what_is_marked_is_red(here):
    domain = proc3s.get_domain("drawing")
    world = Canvas(domain)
    world.reset(domain.scene(domain.spec.tasks["star"], 1))
    for name, marked in {"none": (), "one": ("object_1",), "two": ("object_1", "object_2")}.items():
        world.render_marked((), here / f"{name}.png", marked)
    none, one, two = (red(Image.open(here / f"{name}.png")) for name in ("none", "one", "two"))
    assert none < one < two


@pytest.mark.parametrize("text", ["größer als 星", "x" * 900, "a\x1b[31m b\n c", ""])
def test_any_sentence_fits_below_a_picture(here, text):
    Image.new("RGB", (300, 40), "white").save("p.png")
    write_below(here / "p.png", text)
    with Image.open("p.png") as image:
        assert image.width == 300
        assert 40 < image.height < 600
        edge = np.asarray(image)[:, -2:]
    assert (edge == 255).all()


def test_the_scene_of_a_task_is_drawn_before_there_is_a_plan(cli, here):
    assert cli("show", "drawing/star", "--picture").stdout == "drawing-star-seed0.png\n"
    assert cli("show", "drawing/star", "--picture", "--seed", 3, "-D", "count=9", "--out", "x.png").code == 0
    one, other = (Image.open(here / name).convert("RGB") for name in ("drawing-star-seed0.png", "x.png"))
    assert one.size == other.size
    assert (np.asarray(one) != np.asarray(other)).any()


@pytest.mark.parametrize(
    ("args", "says"),
    [
        (("drawing", "--picture"), "--picture draws the scene of a task"),
        (("drawing/star", "--seed", "1"), "--seed, -D, -W and --out go with --picture"),
        (("drawing/nothing", "--picture"), "nothing"),
        (("drawing/star", "--picture", "--out", "no/such/folder/x.png"), "No such file"),
        (("drawing/star", "--picture", "-D", "size=3"), "size"),
    ],
)
def test_what_cannot_be_drawn_is_a_sentence(cli, args, says):
    done = cli("show", *args)
    assert done.code == 2
    assert says in done.stderr
    assert "Traceback" not in done.stderr
