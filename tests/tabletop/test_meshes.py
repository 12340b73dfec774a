"""Mesh bodies: prepared once, kept safely, true to their mesh, at rest where a scene puts them."""

import os
import subprocess
import sys

import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull

from proc3s import SpecError
from proc3s_tabletop.bullet.engine import BulletEngine
from proc3s_tabletop.catalogue.body_specs import bodies_of
from proc3s_tabletop.robot.frames import Frame
from proc3s_tabletop.robot.settings import ReferenceSettings

PREPARE = (
    "import sys; from proc3s_tabletop.meshes.prepare import *; print(prepare(Path(sys.argv[1]), 0.001).error)"
)


@pytest.fixture(autouse=True)
def cache(tmp_path_factory, monkeypatch):
    """The cache folder of these tests."""
    folder = tmp_path_factory.getbasetemp() / "proc3s-cache"
    monkeypatch.setenv("PROC3S_CACHE", str(folder))
    return folder / "meshes"


@pytest.fixture
def fresh(tmp_path, monkeypatch):
    """An empty cache folder."""
    monkeypatch.setenv("PROC3S_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache" / "meshes"


@pytest.fixture
def cup(tmp_path):
    """A mesh file in mm."""
    path = tmp_path / "cup.stl"
    trimesh.creation.cylinder(radius=30, height=80).export(path)
    return path


def ycb(model, **more):
    return bodies_of({"thing": {"shape": "ycb", "model": model, **more}})["thing"]


def mesh(path, **more):
    return bodies_of({"cup": {"shape": "mesh", "path": str(path), "mass": 0.2, **more}})["cup"]


def stays(body):
    start = Frame((0.0, 0.0, body.height), (0.0, 0.0, 0.0, 1.0))
    grips = BulletEngine().grips({"thing": body}, ReferenceSettings())
    try:
        found = grips.rest(((body, start),))
    finally:
        grips.close()
    assert found.at_rest
    assert found.frames[0].position == pytest.approx(start.position, abs=3e-4)
    assert abs(found.frames[0].rotation[3]) > np.cos(0.005 / 2)


def test_a_body_stays_where_a_scene_puts_it():
    stays(ycb("011_banana"))


@pytest.mark.slow
@pytest.mark.parametrize(
    "model", ["banana", "strawberry", "apple", "pear", "potted_meat_can", "power_drill", "mustard_bottle"]
)
def test_the_pieces_are_true_to_the_mesh(model):
    body = ycb(model)
    assert body.shape.error < 0.002
    stays(body)


@pytest.mark.slow
def test_the_inside_of_a_mug_is_empty():
    pieces = [ConvexHull(piece) for piece in ycb("025_mug").shape.pieces]
    points = np.vstack([hull.points for hull in pieces])
    middle = (points.min(0) + points.max(0)) / 2
    assert not any((hull.equations[:, :3] @ middle + hull.equations[:, 3] < 0).all() for hull in pieces)


def test_mass_and_friction_come_from_the_table_unless_they_are_given():
    assert ycb("banana").mass == pytest.approx(0.066)
    assert ycb("banana", mass=0.1).mass == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("given", "words"), [("bananna", "did you mean '011_banana'"), ("077_rubiks_cube", "give its mass")]
)
def test_a_model_that_cannot_be_had(given, words):
    with pytest.raises(SpecError, match=words):
        ycb(given)


def test_a_file_in_millimetres_turned(cup):
    upright, lying = mesh(cup, scale=0.001), mesh(cup, scale=0.001, turn=[np.pi / 2, 0, 0])
    assert (upright.height, upright.top) == pytest.approx((0.04, 0.04), abs=1.5e-3)
    assert lying.height == pytest.approx(0.03, abs=1.5e-3)


def test_a_damaged_file_of_the_cache_is_made_again(fresh, cup):
    first = mesh(cup, scale=0.001)
    (kept,) = fresh.glob("*.mesh")
    whole = kept.read_bytes()
    kept.write_bytes(whole[: len(whole) // 2])
    os.utime(cup, ns=(1, 1))  # this process remembers what it made of the file as it was
    assert mesh(cup, scale=0.001) == first
    assert len(kept.read_bytes()) == len(whole)


def test_two_processes_prepare_a_mesh_at_once(fresh, cup):
    command = [sys.executable, "-c", PREPARE, str(cup)]
    both = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(2)]
    told = [process.communicate(timeout=120)[0] for process in both]
    assert told[0] == told[1] != ""
    assert len(list(fresh.glob("*.mesh"))) == 1


def test_files_that_are_no_body(fresh, tmp_path, cup):
    (tmp_path / "broken.stl").write_text("solid nothing")
    (tmp_path / "words.obj").write_text("some words\n")
    corners = [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0.1], [0.1, 0.1, 0.1]]
    trimesh.Trimesh(corners, [[0, 1, 2], [1, 3, 2]]).export(tmp_path / "sheet.stl")
    bad = {"broken.stl": "broken", "words.obj": "words", "missing.stl": "no file", "sheet.stl": "is flat"}
    for name, words in bad.items():
        with pytest.raises(SpecError, match=words):
            mesh(tmp_path / name)
    with pytest.raises(SpecError, match="is its scale right"):
        mesh(cup)


BOX = trimesh.creation.box((0.05, 0.04, 0.03))


def without(count):
    """The box without some of its triangles."""
    holed = BOX.copy()
    holed.update_faces(np.arange(len(BOX.faces)) >= count)
    return holed


def with_faces(faces, more=()):
    return trimesh.Trimesh([*BOX.vertices.tolist(), *more], faces, process=False)


SOUP = BOX.triangles.reshape(-1, 3)
ODD = {
    "a side open.stl": without(2),
    "a triangle missing.obj": without(1),
    "open.glb": without(2),
    "inside out.ply": with_faces(BOX.faces[:, ::-1]),
    "some triangles inside out.obj": with_faces([*BOX.faces[:5, ::-1], *BOX.faces[5:]]),
    "every corner several times.ply": trimesh.Trimesh(SOUP, np.arange(36).reshape(-1, 3), process=False),
    "with a fin.obj": with_faces([*BOX.faces, [0, 1, 8]], [[0, 0, 0.02]]),
    "plain.off": BOX,
}


@pytest.mark.parametrize("name", ODD)
def test_a_mesh_with_a_fault_is_a_body_all_the_same(fresh, tmp_path, name):
    """Scans have holes; no package beyond those of the extra mends or reads them."""
    ODD[name].export(tmp_path / name)
    hull = mesh(tmp_path / name, scale=1.0).shape.corners()
    assert np.ptp(hull, axis=0) == pytest.approx([0.05, 0.04, 0.03], abs=0.006)
    assert np.abs(hull.min(axis=0) + hull.max(axis=0)).max() < 0.006


FILES = {
    "empty.stl": (b"", "holds no triangles"),
    "empty.ply": (b"", "cannot be read as a mesh"),
    "noise.stl": (b"\x00\xff" * 300, "holds no triangles"),
    "noise.glb": (b"glTF" + b"\0" * 50, "cannot be read as a mesh"),
    "points.ply": (
        b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        b"end_header\n0 0 0\n",
        "holds no triangles",
    ),
    "dangling.obj": (b"v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nf 1 2 9\n", "cannot be read as a mesh"),
    "nowhere.obj": (b"v nan 0 0\nv nan 0 0\nv 0 nan 0\nf 1 2 3\n", "nowhere.obj"),
    "line.obj": (b"v 0 0 0\nv .1 0 0\nv .1 0 0\nf 1 2 3\n", "is its scale right"),
    "one.obj": (b"v 0 0 0\nv .1 0 0\nv 0 .1 .1\nf 1 2 3\n", "is flat"),
    "part.step": (b"ISO-10303-21;", "another package"),
    "model.blend": (b"BLENDER", "cannot be read as a mesh"),
}


@pytest.mark.parametrize("name", FILES)
def test_what_is_wrong_with_a_file_is_one_sentence(fresh, tmp_path, name):
    content, words = FILES[name]
    (tmp_path / name).write_bytes(content)
    with pytest.raises(SpecError, match=words) as caught:
        mesh(tmp_path / name, scale=1.0)
    assert f"{name} " in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_size_is_told_without_an_exponent(fresh, tmp_path):
    BOX.copy().apply_scale(1e6).export(tmp_path / "vast.stl")
    with pytest.raises(SpecError, match=r"vast.stl is 50000 x 40000 x 30000 m: is its scale right\?"):
        mesh(tmp_path / "vast.stl", scale=1.0)


@pytest.mark.slow
def test_a_smaller_concavity_makes_finer_pieces():
    coarse, fine = (
        ycb("022_windex_bottle", mass=0.5).shape,
        ycb("022_windex_bottle", mass=0.5, concavity=0.01).shape,
    )
    assert len(fine.pieces) > len(coarse.pieces)
    assert fine.error < 0.002 < coarse.error
    assert fine.key != coarse.key
