"""A disk that is full, a folder that is gone: what a run found is shown, and what is missing said."""

import json
import os
import subprocess
import sys

import pytest

from proc3s.runs.reading import read_events
from proc3s.runs.recordings import read_recordings

RUN = ("run", "drawing/star", "--out", "run")
PLUGIN = """
import os, shutil
from proc3s import hookimpl

@hookimpl
def on_event(event):
    if event.event == "{event}":
        {action}
"""


@pytest.fixture
def limited(here):
    """Runs a command whose files may have so many KiB, as on a disk that is full then."""

    def run(kib, *args):
        main = "from proc3s.cli import main; main()"
        script = f'ulimit -f {kib}; exec "$@"'
        return subprocess.run(
            ["bash", "-c", script, "bash", sys.executable, "-c", main, *map(str, args)],
            capture_output=True,
            text=True,
            timeout=60,
            env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},
            check=False,
        )

    return run


def meddling(here, event, action):
    """A plugin that does something to the run folder after an event."""
    path = here / "meddling.py"
    path.write_text(PLUGIN.format(event=event, action=action))
    return "--plugin", path


@pytest.mark.parametrize("kib", [4, 6, 8])
def test_a_run_that_cannot_be_kept_asks_nothing(limited, kib, here):
    done = limited(kib, *RUN, "--json")
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert "the run folder run cannot be written any more: File too large" in done.stderr
    assert json.loads(done.stdout)["plan"] is None
    assert "answer_received" not in [event["event"] for event in read_events(here / "run")]


@pytest.mark.slow
@pytest.mark.parametrize("kib", [11, 12, 13, 14, 20])
@pytest.mark.parametrize("as_json", [True, False], ids=["json", "plain"])
def test_an_accepted_plan_is_shown_though_the_disk_is_full(limited, kib, as_json, here):
    done = limited(kib, *RUN, *(["--json"] if as_json else []))
    assert done.returncode == 2, done.stdout + done.stderr
    assert "Traceback" not in done.stderr
    assert "File too large" in done.stderr
    if as_json:
        summary = json.loads(done.stdout)
        assert (summary["solved"], len(summary["plan"]), summary["stopped"]) == (True, 5, "usage")
        assert "File too large" in summary["error"]
    else:
        assert done.stdout.startswith("solved ")
        assert done.stdout.count("draw_line(") == 5
    assert read_events(here / "run")[0]["event"] == "run_started"  # whole lines alone


@pytest.mark.parametrize("event", ["prompt_rendered", "sketch_loaded", "plan_executed"])
def test_a_run_folder_that_is_removed_meanwhile(cli, here, event):
    plugin = meddling(here, event, 'shutil.rmtree("run")')
    done = cli(*RUN, *plugin)
    assert done.code == 2
    assert done.stdout.startswith("solved ")
    assert "the run folder run cannot be written any more: No such file or directory" in done.stderr


def test_a_picture_that_cannot_be_written_is_missed_and_nothing_else(cli, here):
    plugin = meddling(here, "sketch_loaded", 'os.mkdir("run/plan.png")')
    done = cli(*RUN, *plugin, "--json")
    assert done.code == 2
    assert done.json["solved"]
    assert "the picture run/plan.png is missing: Is a directory" in done.json["error"]
    assert json.loads((here / "run/summary.json").read_text()) == done.json
    assert json.loads((here / "run/plan.json").read_text()) == done.json["plan"]


def test_what_is_not_kept_is_not_asked_for_again_and_again(cli, here, stub, answers):
    plugin = meddling(here, "answer_received", 'shutil.rmtree("run")')
    llm = stub(answers.outside, answers.star)
    done = cli(*RUN, *plugin, "--samples", 50, "--llm", llm)
    assert done.code == 2
    assert "round 1" not in done.stderr
    assert "cannot be written any more" in done.stderr


def test_a_run_goes_on_when_there_is_room_again(limited, cli, here):
    assert limited(4, *RUN).returncode == 2
    done = cli("run", "--resume", "run", "--json")
    assert (done.code, done.json["solved"]) == (0, True)


def test_an_answer_that_cannot_be_recorded_is_used_and_that_is_said(limited, here):
    done = limited(8, *RUN, "--record", "kept.jsonl")
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert read_recordings(here / "kept.jsonl") == []


@pytest.mark.slow
@pytest.mark.parametrize("command", [("report", "run"), ("bench", "smoke", "--out", "suite")])
def test_other_commands_say_what_could_not_be_written(limited, cli, command):
    assert cli(*RUN).code == 0
    done = limited(1, *command)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert "proc3s: " in done.stderr
