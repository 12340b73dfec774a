"""What a command prints, into pipes that are closed, full, gone, or in another encoding than UTF-8."""

import json
import os
import subprocess
import sys

import pytest

COMMAND = f"'{sys.executable}' -c 'from proc3s.cli import main; main()' "
LOUD = """
import atexit, ctypes, os, subprocess
from proc3s import *

def shout():
    print("printed")
    os.write(1, b"written\\n")
    ctypes.CDLL(None).puts(b"put by C")
    subprocess.run(["echo", "echoed"])

shout()
atexit.register(shout)

@hookimpl
def register_skills(register):
    shout()
    register(SkillSpec(name="hop", summary="Hops — 漢 😀.", params={},
                       target="loud:hop", domains=("drawing",)))

@hookimpl
def register_constraints(register):
    register(ConstraintSpec(name="calm", says="not calm", target="loud:calm", domains=("drawing",)))

@hookimpl
def on_event(event):
    shout()

def hop(world): pass

def calm(transition):
    print("calm")
    return 1.0
"""
STAR = ("run", "drawing/star", "--llm", "replay")


@pytest.fixture
def piped(here):
    """Runs a command with the redirections of a shell."""

    def run(arguments, **env):
        return subprocess.run(
            ["bash", "-c", "set -o pipefail; " + COMMAND + arguments],
            cwd=here,
            env={**os.environ, **env},
            capture_output=True,
            timeout=60,
        )

    return run


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        ("run drawing/star --llm replay 2>&-", 0),
        ("run drawing/star --llm replay >&-", 0),
        ("run drawing/star --llm replay --json <&- >&- 2>&-", 0),
        ("run drawing/nope 2>&-", 2),
        ("list <&- >&- 2>&-", 0),
        ("--help >&-", 0),
        ("render-prompt drawing/star 2>/dev/full", 0),
        ("list >/dev/full", 2),
        ("list --json >/dev/full", 2),
        ("list | true", 141),
        ("render-prompt drawing --check . | true", 141),
        ("run drawing/star --llm replay 2> >(true)", 0),
    ],
)
def test_closed_full_and_gone(piped, here, arguments, code):
    done = piped(arguments)
    assert done.returncode == code
    assert b"Traceback" not in done.stderr
    assert b"None:" not in done.stderr
    if code == 141:
        assert b"proc3s:" not in done.stderr
    if "/dev/full" in arguments and code:
        assert b"stdout cannot be written: No space left on device" in done.stderr


@pytest.mark.slow
def test_files_of_a_run_do_not_take_the_number_of_a_closed_stream(piped, here):
    piped("run drawing/star --llm replay --out run >&- 2>&-")
    lines = (here / "run/events.jsonl").read_text().splitlines()
    assert all(json.loads(line)["event"] for line in lines)


@pytest.mark.slow
@pytest.mark.parametrize("encoding", ["ascii", "cp1252"])
@pytest.mark.parametrize(
    "arguments", ["list", "show hop", "render-prompt drawing/star", "--help", "nonsense"]
)
def test_another_encoding_gets_what_it_has(piped, here, encoding, arguments):
    (here / "loud.py").write_text(LOUD)
    given = "" if arguments in ("--help", "nonsense") else " --plugin loud.py"
    done = piped(arguments + given, PYTHONIOENCODING=encoding, NO_COLOR="1")
    text = (done.stdout + done.stderr).decode(encoding)
    assert done.returncode == (2 if arguments == "nonsense" else 0)
    assert "Traceback" not in text
    if given:
        assert r"\u6f22 \ud83d\ude00" in text


@pytest.mark.slow
@pytest.mark.parametrize("encoding", ["utf-8", "ascii"])
@pytest.mark.parametrize(
    "arguments",
    [
        "run drawing/star --llm replay --no-screens --json",
        "run drawing/star --llm replay --no-screens --jobs 2 --json",
        "run drawing/nope --json",
        "list --json",
        "show hop --json",
        "plugins --json",
        "render-prompt drawing/star --format json",
    ],
)
def test_json_is_alone_on_stdout_whoever_else_prints(piped, here, encoding, arguments):
    (here / "loud.py").write_text(LOUD)
    done = piped(f"{arguments} --plugin loud.py", PYTHONIOENCODING=encoding)
    json.loads(done.stdout.decode(encoding))
    for word in (b"printed", b"written", b"put by C", b"echoed"):
        assert word in done.stderr


def test_a_prompt_is_alone_on_stdout_too(cli, here):
    plain = cli("render-prompt", "drawing/star").stdout
    (here / "proc3s_plugins.py").write_text("print('hello')\n")
    result = cli("render-prompt", "drawing/star")
    assert result.stdout == plain
    assert "hello" in result.stderr


@pytest.mark.slow
def test_a_folder_whose_name_is_not_utf_8(shell, here):
    folder = os.fsdecode(b"run\xff")
    done = shell(*STAR, "--out", folder, "--json")
    assert done.code == 0
    assert done.json["run_dir"] == folder
    assert shell("explain", folder).code == 0
