"""Packages of third parties: one that is kept here, and those that `proc3s new` begins. Both in clean
environments, beside the wheel."""

import json
import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "tests" / "example_plugin"


def lines(*paths):
    return sum(len((EXAMPLE / path).read_text().splitlines()) for path in paths)


def test_what_an_author_has_to_write_is_small():
    assert lines("short_pushes.py") <= 12
    assert lines("proc3s_push/llm.py") <= 30
    assert lines("proc3s_push/solver.py") <= 40
    assert lines("proc3s_push/domain.yaml", "proc3s_push/domain.py") <= 90


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (["domain", "Bad-Name"], "is no name of a package"),
        (["domain", "class"], "is no name of a package"),
        (["domain", "drawing"], "there is a domain 'drawing' already"),
        (["solver", "cma"], "there is a solver 'cma' already"),
        (["llm", "stub"], "there is a llm 'stub' already"),
        (["domain", "mine", "--dir", "full"], "full is there already and not empty"),
    ],
)
def test_what_cannot_be_begun_is_said_and_nothing_is_written(args, words, cli, here):
    (here / "full").mkdir()
    (here / "full/mine.txt").write_text("mine")
    result = cli("new", *args)
    assert (result.code, words in result.stderr) == (2, True), result.stderr
    assert [path.name for path in here.rglob("*") if path.is_file()] == ["mine.txt"]


def test_a_begun_domain_is_a_sound_one(cli, here, monkeypatch):
    monkeypatch.setattr(sys, "path", list(sys.path))
    told = cli("new", "domain", "shelves").stdout
    assert "pip install -e 'shelves[dev]' && pytest shelves" in told
    assert cli("check", "shelves", "--json").json["errors"] == 0


@pytest.fixture(scope="module")
def clean(tmp_path_factory):
    """An environment with the wheel, pytest, the example, and one package of every kind."""
    folder = tmp_path_factory.mktemp("author")
    call(sys.executable, "-m", "build", "--wheel", "--outdir", folder, ROOT, cwd=folder)
    venv.create(folder / "venv", with_pip=True)
    pip = (folder / "venv/bin/pip", "install", "-q")
    call(*pip, next(folder.glob("*.whl")), "pytest>=8.2", cwd=folder)
    for kind in ("domain", "solver", "llm"):
        call(folder / "venv/bin/proc3s", "new", kind, f"my_{kind}", cwd=folder)
    packages = [f"./my_{kind}" for kind in ("domain", "solver", "llm")]
    call(*pip, EXAMPLE, *packages, cwd=folder)
    return folder


@pytest.mark.slow
@pytest.mark.xdist_group("wheel")
class TestInstalled:
    def test_their_tests_pass(self, clean):
        shutil.copytree(EXAMPLE, clean / "push")  # outside the repository, whose options are its own
        tests = [clean / "push/tests", *(clean / f"my_{kind}" for kind in ("domain", "solver", "llm"))]
        for folder in tests:
            call(clean / "venv/bin/python", "-m", "pytest", "-q", "-p", "no:cacheprovider", folder, cwd=clean)

    def test_they_load_and_are_sound(self, clean):
        call(clean / "venv/bin/proc3s", "plugins", "--strict", cwd=clean)
        for name in ("push", "my_domain"):
            call(clean / "venv/bin/proc3s", "check", name, cwd=clean)

    def test_they_work_together(self, clean):
        answers = clean / "answers"
        answers.mkdir()
        text = (EXAMPLE / "proc3s_push/answers/gather.proc3s.md").read_text().split("---", 2)[2]
        (answers / "push-gather.proc3s.md").write_text(text)
        options = (
            "--solver",
            "annealed",
            "--llm",
            f"shelf:{answers}",
            "--plugin",
            EXAMPLE / "short_pushes.py",
        )
        run = (clean / "venv/bin/proc3s", "run", "push/gather", *options, "--json")
        summary = json.loads(call(*run, cwd=clean))
        assert (summary["solved"], summary["goal_reached"], summary["solver"]) == (True, True, "annealed")
        shown = call(clean / "venv/bin/proc3s", "show", "push", *options[-2:], cwd=clean)
        assert "a push is longer than 0.8 m" in shown


def call(*command, cwd):
    environment = {name: v for name, v in os.environ.items() if name not in ("PYTHONPATH", "VIRTUAL_ENV")}
    done = subprocess.run(
        [str(part) for part in command], cwd=cwd, env=environment, capture_output=True, text=True, timeout=900
    )
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout
