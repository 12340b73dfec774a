import json

import pytest


def said(result):
    """What a person reads on stderr, without the name of the program."""
    return result.stderr.removeprefix("proc3s: ").strip()


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (["run", "nope/star"], ["domain 'nope'", "drawing"]),
        (["run", "drawing/stars"], ["task 'stars'", "did you mean 'star'?"]),
        (["run", "star"], ["domain/task", "drawing/star"]),
        (["run", "drawing/star", "--method", "prok3s"], ["method 'prok3s'", "did you mean 'proc3s'?"]),
        (["run", "drawing/star", "--solver", "gausian"], ["solver 'gausian'", "did you mean 'gaussian'?"]),
        (["run", "drawing/star", "--llm", "nobody"], ["LLM 'nobody'", "replay", "manual", "PROVIDER/MODEL"]),
        (["run", "drawing/star", "--llm", "replya"], ["LLM 'replya'", "did you mean 'replay'?"]),
        (["run", "drawing/star", "--preset", "papre"], ["preset 'papre'", "did you mean 'paper'?"]),
        (["run", "drawing/star", "--executor", "ray"], ["executor 'ray'", "serial"]),
        (
            ["run", "drawing/star", "--solver", "rejection", "-S", "frist=3"],
            ["rejection", "'frist'", "did you mean 'first'?"],
        ),
        (
            ["run", "drawing/star", "--solver", "rejection", "-S", "first=many"],
            ["rejection", "first", "integer", "many"],
        ),
        (["run", "drawing/star", "-L", "wait=1"], ["replay", "no option 'wait'"]),
        (
            ["run", "drawing/star", "--llm", "manual:d", "-L", "wiat=0"],
            ["manual", "'wiat'", "did you mean 'wait'?"],
        ),
        (["run", "drawing/star", "-M", "ronds=1"], ["proc3s", "'ronds'", "did you mean 'rounds'?"]),
        (["run", "drawing/star", "-M", "rounds=x"], ["proc3s", "rounds", "integer"]),
        (["run", "drawing/star", "-D", "cuont=5"], ["cuont"]),
        (["run", "drawing/star", "-D", "count=many"], ["count", "integer", "many"]),
        (["run", "drawing/star", "-D", "count"], ["key=value", "'count'"]),
        (
            ["run", "drawing/star", "-M", "template=proc3"],
            ["methods/proc3.j2", "did you mean 'methods/proc3s.j2'?"],
        ),
        (["run", "drawing/star", "--template-dir", "nowhere"], ["nowhere"]),
        (["run", "drawing/star", "--plugin", "nowhere.py"], ["nowhere.py"]),
        (["run", "drawing/free", "--goal", ""], ["--goal"]),
        (["solve", "drawing/star", "--sketch", "nowhere.py"], ["nowhere.py"]),
        (["replay", "nowhere"], ["nowhere", "no run folder"]),
        (["render-prompt", "drawing/star", "--method", "cpa"], ["method 'cpa'", "did you mean 'cap'?"]),
        (["render-prompt", "drawing/str"], ["task 'str'", "did you mean 'star'?"]),
        (["render-prompt", "drawing/star", "--round", "1"], ["--from"]),
        (["render-prompt", "drawing/star", "--diff", "nowhere"], ["nowhere"]),
        (["render-prompt", "drawing/star", "--from", "nowhere", "--round", "1"], ["nowhere"]),
        (["render-prompt", "drawing/star", "--update"], ["--check"]),
        (["render-prompt"], ["drawing/star"]),
        (["render-prompt", "nope", "--check", "d"], ["nope"]),
        (["list", "metods"], ["metods", "did you mean 'methods'?"]),
        (["show", "drawin"], ["drawin", "did you mean 'drawing'?"]),
        (["show", "drawing/stra"], ["stra", "did you mean 'drawing/star'?"]),
        (["schema", "domian"], ["domian", "did you mean 'domain'?"]),
    ],
)
def test_one_line_that_says_what_exists(cli, here, args, words):
    result = cli(*args)
    assert result.code == 2
    assert len(said(result).splitlines()) == 1, said(result)
    for word in words:
        assert word in said(result)
    assert "Traceback" not in result.stderr


def test_a_task_without_an_instruction_says_first_that_it_needs_one(cli):
    result = cli("run", "drawing/free")
    assert result.code == 2
    first = said(result).splitlines()[0]
    assert first == "drawing/free has no instruction of its own; give one with --goal,"


@pytest.mark.parametrize(
    "args", [["run"], ["run", "drawing/star", "--sead", "3"], ["run", "drawing/star", "--seed", "-1"]]
)
def test_mistakes_that_the_command_line_itself_finds(cli, args):
    result = cli(*args)
    assert result.code == 2
    assert result.stderr


@pytest.mark.parametrize(
    "args",
    [
        ["run", "nope/star"],
        ["run", "drawing/star", "--method", "x"],
        ["run", "drawing/star", "-M", "template=x"],
        ["run", "drawing/star", "-S", "first=0"],
        ["run", "drawing/star", "--llm", "nobody"],
        ["run", "drawing/star", "--samples", "5", "-D", "count"],
        ["solve", "drawing/star", "--sketch", "nowhere.py"],
        ["replay", "nowhere"],
    ],
)
def test_with_json_a_mistake_is_a_whole_document(cli, args):
    from test_run_command import KEYS

    result = cli(*args, "--json")
    assert result.code == 2
    assert list(result.json) == KEYS
    assert result.json["error"]
    assert result.json["solved"] is False


def test_a_mistake_leaves_no_folder(cli, here):
    for args in (
        ["--method", "x"],
        ["--llm", "nobody"],
        ["--solver", "x"],
        ["-S", "a=1"],
        ["-M", "template=x"],
    ):
        cli("run", "drawing/star", *args)
    assert not (here / "runs").exists()


DOMAIN = """\
spec_version: 1
name: broken
sumary: Five mistakes.
world: {target: "nowhere_at_all.world:World"}
state: Scene
types:
  Scene: {summary: A scene., fields: {size: {type: flaot}}}
skills: {}
samplers: []
constraints: {far: {says: too far, target: "json:loads", tolerance: -1}}
tasks: {}
name: again
budget: {paper: 10}
"""


def test_a_domain_file_with_five_mistakes_is_lines_with_numbers(cli, here):
    (here / "domain.yaml").write_text(DOMAIN)
    (here / "mine.py").write_text(
        "from pathlib import Path\nfrom proc3s import hookimpl, load_domain\n\n"
        "@hookimpl\ndef register_domains(register):\n"
        "    register(load_domain(Path(__file__).parent / 'domain.yaml'))\n"
    )
    result = cli("run", "broken/task", "--plugin", "mine.py")
    assert result.code == 2
    numbers = [int(line.split("domain.yaml:")[1].split(":")[0]) for line in said(result).splitlines()]
    assert numbers == sorted(numbers)
    assert {3, 4, 7, 10, 12} <= set(numbers)
    assert "did you mean 'summary'?" in said(result)
    assert "did you mean 'float'?" in said(result)
    assert "no module 'nowhere_at_all.world'" in said(result)


def test_an_unwritable_folder_is_said_before_the_llm_is_asked(cli, here):
    (here / "file").write_text("")
    for out in ("file", "file/run"):
        result = cli("run", "drawing/star", "--llm", "manual:asked", "--out", out)
        assert result.code == 2
        assert "cannot be written" in said(result)
    assert not (here / "asked").exists()


def test_the_default_folder_may_be_unwritable_too(cli, here):
    (here / "runs").write_text("in the way")
    result = cli("run", "drawing/star", "--llm", "manual:asked")
    assert result.code == 2
    assert "cannot be written" in said(result)


def test_a_folder_with_something_in_it(cli, here):
    (here / "mine").mkdir()
    (here / "mine/precious").write_text("x")
    result = cli("run", "drawing/star", "--out", "mine")
    assert result.code == 2
    assert "not empty" in said(result)


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (["--method", "cap", "--seed", "1"], ["drawing/star", "--llm", "record"]),
        (["--llm", "replay:nowhere"], ["nowhere", "--llm"]),
        (["--llm", "replay:empty"], ["empty", "--llm", "record"]),
        (["--llm", "stub:nowhere.json"], ["nowhere.json"]),
        (["--llm", "stub:bad.json"], ["bad.json"]),
        (["--llm", "stub:dict.json"], ["dict.json", "list"]),
        (["--llm", "manual"], ["manual:DIR"]),
        (["--llm", "manual:file"], ["file"]),
    ],
)
def test_no_answer_is_exit_code_3(cli, here, args, words):
    (here / "empty").mkdir()
    (here / "file").write_text("")
    (here / "bad.json").write_text("[")
    (here / "dict.json").write_text("{}")
    result = cli("run", "drawing/star", *args)
    assert result.code == 3, result.stderr
    for word in words:
        assert word in said(result)


def test_an_answer_without_its_origin_is_refused(cli, here):
    (here / "mine").mkdir()
    (here / "mine/star.proc3s.md").write_text("```python\n```\n")
    result = cli("run", "drawing/star", "--llm", "replay:mine")
    assert result.code == 3
    assert "star.proc3s.md" in said(result)
    assert "origin" in said(result)
    assert len([line for line in said(result).splitlines() if "proc3s:" in line]) == 1


def test_a_key_given_as_an_option_is_refused_and_not_repeated(cli, here):
    result = cli("run", "drawing/star", "--llm", "openai/gpt", "-L", "api_key=sk-planted", "--json")
    assert result.code == 2
    assert "sk-planted" not in result.stdout + result.stderr
    assert "api_key" in result.json["error"]


def test_a_broken_plugin_in_the_folder_does_not_stop_a_run(cli, here):
    (here / "proc3s_plugins.py").write_text("1 / 0\n")
    assert cli("run", "drawing/star").code == 0


def test_an_error_in_a_template_names_file_and_line(cli, here):
    (here / "mine/partials").mkdir(parents=True)
    (here / "mine/partials/task.j2").write_text("one\n{{ gaol }}\n")
    result = cli("run", "drawing/star", "--template-dir", "mine", "--json")
    assert result.code == 2
    assert "task.j2:2: " in result.json["error"]
    assert "gaol" in result.json["error"]


WORLD = """
from proc3s import SkillSpec, ConstraintSpec, hookimpl

def broken(world, *args):
    raise RuntimeError("the motor is broken")

@hookimpl
def register_skills(register):
    register(SkillSpec(name="hop", summary="Hops.", params={}, target="mine:broken", domains=("drawing",)))
"""


def test_a_skill_of_a_plugin_that_breaks_is_named(cli, here, stub):
    (here / "mine.py").write_text(WORLD)
    llm = stub("```python\ngen_plan = [Action('hop', [])]\n```")
    result = cli("run", "drawing/star", "--method", "llm3", "--plugin", "mine.py", "--llm", llm, "--json")
    assert result.code == 2
    assert "hop" in result.json["error"]
    assert "the motor is broken" in result.json["error"]
    assert json.loads((here / result.json["run_dir"] / "summary.json").read_text())["error"]


@pytest.mark.parametrize(
    "log", ['{"event": "run_started"}\n', "[" * 100_000 + "\n", "\0\n", '{"event": 1}\n']
)
@pytest.mark.parametrize("args", [["replay", "run"], ["run", "drawing/star", "--resume", "run"]])
def test_a_log_that_is_none_is_a_message(cli, here, args, log):
    (here / "run").mkdir()
    (here / "run/events.jsonl").write_text(log)
    result = cli(*args)
    assert result.code == 2
    assert "run" in said(result)
