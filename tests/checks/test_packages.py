"""Packages of third parties: one that is kept here, and those that `proc3s new` begins. Both in clean
environments, beside the wheel."""

import json
import shutil
import sys
from pathlib import Path

import pytest

from stranger import call, install, on_top_of

EXAMPLE = Path(__file__).parents[1] / "example_plugin"
PROC3S = ("venv/bin/python", "-P", "-m", "proc3s")


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


@pytest.mark.slow
def test_a_begun_domain_is_a_sound_one(cli, here, monkeypatch):
    monkeypatch.setattr(sys, "path", list(sys.path))
    told = cli("new", "domain", "shelves").stdout
    assert "pip install -e 'shelves[dev]' && pytest shelves" in told
    assert cli("check", "shelves", "--json").json["errors"] == 0


@pytest.fixture(scope="module")
def author(stranger, tmp_path_factory):
    """An environment with the wheel, pytest, the example, and one package of every kind."""
    folder = tmp_path_factory.mktemp("author")
    on_top_of(stranger, folder)
    for kind in ("domain", "solver", "llm"):
        call(stranger / "venv/bin/proc3s", "new", kind, f"my_{kind}", cwd=folder)
    packages = [f"./my_{kind}" for kind in ("domain", "solver", "llm")]
    install(folder, "pytest>=8.2", EXAMPLE, *packages)
    return folder


@pytest.mark.slow
@pytest.mark.xdist_group("wheel")
class TestInstalled:
    def test_their_tests_pass(self, author):
        shutil.copytree(EXAMPLE, author / "push")  # outside the repository, whose options are its own
        tests = [author / "push/tests", *(author / f"my_{kind}" for kind in ("domain", "solver", "llm"))]
        for folder in tests:
            call(
                author / "venv/bin/python", "-m", "pytest", "-q", "-p", "no:cacheprovider", folder, cwd=author
            )

    def test_they_load_and_are_sound(self, author):
        call(*PROC3S, "plugins", "--strict", cwd=author)
        for name in ("push", "my_domain"):
            call(*PROC3S, "check", name, cwd=author)

    def test_they_work_together(self, author):
        answers = author / "answers"
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
        run = (*PROC3S, "run", "push/gather", *options, "--json")
        summary = json.loads(call(*run, cwd=author))
        assert (summary["solved"], summary["goal_reached"], summary["solver"]) == (True, True, "annealed")
        shown = call(*PROC3S, "show", "push", *options[-2:], cwd=author)
        assert "a push is longer than 0.8 m" in shown
