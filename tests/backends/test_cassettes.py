"""Cassettes: what is recorded, in which form, and that nothing but the entry in flight is ever lost."""

import json
import re
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from proc3s import LLM, Candidate, Completion, LLMError, Message, Price, Request, Sampling, Usage, UsageError
from proc3s import answer as plain_answer
from proc3s.llm.cassette import Cassette
from proc3s.llm.recorder import Recorder
from proc3s.runs.recordings import read_recordings

HEADER = '{"format": "proc3s cassette", "version": 1}\n'
TEXTS = st.text(st.characters(exclude_categories=()))


class Model(LLM):
    """Gives its answers in order, the last one for ever."""

    price = Price(prompt=1, completion=2)

    def __init__(self, *answers, before=lambda: None):
        self._answers = list(answers)
        self._before = before

    def complete(self, request):
        self._before()
        found = self._answers[0] if len(self._answers) == 1 else self._answers.pop(0)
        if isinstance(found, Exception):
            raise found
        return found if isinstance(found, Completion) else plain_answer(found, "gpt-x")


def request(text="Draw a star.", **changes):
    messages = (
        Message(role="system", kind="system", text="You plan.\nIn Python.\n"),
        Message(role="user", kind="task", text=text),
    )
    usual = {"task": "drawing/star", "method": "proc3s", "template": "proc3s", "seed": 0}
    return Request(messages=messages, **(usual | changes))


def record(path, *answers, requests=None):
    recorder = Recorder(Model(*answers), path)
    return [recorder.complete(each) for each in requests or [request()]]


def values(path):
    return [entry.value for entry in Cassette(path).entries()]


def test_a_cassette_is_read_like_the_texts_in_it(tmp_path):
    record(tmp_path / "c.jsonl", "```python\nx = 1\n```\n")
    lines = (tmp_path / "c.jsonl").read_bytes().decode().split("\n")
    assert lines[0] + "\n" == HEADER
    assert lines[2:5] == ['"You plan."', '"In Python."', '""']
    assert lines[6] == '"Draw a star."'
    assert lines[8:12] == ['"```python"', '"x = 1"', '"```"', '""']
    assert lines[12].startswith('{"entry": {"task": "drawing/star", "method": "proc3s", "seed": 0, ')
    assert lines[13:] == [""]


def test_a_text_stands_in_a_cassette_once(tmp_path):
    record(tmp_path / "c.jsonl", "one", "two", requests=[request(), request("Draw a fish.")])
    record(tmp_path / "c.jsonl", "one")
    text = (tmp_path / "c.jsonl").read_text()
    assert [text.count(f'"{t}"\n') for t in ("You plan.", "Draw a star.", "Draw a fish.", "one", "two")] == [
        1
    ] * 5
    assert [r.completion.text for r in read_recordings(tmp_path / "c.jsonl")] == ["one", "two", "one"]


@settings(deadline=None, max_examples=300)
@given(st.lists(TEXTS, min_size=1, max_size=4))
def test_every_text_comes_back_as_it_was(tmp_path_factory, texts):
    path = tmp_path_factory.mktemp("texts") / "c.jsonl"
    for text in texts:
        Cassette(path).append({"text": text, "and": [{"text": text[::-1]}]})
    assert values(path) == [{"text": text, "and": [{"text": text[::-1]}]} for text in texts]
    lines = path.read_bytes().decode("utf-8").splitlines()
    assert len(lines) == path.read_bytes().count(b"\n")
    assert all(json.loads(line) is not None for line in lines)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "\n",
        "no end",
        "end\n",
        "\r\n\r",
        "a\u2028b\x85c\x0bd",
        "\ud800",
        "\ud83d\ude00",
        "\U0001f600",
        "\\ud800",
    ],
)
def test_texts_that_are_easily_damaged(tmp_path, text):
    whole = Completion(candidates=(Candidate(text=text),), model="m")
    record(tmp_path / "c.jsonl", whole, requests=[request(text)])
    (found,) = read_recordings(tmp_path / "c.jsonl")
    assert (found.messages[1].text, found.completion.text) == (text, text)


def test_everything_about_an_answer_is_kept(tmp_path):
    given_ = Completion(
        candidates=(Candidate(text="one"), Candidate(text="two", finish_reason=None)),
        model="gpt-x-2026",
        model_asked="openai/gpt-x",
        usage=Usage(prompt_tokens=7, completion_tokens=0),
        cost=0.1 + 0.2,
        latency=3.25,
        attempts=2,
        dropped=("seed",),
        notes=("seed not supported",),
    )
    asked = request(round=2, candidate=3, sampling=Sampling(temperature=0.7, n=2, reasoning_effort="low"))
    assert record(tmp_path / "c.jsonl", given_, requests=[asked]) == [given_]
    (found,) = read_recordings(tmp_path / "c.jsonl")
    assert found.completion == given_
    assert found.messages == asked.messages
    assert (found.sampling, found.round, found.candidate) == (asked.sampling, 2, 3)
    assert re.fullmatch(r"20\d\d-\d\d-\d\dT\d\d:\d\d:\d\d\+00:00", found.time)
    assert found.where == f"{tmp_path / 'c.jsonl'}:12"


@pytest.mark.parametrize("source", ["live", "recorded", "authored", "manual"])
def test_where_an_answer_is_from_is_kept(tmp_path, source):
    record(tmp_path / "c.jsonl", plain_answer("x", "m", source))
    assert read_recordings(tmp_path / "c.jsonl")[0].completion.source == source


def test_a_recorder_is_the_model_that_it_wraps(tmp_path):
    class Free(Model):
        live = False

    recorders = [Recorder(model("x"), tmp_path / "c.jsonl") for model in (Model, Free)]
    assert [r.live for r in recorders] == [True, False]


def test_a_failed_call_is_not_recorded(tmp_path):
    recorder = Recorder(Model(LLMError("busy", "rate_limit"), "x"), tmp_path / "c.jsonl")
    with pytest.raises(LLMError, match="busy"):
        recorder.complete(request())
    assert read_recordings(tmp_path / "c.jsonl") == []
    recorder.complete(request())
    assert len(read_recordings(tmp_path / "c.jsonl")) == 1


@pytest.mark.parametrize("name", ["there", "not/there"])
def test_a_folder_gets_one_cassette_a_task(tmp_path, name):
    (tmp_path / "there").mkdir()
    tasks = ["drawing/star", "drawing/arrow", "drawing/star"]
    record(tmp_path / name, "x", requests=[request(task=task) for task in tasks])
    assert {file.name for file in (tmp_path / name).iterdir()} == {
        "drawing-arrow.jsonl",
        "drawing-star.jsonl",
    }
    assert [r.task for r in read_recordings(tmp_path / name / "drawing-star.jsonl")] == ["drawing/star"] * 2
    assert len(read_recordings(tmp_path / name)) == 3


@pytest.mark.parametrize("name", ["file/c.jsonl", "file/folder", "file", "c.json"])
def test_a_path_that_cannot_be_recorded_to_is_said_at_once(tmp_path, name):
    (tmp_path / "file").write_text("")
    with pytest.raises(UsageError, match=name):
        Recorder(Model("x"), tmp_path / name)


@pytest.mark.parametrize("content", ["notes of mine\n", "notes of mine", "[]\n", '{"proc3s": 1}\n', "\xff\n"])
def test_another_file_is_refused_and_left_alone(tmp_path, content):
    path = tmp_path / "c.jsonl"
    path.write_text(content, encoding="latin-1")
    with pytest.raises(LLMError, match=r"c\.jsonl:1: not a cassette"):
        Recorder(Model("x"), path)
    with pytest.raises(LLMError, match="not a cassette"):
        Cassette(path).append({"text": "x"})
    assert path.read_text(encoding="latin-1") == content


def test_a_version_that_is_not_known_is_refused(tmp_path):
    (tmp_path / "c.jsonl").write_text('{"format": "proc3s cassette", "version": 2, "more": []}\n{"new": 1}\n')
    with pytest.raises(LLMError, match=r"c\.jsonl:1: .*version 2.*version 1"):
        read_recordings(tmp_path / "c.jsonl")


@pytest.mark.parametrize(
    ("line", "was", "becomes", "named"),
    [
        (7, "star", "stxr", 6),
        (3, '"You plan."', '"You plan.', 3),
        (3, '"You plan."', "7", 3),
        (3, '"You plan."', "", 3),
        (6, '{"text"', '{"tixt"', 6),
        (10, '"kind": "task", "text": "', '"kind": "task", "text": "0', 10),
        (10, '"seed": 0', '"seed": "x"', 10),
        (10, '"seed": 0', '"seed": 0, "sead": 1', 10),
        (10, '"role": "user"', '"role": "system"', 10),
        (10, '"messages"', '"massages"', 10),
    ],
)
def test_a_damaged_line_is_named(tmp_path, line, was, becomes, named):
    path = tmp_path / "c.jsonl"
    record(path, "x")
    lines = path.read_text().split("\n")
    assert was in lines[line - 1]
    lines[line - 1] = lines[line - 1].replace(was, becomes)
    path.write_text("\n".join(lines))
    with pytest.raises(LLMError, match=rf"c\.jsonl:{named}: "):
        read_recordings(path)


def test_a_file_cut_anywhere_loses_the_entry_in_flight_and_no_other(tmp_path):
    path, whole = tmp_path / "c.jsonl", tmp_path / "whole.jsonl"
    entries = [{"n": 0, "text": "é\nb\n"}, {"n": 1, "text": "é\nb\n"}, {"n": 2, "text": "\ud800"}]
    ends = [len(HEADER)]
    for entry in entries:
        Cassette(whole).append(entry)
        ends.append(whole.stat().st_size)
    data = whole.read_bytes()
    for size in range(len(data) + 1):
        path.write_bytes(data[:size])
        # An entry that lacks nothing but the end of its line is whole.
        kept = entries[: sum(end - 1 <= size for end in ends[1:])]
        assert values(path) == kept
        Cassette(path).append({"n": 3, "text": "é\nb\n"})
        assert values(path) == [*kept, {"n": 3, "text": "é\nb\n"}]
        assert path.read_bytes().startswith(data[: ends[len(kept)]])
        assert path.read_bytes().count(b'"\xc3\xa9"\n') == 1


@pytest.mark.parametrize("cut", [len(HEADER), 10, 0, -1, -20, None])
def test_a_file_that_changes_between_two_appends_is_read_anew(tmp_path, cut):
    path = tmp_path / "c.jsonl"
    cassette = Cassette(path)
    for n in range(3):
        cassette.append({"n": n, "text": "x\ny"})
    path.write_bytes(path.read_bytes()[:cut])
    kept = values(path)
    cassette.append({"n": 3, "text": "x\ny"})
    Cassette(path).append({"n": 4, "text": "of another"})
    cassette.append({"n": 5, "text": "of another"})
    assert [value["n"] for value in values(path)] == [*range(len(kept)), 3, 4, 5]
    assert path.read_text().count('"x"\n') == path.read_text().count('"of another"\n') == 1


def test_what_is_left_of_a_cut_entry_is_not_referred_to(tmp_path):
    path = tmp_path / "c.jsonl"
    cassette = Cassette(path)
    cassette.append({"text": "one"})
    begun = path.stat().st_size
    cassette.append({"text": "two", "and": {"text": "three"}})
    path.write_bytes(path.read_bytes()[:-9])
    cassette.append({"text": "three"})
    assert values(path) == [{"text": "one"}, {"text": "three"}]
    assert b"two" not in path.read_bytes()[begun:]


APPENDING = """
import sys
from pathlib import Path
from proc3s.llm.cassette import Cassette
cassette = Cassette(Path(sys.argv[1]))
for n in range(int(sys.argv[3])):
    cassette.append({"who": sys.argv[2], "n": n, "text": f"shared\\n{n // 5}\\n" * 50})
    print(n, flush=True)
"""


def appending(path, who, times):
    command = [sys.executable, "-c", APPENDING, str(path), who, str(times)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True)


def test_four_processes_append_at_once(tmp_path):
    path = tmp_path / "c.jsonl"
    processes = [appending(path, who, 25) for who in "abcd"]
    assert [process.communicate(timeout=60) and process.returncode for process in processes] == [0] * 4
    found = values(path)
    for who in "abcd":
        assert [value["n"] for value in found if value["who"] == who] == list(range(25))
    assert all(value["text"] == f"shared\n{value['n'] // 5}\n" * 50 for value in found)
    assert path.read_bytes().count(b'{"text"') == 5


def test_threads_append_at_once(tmp_path):
    recorder = Recorder(Model("x"), tmp_path / "c.jsonl")
    calls = [
        threading.Thread(target=lambda n=n: recorder.complete(request(f"Draw {n}.", candidate=n)))
        for n in range(16)
    ]
    for call in calls:
        call.start()
    for call in calls:
        call.join()
    found = read_recordings(tmp_path / "c.jsonl")
    assert {(r.candidate, r.messages[1].text) for r in found} == {(n, f"Draw {n}.") for n in range(16)}


def test_a_killed_process_leaves_what_it_has_written(tmp_path):
    path = tmp_path / "c.jsonl"
    process = appending(path, "a", 1_000_000)
    written = [int(process.stdout.readline()) for _ in range(5)]
    process.send_signal(signal.SIGKILL)
    process.communicate(timeout=60)
    assert [value["n"] for value in values(path)][:5] == written
    Cassette(path).append({"text": "after"})
    assert values(path)[-1] == {"text": "after"}


@pytest.mark.parametrize("spoilt", [lambda path: path.mkdir(), lambda path: path.write_text("spoilt\n")])
def test_an_answer_that_is_paid_for_is_returned_even_if_it_cannot_be_recorded(tmp_path, spoilt):
    path = tmp_path / "c.jsonl"

    def spoil():
        path.unlink()
        spoilt(path)

    found = Recorder(Model("x", before=spoil), path).complete(request())
    assert found.text == "x"
    assert "not recorded" in found.notes[0]
    assert "c.jsonl" in found.notes[0]


def test_a_cassette_that_cannot_be_written_is_said_before_the_model_is_asked(tmp_path):
    (tmp_path / "drawing-star.jsonl").mkdir()
    asked = []
    recorder = Recorder(Model("x", before=lambda: asked.append(1)), tmp_path)
    with pytest.raises(UsageError, match=r"drawing-star\.jsonl"):
        recorder.complete(request())
    assert not asked


@pytest.mark.parametrize("echo", ["{}", "def gen_plan(): return '{}'"])
def test_a_key_is_in_no_cassette(tmp_path, monkeypatch, echo):
    monkeypatch.setenv("SOME_PROVIDER_API_KEY", "sk-planted-0123456789")
    talkative = Completion(candidates=(Candidate(text="fine"),), model="m", notes=("no key here",))
    leaking = plain_answer(echo.format("sk-planted-0123456789"), "m")
    noting = talkative.model_copy(update={"notes": ("sk-planted-0123456789 was used",)})
    answers = record(tmp_path / "all", talkative, leaking, noting, requests=[request()] * 3)
    assert [answer.text for answer in answers] == ["fine", leaking.text, "fine"]
    assert [any("not recorded" in note for note in answer.notes) for answer in answers] == [False, True, True]
    files = [file for file in Path(tmp_path).rglob("*") if file.is_file()]
    assert [file.name for file in files] == ["drawing-star.jsonl"]
    assert b"fine" in files[0].read_bytes()
    assert b"sk-planted" not in files[0].read_bytes()
