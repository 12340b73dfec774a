"""Folders as plugins that are not installed: a project, its package, its `domain.yaml`, loose modules."""

import shutil
import sys

import pytest

import proc3s

PACKAGE = "proc3s_crates"


@pytest.fixture(autouse=True)
def clean(monkeypatch):
    """What a test imports from its folders is forgotten after it."""
    monkeypatch.setattr(sys, "path", list(sys.path))
    yield
    for name in [name for name in sys.modules if name.partition(".")[0] in (PACKAGE, "loose_crates")]:
        del sys.modules[name]


@pytest.fixture
def crates(cli, here):
    """A begun domain."""
    assert cli("new", "domain", "crates").code == 0
    return here / "crates"


@pytest.mark.parametrize(
    "plugin",
    [
        "crates",
        pytest.param(f"crates/{PACKAGE}", marks=pytest.mark.slow),
        pytest.param(f"crates/{PACKAGE}/domain.yaml", marks=pytest.mark.slow),
    ],
)
def test_a_begun_domain_runs_without_being_installed(plugin, crates, cli):
    ran = cli("run", "crates/gather", "--plugin", plugin, "--out", "run", "--json")
    assert ran.json["goal_reached"], ran.stderr
    assert cli("replay", "run", "--json").json["goal_reached"]
    assert "crates/gather" in cli("list", "tasks", "--plugin", plugin, "--json").json["tasks"]
    assert "move(puck, x, y)" in cli("render-prompt", "crates/gather", "--plugin", plugin).stdout
    assert "crates/gather" in proc3s.tasks(plugins=[plugin])


@pytest.mark.slow
@pytest.mark.parametrize("plugin", ["crates", f"crates/{PACKAGE}/domain.yaml"])
def test_workers_have_it_too(plugin, crates, shell):
    ran = shell("run", "crates/gather", "--plugin", plugin, "--jobs", "2", "--json", timeout=120)
    assert ran.json["goal_reached"], ran.stderr


@pytest.mark.slow
def test_a_run_that_was_broken_off_goes_on_with_it(crates, shell):
    asked = ("--llm", "manual:desk", "-L", "wait=0", "--out", "run")
    assert shell("run", "crates/gather", "--plugin", "crates", *asked).code == 4
    shutil.copy(crates / PACKAGE / "answers/gather.proc3s.md", "desk/crates.gather.proc3s.seed0.answer.md")
    assert shell("run", "--resume", "run", "--json").json["goal_reached"]


def test_a_project_may_have_its_package_in_src(crates, cli):
    (crates / "src").mkdir()
    (crates / PACKAGE).rename(crates / "src" / PACKAGE)
    assert cli("run", "crates/gather", "--plugin", "crates", "--json").json["goal_reached"]


def test_paths_to_one_domain_are_one_plugin(crates, cli):
    twice = (
        "--plugin",
        "crates",
        "--plugin",
        f"crates/{PACKAGE}/domain.yaml",
        "--plugin",
        f"crates/{PACKAGE}",
    )
    assert cli("list", "tasks", *twice).code == 0


def test_an_installed_plugin_may_be_named_besides(crates, cli, monkeypatch):
    monkeypatch.syspath_prepend(crates)
    info = crates / "proc3s_crates-0.1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: proc3s-crates\nVersion: 0.1\n")
    (info / "entry_points.txt").write_text(f"[proc3s]\ncrates = {PACKAGE}\n")
    named = cli("list", "tasks", "--plugin", "crates", "--json")
    assert (named.code, named.stderr, "crates/gather" in named.json["tasks"]) == (0, "", True)


@pytest.mark.parametrize("plugin", ["crates", f"crates/{PACKAGE}", f"crates/{PACKAGE}/domain.yaml"])
def test_a_package_of_that_name_from_elsewhere_is_said(plugin, crates, cli, here, monkeypatch):
    shutil.copytree(crates / PACKAGE, here / "elsewhere" / PACKAGE)
    monkeypatch.syspath_prepend(here / "elsewhere")
    told = cli("list", "tasks", "--plugin", plugin)
    assert told.code == 2
    assert f"Python finds {PACKAGE} in {here}/elsewhere/{PACKAGE}/__init__.py already" in told.stderr


def test_a_domain_of_loose_modules(crates, cli, here):
    folder = here / "loose"
    folder.mkdir()
    text = (crates / PACKAGE / "domain.yaml").read_text()
    text = text.replace(f"{PACKAGE}.world", "loose_crates").replace(f"{PACKAGE}.tasks", "loose_crates_tasks")
    (folder / "domain.yaml").write_text(text)
    shutil.copy(crates / PACKAGE / "world.py", folder / "loose_crates.py")
    shutil.copy(crates / PACKAGE / "tasks.py", folder / "loose_crates_tasks.py")
    program = crates / PACKAGE / "answers/gather.proc3s.md"
    solved = cli("solve", "crates/gather", "--sketch", program, "--plugin", "loose", "--json")
    assert solved.json["goal_reached"], solved.stderr
    assert "crates/gather" in cli("list", "tasks", "--plugin", "loose/domain.yaml", "--json").json["tasks"]


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (
            lambda folder: None,
            "is no plugin: it has neither a pyproject.toml with [project.entry-points.proc3s]",
        ),
        (lambda folder: (folder / "__init__.py").write_text(""), "has no hook"),
        (lambda folder: (folder / "pyproject.toml").write_text("[project"), "pyproject.toml: "),
        (
            lambda folder: (folder / "pyproject.toml").write_text(
                '[project.entry-points.proc3s]\na = "nothing_there"'
            ),
            "names the package nothing_there, which is neither here nor in src/",
        ),
        (
            lambda folder: (folder / "pyproject.toml").write_text('[project.entry-points.proc3s]\na = ""'),
            "pyproject.toml: the entry point a = '' names no module",
        ),
        (
            lambda folder: (
                (folder / "some.py").touch(),
                (folder / "pyproject.toml").write_text('[project.entry-points.proc3s]\na = "some:nope"'),
            ),
            "pyproject.toml: some:nope is not there: some has no 'nope'",
        ),
        (lambda folder: (folder / "inner").mkdir() or (folder / "inner/domain.yaml").touch(), "did you mean"),
    ],
)
def test_a_folder_that_is_no_plugin(make, words, cli, here):
    (here / "things").mkdir()
    make(here / "things")
    told = cli("list", "tasks", "--plugin", "things")
    assert (told.code, words in told.stderr) == (2, True), told.stderr
