"""`proc3s doctor`, and what starts without an LLM."""

import sys

import pytest

NO_SOCKETS = """
import socket, sys

def refuse(*args, **kwargs):
    raise AssertionError("a socket was opened")

class Local(socket.socket):  # boxes are ordered through one that leads nowhere else
    def __init__(self, family=-1, *args, **kwargs):
        if family != socket.AF_UNIX:
            refuse()
        super().__init__(family, *args, **kwargs)

socket.socket = Local
socket.create_connection = socket.getaddrinfo = refuse
from proc3s.cli.app import app
try:
    app(sys.argv[1:], standalone_mode=False)
except SystemExit as done:
    assert not done.code, done.code
for name in ("litellm", "openai", "httpx", "pybullet", "tenacity"):
    assert name not in sys.modules, name
"""


def findings(result):
    return {f["subject"]: f for f in result.json}


def test_a_healthy_installation(cli):
    result = cli("doctor", "--json")
    found = findings(result)
    assert result.code == 0, result.stdout
    assert found["sandbox"]["level"] == "ok"
    assert found["litellm"]["level"] == "ok"
    assert found["llm"]["text"] == "replay (default)"


def test_for_people(cli):
    result = cli("doctor")
    assert "sandbox: programs run locked in" in result.stdout


def test_keys_are_named_and_never_shown(shell):
    result = shell("doctor", env={"OPENAI_API_KEY": "sk-secret-123456"})
    assert "OPENAI_API_KEY" in result.stdout
    assert "secret" not in result.stdout + result.stderr


def test_an_llm_that_does_not_exist(cli, here):
    (here / "proc3s.toml").write_text('llm = "nonsense"')
    result = cli("doctor", "--json")
    assert result.code == 2
    assert findings(result)["llm"]["level"] == "error"
    assert "proc3s.toml" in findings(result)["llm"]["text"]


def test_a_plugin_that_does_not_load(cli, here):
    (here / "proc3s_plugins.py").write_text("1 / 0")
    result = cli("doctor", "--json")
    assert result.code == 2
    assert any("ZeroDivisionError" in f["text"] for f in result.json)


def test_a_startup_file_of_unknown_origin(cli, tmp_path, monkeypatch):
    (tmp_path / "helpful.pth").write_text("import os; os.environ['X'] = '1'\n")
    (tmp_path / "paths.pth").write_text("/somewhere\n")
    monkeypatch.setattr("site.getusersitepackages", lambda: str(tmp_path))
    (found,) = [f for f in cli("doctor", "--json").json if f["subject"] == ".pth files"]
    assert (found["level"], "helpful.pth" in found["text"]) == ("note", True)


def test_a_package_that_is_known_to_be_bad(cli, monkeypatch):
    import importlib.metadata

    real = importlib.metadata.version
    monkeypatch.setattr(
        "proc3s.checks.installation.version", lambda name: "1.82.8" if name == "litellm" else real(name)
    )
    bad = [f for f in cli("doctor", "--json").json if f["subject"] == "litellm" and f["level"] == "error"]
    assert "1.82.8" in bad[0]["text"]
    assert "pip install" in bad[0]["advice"]


@pytest.mark.parametrize(
    "command",
    [
        ["--help"],
        ["list"],
        ["show", "litellm"],
        ["doctor"],
        ["plugins"],
        ["schema", "domain"],
        ["render-prompt", "drawing/star"],
        ["run", "drawing/star"],
    ],
    ids=" ".join,
)
def test_nothing_is_loaded_and_nobody_called_without_need(here, command):
    import subprocess

    done = subprocess.run(
        [sys.executable, "-c", NO_SOCKETS, *command], cwd=here, capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
