"""The command line as a user sees it, and scripted answers."""

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from dataclasses import dataclass

import pytest
from typer.testing import CliRunner

from provider import running
from stranger import with_the_wheel

os.environ.pop("PYTEST_ADDOPTS", None)  # meant for this run, not for a pytest that a test starts
collect_ignore = ["example_plugin"]  # a package of its own, tested where it is installed


@dataclass(frozen=True)
class Result:
    """What a command left behind."""

    code: int
    stdout: str
    stderr: str

    @property
    def json(self):
        """The one document on stdout."""
        return json.loads(self.stdout)


@pytest.fixture
def provider():
    """A server on this machine that speaks the protocols of OpenAI and Anthropic, and does as it is told."""
    with running() as server:
        yield server


@pytest.fixture(scope="session")
def stranger(tmp_path_factory):
    """A folder whose `venv` has the wheel and what it depends on, and nothing else."""
    folder = tmp_path_factory.mktemp("stranger")
    with_the_wheel(folder)
    return folder


@pytest.fixture
def here(tmp_path, monkeypatch):
    """An empty working directory."""
    folder = tmp_path / "work"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder


@pytest.fixture
def cli(here):
    """Runs a command in this process, in an empty folder; an exception that escapes is an error."""
    from proc3s.cli import app

    def run(*args):
        result = CliRunner().invoke(app, [str(arg) for arg in args])
        if result.exception is not None and not isinstance(result.exception, SystemExit):
            raise result.exception
        return Result(result.exit_code, result.stdout, result.stderr)

    return run


def _command(args):
    return [sys.executable, "-c", "from proc3s.cli import main; main()", *map(str, args)]


@pytest.fixture
def shell(here):
    """Runs a command in a process of its own."""

    def run(*args, env=None, cwd=here, timeout=60):
        done = subprocess.run(
            _command(args),
            cwd=cwd,
            env={**os.environ, **(env or {})},
            capture_output=True,
            text=True,
            timeout=timeout,
        )
        return Result(done.returncode, done.stdout, done.stderr)

    return run


@pytest.fixture
def background(here):
    """Starts a command, hands its process over, and ends it whatever happens."""

    @contextmanager
    def start(*args):
        process = subprocess.Popen(
            _command(args),
            cwd=here,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            # A shell's background job, and so maybe this one, is started deaf to Ctrl-C.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )
        try:
            yield process
        finally:
            if process.poll() is None:
                process.send_signal(signal.SIGKILL)
            process.communicate()

    return start


@pytest.fixture
def eventually():
    """Waits for a condition; fails when it does not come true."""

    def wait(condition, seconds=20.0):
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, "waited in vain"
            time.sleep(0.02)

    return wait


@pytest.fixture
def stub(here):
    """`--llm` of scripted answers, one a round."""

    def write(*answers):
        path = here / "answers.json"
        path.write_text(json.dumps(answers), encoding="utf-8")
        return f"stub:{path}"

    return write


@pytest.fixture
def events():
    """The log of a run folder, by type, each line strictly valid JSON."""

    def read(run, kind=None):
        def refuse(text):
            raise ValueError(f"{text} is no JSON")

        lines = (run / "events.jsonl").read_bytes().decode().split("\n")
        assert lines[-1] == ""
        found = [json.loads(line, parse_constant=refuse) for line in lines[:-1]]
        return [event for event in found if kind in (None, event["event"])]

    return read
