"""What lies in the working directory hides no package, from the command or from any process it starts."""

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

HIDING = ("yaml", "json", "random", "pickle", "socket", "pluggy", "numpy/__init__", "proc3s/__init__")
SCRIPT = [str(Path(sysconfig.get_path("scripts")) / "proc3s")]
MODULE = [sys.executable, "-m", "proc3s"]
WALK = Path(__file__).parents[1] / "search"
ANSWER = """["```python
def gen_plan(initial, a):
    return [Action(\\"hop\\", [a])]

def gen_domain(initial):
    return {\\"a\\": ContinuousSampler(0, 5)}
```"]""".replace("\n", "\\n")


@pytest.fixture
def command(here):
    """Runs a command among files that end every process which imports them."""
    for name in HIDING:
        path = here / f"{name}.py"
        path.parent.mkdir(exist_ok=True)
        path.write_text("raise SystemExit('imported ' + __file__)")
    environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PYTHONSAFEPATH")}

    def run(words, *args):
        done = subprocess.run(
            [*words, *args], cwd=here, env=environment, capture_output=True, text=True, timeout=60
        )
        return done.returncode, done.stdout, done.stderr

    return run


@pytest.mark.slow
@pytest.mark.parametrize(
    "args",
    [
        ("run", "drawing/star"),
        ("run", "drawing/star", "--jobs", "2"),
        ("bench", "smoke", "--tasks", "drawing/star", "--methods", "proc3s"),
        ("doctor", "--llm", "replay"),
    ],
    ids=["run", "processes", "suite", "doctor"],
)
def test_nothing_is_imported_from_it(command, args):
    code, out, said = command(SCRIPT, *args)
    assert code == 0, said
    assert "imported" not in said + out
    if args[0] == "bench":
        assert "1/1 by hand" in out


def test_python_m_imports_nothing_from_it(command, here):
    shutil.rmtree(here / "proc3s")  # Python has imported the package before it is asked
    code, out, said = command(MODULE, "run", "drawing/star")
    assert (code, "imported" in said, "solved" in out) == (0, False, True), said


@pytest.mark.slow
@pytest.mark.parametrize("args", [(), ("--jobs", "2")], ids=["serial", "processes"])
def test_a_plugin_in_a_folder_of_its_own_name_works_in_a_suite(cli, here, args):
    (here / "walk").mkdir()
    for name in ("walk.py", "walk.yaml"):
        shutil.copy(WALK / name, here / "walk")
    (here / "mine.yaml").write_text("name: m\nsummary: m\ntasks: [walk/far]\nmethods: [proc3s]\nseeds: 1\n")
    (here / "answer.json").write_text(ANSWER)
    common = ("--llm", "stub:answer.json", "--plugin", "walk/walk.py", "--json", *args)
    (episode,) = cli("bench", "mine.yaml", *common).json["episodes"]
    assert (episode["solved"], episode["error"]) == (True, None)


def test_a_folder_does_not_take_the_name_of_a_loose_plugin(here, monkeypatch):
    """An interpreter that has the working directory on its path sees the folder as a package without code."""
    import importlib

    from proc3s import import_loose_file

    (here / "heath").mkdir()
    (here / "heath/heath.py").write_text("ANSWER = 42\n")
    monkeypatch.syspath_prepend(here)
    import_loose_file(here / "heath/heath.py")
    assert importlib.import_module("heath").ANSWER == 42
