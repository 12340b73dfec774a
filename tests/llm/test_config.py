"""Who says which LLM is asked: the command line, the environment, the project's file, the user's."""

import pytest


@pytest.fixture
def user_file(tmp_path, monkeypatch):
    """Writes the user's configuration."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))

    def write(text):
        path = tmp_path / "config/proc3s/proc3s.toml"
        path.parent.mkdir(parents=True)
        path.write_text(text)

    return write


@pytest.fixture
def stubs(here, texts):
    """Scripted answers under three names."""
    import json

    for name in ("line", "variable", "project", "user"):
        (here / f"{name}.json").write_text(json.dumps([texts.star]))


def llm(result):
    return result.json["llm"]


@pytest.mark.slow
def test_the_order(cli, here, monkeypatch, user_file, stubs):
    assert llm(cli("run", "drawing/star", "--json")) == "replay"
    user_file('llm = "stub:user.json"')
    assert llm(cli("run", "drawing/star", "--json")) == "stub:user.json"
    (here / "proc3s.toml").write_text('llm = "stub:project.json"')
    assert llm(cli("run", "drawing/star", "--json")) == "stub:project.json"
    monkeypatch.setenv("PROC3S_LLM", "stub:variable.json")
    assert llm(cli("run", "drawing/star", "--json")) == "stub:variable.json"
    assert llm(cli("run", "drawing/star", "--llm", "stub:line.json", "--json")) == "stub:line.json"


def test_whoever_chose_is_named(cli, here, stubs):
    (here / "proc3s.toml").write_text('llm = "stub:project.json"')
    assert "asking stub:project.json, as proc3s.toml says" in cli("run", "drawing/star").stderr


def test_options_hold_for_the_llm_of_the_file(cli, here):
    text = 'llm = "manual:desk"\n[llm_options]\nwait = 0\ntemperature = 0.5\n'
    (here / "proc3s.toml").write_text(text)
    assert cli("run", "drawing/star").code == 4
    assert cli("run", "drawing/star", "--llm", "manual:desk").code == 4
    assert cli("run", "drawing/star", "--llm", "replay").code == 0
    assert cli("run", "drawing/star", "-L", "wait=0.1").code == 4


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("llm = ", "proc3s.toml: "),
        ('lm = "replay"', "did you mean 'llm'"),
        ("llm = 3", "llm"),
        ('llm = "replay"\n[llm_options]\napi_key = "sk-12345678"', "environment variable"),
        ('llm = "replay"\n[llm_options]\ntemprature = 1', "did you mean 'temperature'"),
        ('llm = "replay"\n[llm_options]\ntemperature = "hot"', "temperature"),
    ],
)
def test_a_file_that_is_wrong(cli, here, text, word):
    (here / "proc3s.toml").write_text(text)
    result = cli("run", "drawing/star", "--out", "r")
    assert result.code == 2
    assert word in result.stderr
    assert "sk-1234" not in result.stderr + result.stdout
    assert not (here / "r").exists()


def test_the_run_remembers_what_it_was_asked(cli, here, events, stubs):
    (here / "proc3s.toml").write_text('llm = "stub:project.json"')
    cli("run", "drawing/star", "--out", "r")
    assert events(here / "r", "run_started")[0]["options"]["llm"] == "stub:project.json"


def test_a_file_does_not_matter_where_nobody_is_asked(cli, here):
    (here / "proc3s.toml").write_text("nonsense")
    assert cli("list").code == 0
    assert cli("render-prompt", "drawing/star").code == 0


def test_options_in_the_variable_are_written_as_on_the_command_line(cli, here, monkeypatch, events):
    monkeypatch.setenv("PROC3S_LLM", "manual:my desk -L wait=0  -L temperature=0.5")
    assert cli("run", "drawing/star", "--out", "r").code == 4
    options = events(here / "r", "run_started")[0]["options"]
    assert options["llm"] == "manual:my desk"
    assert options["llm_options"] == {"wait": "0", "temperature": "0.5"}
    assert cli("run", "drawing/star", "-L", "temperature=0.7", "--out", "s").code == 4
    changed = events(here / "s", "run_started")[0]["options"]["llm_options"]
    assert changed == {"wait": "0", "temperature": "0.7"}


def test_options_in_the_variable_are_for_its_llm_alone(cli, here, monkeypatch):
    monkeypatch.setenv("PROC3S_LLM", "manual:desk -L wait=0")
    assert cli("run", "drawing/star", "--llm", "replay").code == 0


@pytest.mark.parametrize(
    ("value", "word"),
    [
        ("replay -L", "PROC3S_LLM"),
        ("replay -L temperature", "PROC3S_LLM"),
        ("replay -L temprature=1", "did you mean 'temperature'"),
        ("openai/x -L api_key=sk-12345678", "environment variable"),
    ],
)
def test_a_variable_that_is_wrong(cli, here, monkeypatch, value, word):
    monkeypatch.setenv("PROC3S_LLM", value)
    result = cli("run", "drawing/star", "--out", "r")
    assert (result.code, word in result.stderr) == (2, True)
    assert "sk-1234" not in result.stderr
    assert not (here / "r").exists()


def test_an_empty_variable_chooses_nothing(cli, monkeypatch):
    monkeypatch.setenv("PROC3S_LLM", "  ")
    assert llm(cli("run", "drawing/star", "--json")) == "replay"
