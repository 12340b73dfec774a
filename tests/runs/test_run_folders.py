import json
import platform
import subprocess
import sys

import pytest

from proc3s import Message, UsageError, answer
from proc3s.plugins.versions import versions
from proc3s.runs.events import AnswerReceived, ProgramExtracted, PromptRendered, RunEnded, RunStarted
from proc3s.runs.folder import RunFolder, new_folder
from proc3s.runs.reading import events_of, read_events, started

START = RunStarted(options={"task": "toy/shift"}, versions={}, samples=5, scene="{}")


def received(text, round_=0):
    return AnswerReceived(round=round_, completion=answer(text, model="m"))


@pytest.fixture
def folder(tmp_path):
    opened = RunFolder(tmp_path / "run")
    yield opened
    opened.close()


def test_events_come_back_as_they_went_in(folder):
    folder.emit(START)
    folder.emit(received("hello"))
    folder.emit(RunEnded(summary={"solved": True}))
    assert [e["event"] for e in read_events(folder.path)] == ["run_started", "answer_received", "run_ended"]
    assert started(folder.path)["options"] == {"task": "toy/shift"}
    assert events_of(folder.path, "answer_received")[0]["completion"]["candidates"][0]["text"] == "hello"
    assert all(e["time"].endswith("+00:00") for e in read_events(folder.path))


def test_every_event_is_on_the_disk_at_once(folder):
    folder.emit(START)
    assert (folder.path / "events.jsonl").read_text().endswith("}\n")


def test_the_files_that_a_person_opens_first(folder):
    messages = (
        Message(role="system", kind="system", text="Be a robot.\n"),
        Message(role="user", kind="task", text="Go."),
    )
    folder.emit(PromptRendered(round=1, sha256="0", messages=messages))
    folder.emit(received("an answer", 1))
    folder.emit(ProgramExtracted(round=1, source="x = 1\n"))
    folder.emit(RunEnded(summary={"solved": False}))
    assert (
        folder.path / "prompt-1.md"
    ).read_text() == "<!-- system: system -->\n\nBe a robot.\n\n<!-- user: task -->\n\nGo.\n"
    assert (folder.path / "answer-1.md").read_text() == "an answer"
    assert (folder.path / "program-1.py").read_text() == "x = 1\n"
    assert json.loads((folder.path / "summary.json").read_text()) == {"solved": False}
    assert not list(folder.path.glob(".*"))


@pytest.mark.parametrize(
    "text",
    [
        "größer ✓ 星",
        "a\u2028b\u2029c",
        "a\x85b",
        "a\x0bb\x0cc\x1cd\x1ee",
        "lone \ud800 surrogate",
        "a\r\nb\rc",
        "\0\x7f",
    ],
)
def test_any_text_of_an_answer_survives_the_log(folder, text):
    folder.emit(START)
    folder.emit(received(text))
    folder.emit(RunEnded(summary={}))
    assert events_of(folder.path, "answer_received")[0]["completion"]["candidates"][0]["text"] == text
    assert len(read_events(folder.path)) == 3


def test_a_last_line_that_was_cut_off_is_left_out(folder):
    folder.emit(START)
    folder.emit(received("größer ✓"))
    log = folder.path / "events.jsonl"
    whole = log.read_bytes()
    first = whole.index(b"\n") + 1
    for cut in range(first, len(whole) - 1):
        log.write_bytes(whole[:cut])
        assert [e["event"] for e in read_events(folder.path)] == ["run_started"], whole[first:cut]


def test_a_bad_line_in_the_middle_is_named(folder):
    folder.emit(START)
    folder.emit(START)
    log = folder.path / "events.jsonl"
    lines = log.read_text().splitlines(keepends=True)
    log.write_text(lines[0] + '{"event": oops\n' + lines[1])
    with pytest.raises(UsageError, match=r"events\.jsonl:2: not valid JSON"):
        read_events(folder.path)


@pytest.mark.parametrize("content", [None, b"", b'{"event": "run_st'])
def test_a_folder_without_a_beginning_is_no_run(tmp_path, content):
    if content is not None:
        (tmp_path / "events.jsonl").write_bytes(content)
    with pytest.raises(UsageError, match=r"no run folder|cut off before it began"):
        started(tmp_path)


@pytest.mark.parametrize("content", [b"5\n", b'{"time": "now"}\n', b"[]\n", b'"text"\n'])
def test_a_log_of_something_else_is_no_run(tmp_path, content):
    (tmp_path / "events.jsonl").write_bytes(content)
    with pytest.raises(UsageError):
        started(tmp_path)


def test_a_folder_with_something_in_it_is_refused(tmp_path):
    (tmp_path / "mine.txt").write_text("precious")
    with pytest.raises(UsageError, match=r"is not empty.*--out"):
        RunFolder(tmp_path)
    assert [p.name for p in tmp_path.iterdir()] == ["mine.txt"]


def test_a_folder_that_cannot_be_made(tmp_path):
    (tmp_path / "file").write_text("")
    for path in (tmp_path / "file", tmp_path / "file/run", tmp_path / ("long" * 100)):
        with pytest.raises(UsageError, match="cannot be written"):
            RunFolder(path)


def test_parents_are_made(tmp_path):
    RunFolder(tmp_path / "a/b/c").close()
    assert (tmp_path / "a/b/c/events.jsonl").is_file()


def test_new_folders_do_not_collide(tmp_path):
    one = new_folder(tmp_path, "drawing/star", "proc3s", 3)
    two = new_folder(tmp_path, "drawing/star", "proc3s", 3)
    assert one.name.endswith("-drawing-star-proc3s-seed3")
    assert one != two
    assert one.parent == two.parent == tmp_path


def test_versions_name_python_and_proc3s():
    assert {"python", "platform", "proc3s", "numpy"} <= set(versions())


def test_no_process_that_would_inherit_keys_is_started_to_name_the_platform():
    code = """
import subprocess
def refuse(*args, **options): raise AssertionError(f"a process is started: {args}")
subprocess.Popen.__init__ = refuse
from proc3s.plugins.versions import versions
print(versions()["platform"])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert platform.machine() in done.stdout
