"""Where PyBullet cannot be imported, table-tops are simulated in MuJoCo, and that is said."""

import json
import subprocess
import sys

import pytest

from proc3s import UsageError
from proc3s_tabletop.engine import choice

WITHOUT = "import sys; sys.modules |= dict.fromkeys(('pybullet', 'airo_models'))\n"
MAIN = "from proc3s.cli import main; main()"
ANSWERS = {"unstack": 1}
"""Tasks whose bundled program is the second that is asked for."""
TASKS = ("line", "packing", "unstack", "pyramid-six", "tower", "grid", "reverse", "sort")


def run(here, task, *options):
    command = [
        sys.executable,
        "-c",
        WITHOUT + MAIN,
        "run",
        f"blocks/{task}",
        "--json",
        "--out",
        "run",
        *options,
    ]
    done = subprocess.run(command, capture_output=True, text=True, cwd=here, timeout=120)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout), done.stderr


@pytest.mark.slow
def test_a_pyramid_is_planned_carried_out_and_drawn_and_a_replay_keeps_to_the_engine(here, cli):
    summary, said = run(here, "pyramid")
    assert (summary["solved"], summary["goal_reached"], summary["rounds"]) == (True, True, 0)
    assert said.count("there is no pybullet here: table-tops are simulated in mujoco") == 1
    assert "proc3s: there is no pybullet" in said
    assert (here / "run" / "plan.png").stat().st_size > 10_000
    again = cli("replay", "run", "--json").json
    assert (again["world"], again["plan"]) == (summary["world"], summary["plan"])
    assert again["world"] == {"engine": "mujoco", "execution": "mujoco"}


@pytest.mark.slow
@pytest.mark.parametrize("task", TASKS)
def test_every_block_task_is_solved(here, task):
    summary, _ = run(here, task)
    rounds = ANSWERS.get(task, 0)
    assert (summary["solved"], summary["goal_reached"], summary["rounds"]) == (True, True, rounds)


def test_an_unknown_engine_is_refused_with_a_hint():
    with pytest.raises(UsageError, match="there is no physics engine 'mojoco'; did you mean 'mujoco'"):
        choice.engine("mojoco")


def test_an_engine_whose_package_is_missing_says_which_extra_brings_it(here):
    for name, package, brings in (("mujoco", "mujoco", "mujoco"), ("pybullet", "pybullet", "tabletop")):
        source = f"import sys; sys.modules[{package!r}] = None\n" + (
            "from proc3s import UsageError; from proc3s_tabletop.engine.choice import engine\n"
            f"try: engine({name!r})\nexcept UsageError as error: print(error)"
        )
        done = subprocess.run([sys.executable, "-c", source], capture_output=True, text=True, cwd=here)
        assert done.stdout == f"the table-top needs {package}: pip install 'proc3s[{brings}]'\n"


def test_help_and_lists_load_no_engine(here):
    source = (
        "from typer.testing import CliRunner; from proc3s.cli import app; import sys\n"
        "for args in (['run', '--help'], ['list']): assert CliRunner().invoke(app, args).exit_code == 0\n"
        "assert not {'mujoco', 'pybullet', 'proc3s_mujoco'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", source], check=True, cwd=here)
