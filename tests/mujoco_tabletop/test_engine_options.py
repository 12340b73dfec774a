"""`-W engine=…` and `-W execution=…` choose the engines of the table-top's worlds."""

import json

import pytest

import proc3s


def outcome(result):
    assert result.code == 0, result.stderr
    return {name: result.json[name] for name in ("solved", "goal_reached", "world", "plan")}


@pytest.mark.slow
def test_mujoco_accepts_and_carries_out_where_it_is_chosen_and_so_does_a_replay(cli, here):
    first = outcome(cli("run", "blocks/pyramid", "-W", "engine=mujoco", "--out", "first", "--json"))
    assert first["world"] == {"engine": "mujoco", "execution": "mujoco"}
    assert (first["solved"], first["goal_reached"]) == (True, True)
    begun = json.loads((here / "first" / "events.jsonl").read_text().partition("\n")[0])
    assert begun["world"] == first["world"]
    assert begun["options"]["world_options"] == begun["world"] == first["world"]
    assert outcome(cli("replay", "first", "--json")) == first


@pytest.mark.slow
def test_a_replay_may_carry_out_in_another_engine(cli):
    pytest.importorskip("pybullet")
    first = outcome(cli("run", "blocks/pyramid", "--out", "first", "--json"))
    again = outcome(cli("replay", "first", "-W", "execution=mujoco", "--json"))
    assert first["world"] == {"engine": "pybullet", "execution": "pybullet"}
    assert again["world"] == {"engine": "pybullet", "execution": "mujoco"}
    assert again["plan"] == first["plan"]


@pytest.mark.slow
def test_the_default_engine_by_its_name_gives_the_same_plans(cli):
    pytest.importorskip("pybullet")
    for task in ("blocks/pyramid", "blocks/line", "ycb/packing"):
        plain, named = (
            outcome(cli("run", task, *given, "--json")) for given in ((), ("-W", "engine=pybullet"))
        )
        assert plain == named


def test_an_engine_that_is_not_registered_is_refused(cli):
    result = cli("run", "blocks/pyramid", "-W", "engine=mojoco")
    assert result.code == 2
    assert "world of blocks: engine: must be mujoco or pybullet, not 'mojoco'" in result.stderr


def test_the_options_are_shown_with_the_domain(cli):
    shown = cli("show", "blocks").stdout
    assert "-W engine=…  physics engine, pybullet or mujoco" in shown
    assert "-W execution=…" in shown
    assert "-W" not in cli("show", "drawing").stdout


@pytest.mark.parametrize(
    "command",
    [
        ("run", "drawing/star"),
        ("solve", "drawing/star", "--sketch", "star.py"),
        ("check", "drawing"),
        ("show", "drawing/star", "--picture"),
        ("bench", "smoke"),
        ("bench", "ccsp", "--tasks", "drawing"),
    ],
)
def test_every_command_refuses_an_option_that_the_world_does_not_have(cli, here, command):
    (here / "star.py").write_text("def gen_plan(initial): ...\n")
    result = cli(*command, "-W", "engine=mujoco")
    assert result.code == 2
    assert "the world of drawing has no option 'engine'" in result.stderr


@pytest.mark.slow
def test_a_run_in_python_takes_options_of_the_world():
    result = proc3s.run("blocks/pyramid", world_options={"engine": "mujoco"})
    assert result.solved
    assert result.summary.world == {"engine": "mujoco", "execution": "mujoco"}
    assert len(result.states) == len(result.plan)


@pytest.mark.slow
def test_benchmarks_measure_the_chosen_engine(cli):
    given = ("--tasks", "blocks/pyramid", "--seeds", 1, "-W", "engine=mujoco", "--json")
    searched = cli("bench", "ccsp", "--samples", 2, "--solvers", "rejection", "--throughput", 0, *given)
    assert (searched.code, searched.json["options"]["world_options"]) == (0, ["engine=mujoco"])
    carried = cli("bench", "execution", "--robust", 1, "--improve", 0, "--times", 1, *given)
    assert (carried.code, carried.json["options"]["world_options"]) == (0, ["engine=mujoco"])
