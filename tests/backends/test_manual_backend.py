"""Answers by hand: which files go out, and when an answer counts."""

import threading
import time

import pytest

from proc3s import LLMError, Message, Pending, Request, Sampling
from proc3s_replay.manual import Manual, Options

STAR = "drawing.star.proc3s.seed0"


def request(text="Draw a star.", n=1, **changes):
    usual = {"task": "drawing/star", "method": "proc3s", "template": "t", "seed": 0}
    messages = (
        Message(role="system", kind="system", text="You plan."),
        Message(role="user", kind="task", text=text),
    )
    return Request(messages=messages, sampling=Sampling(n=n), **(usual | changes))


@pytest.fixture
def desk(tmp_path):
    return tmp_path / "desk"


def ask(desk, asked=None, wait=0.0):
    return Manual(str(desk), Options(wait=wait)).complete(asked or request())


def pending(desk, asked=None, wait=0.0):
    with pytest.raises(Pending) as caught:
        ask(desk, asked, wait)
    return str(caught.value)


def prompts(desk):
    return sorted(file.name.removesuffix(".prompt.md") for file in desk.glob("*.prompt.md"))


def test_a_prompt_goes_out_and_its_answer_comes_back(desk):
    told = pending(desk)
    assert told == f"pending: read {desk / STAR}.prompt.md and write the answer to {desk / STAR}.answer.md"
    prompt = (desk / f"{STAR}.prompt.md").read_text()
    assert prompt == "# system: system\n\nYou plan.\n\n# user: task\n\nDraw a star.\n"
    (desk / f"{STAR}.answer.md").write_text("a\r\nb\n")
    found = ask(desk)
    assert (found.text, found.source, len(found.candidates)) == ("a\nb\n", "manual", 1)
    assert sorted(file.name for file in desk.iterdir()) == [f"{STAR}.answer.md", f"{STAR}.prompt.md"]


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"round": 2}, f"{STAR}.round2"),
        ({"candidate": 3}, f"{STAR}.candidate3"),
        ({"round": 1, "candidate": 2}, f"{STAR}.round1.candidate2"),
        ({"seed": 7}, "drawing.star.proc3s.seed7"),
        ({"method": "cap-gaussian"}, "drawing.star.cap-gaussian.seed0"),
        ({"task": "blocks/star"}, "blocks.star.proc3s.seed0"),
    ],
)
def test_every_request_has_a_prompt_of_its_own(desk, change, name):
    pending(desk)
    pending(desk, request(**change))
    assert prompts(desk) == sorted([STAR, name])


def test_names_with_dots_and_slashes_neither_collide_nor_leave_the_folder(desk):
    names = [
        ("a/b.c", "m"),
        ("a.b/c", "m"),
        ("a/b", "c.m"),
        ("a/../../b", "m"),
        ("a/b/c", "m"),
        ("a/b%2ec", "m"),
    ]
    for task, method in names:
        pending(desk, request(task=task, method=method))
    assert len(prompts(desk)) == len(names)
    assert [file.name for file in desk.parent.iterdir()] == ["desk"]


def test_all_candidates_are_asked_for_at_once_and_come_back_together(desk):
    told = pending(desk, request(n=3))
    names = [STAR, f"{STAR}.candidate1", f"{STAR}.candidate2"]
    assert prompts(desk) == sorted(names)
    assert told.startswith("pending: read these 3 prompts")
    assert all(f"{desk / name}.answer.md" in told for name in names)
    for name in names[:2]:
        (desk / f"{name}.answer.md").write_text(name)
    told = pending(desk, request(n=3))
    assert f"{names[2]}.answer.md" in told
    assert f"{names[1]}.answer.md" not in told
    (desk / f"{names[2]}.answer.md").write_text(names[2])
    assert [candidate.text for candidate in ask(desk, request(n=3)).candidates] == names


def test_further_candidates_keep_their_numbers(desk):
    pending(desk, request(candidate=4, n=2))
    assert prompts(desk) == [f"{STAR}.candidate4", f"{STAR}.candidate5"]


def test_an_answer_to_another_prompt_is_put_aside_and_never_lost(desk, capsys):
    answer = desk / f"{STAR}.answer.md"
    for number, text in enumerate(["one", "two", "three"]):
        pending(desk, request(f"Draw {number}."))
        answer.write_text(text)
    pending(desk, request("Draw 3."))
    assert [(desk / f"{STAR}.answer.old{n}.md").read_text() for n in (1, 2, 3)] == ["one", "two", "three"]
    assert not answer.exists()
    assert f"{STAR}.answer.old3.md" in capsys.readouterr().err


def test_an_answer_without_its_prompt_is_not_taken(desk):
    desk.mkdir()
    (desk / f"{STAR}.answer.md").write_text("to who knows what")
    pending(desk)
    assert (desk / f"{STAR}.answer.old1.md").read_text() == "to who knows what"


@pytest.mark.parametrize("text", ["Draw\r\na star.\r", "Draw a star.\n\n", "\ud800 star", "★"])
def test_the_same_prompt_stays_the_same(desk, text):
    pending(desk, request(text))
    (desk / f"{STAR}.answer.md").write_text("x")
    assert ask(desk, request(text)).text == "x"


@pytest.mark.parametrize("blank", ["", " \n\t\n"])
def test_a_blank_answer_is_none_yet(desk, blank):
    pending(desk)
    (desk / f"{STAR}.answer.md").write_text(blank)
    assert "pending" in pending(desk)


def test_an_answer_that_is_no_text(desk):
    pending(desk)
    (desk / f"{STAR}.answer.md").write_bytes(b"caf\xe9")
    with pytest.raises(LLMError, match=r"answer\.md is not UTF-8"):
        ask(desk)


def test_a_mark_of_the_editor_at_the_beginning_is_not_part_of_the_answer(desk):
    pending(desk)
    (desk / f"{STAR}.answer.md").write_bytes("\ufeffx".encode())
    assert ask(desk).text == "x"


def test_without_waiting_nothing_is_waited_for(desk, monkeypatch):
    monkeypatch.setattr(time, "sleep", lambda _: pytest.fail("slept"))
    pending(desk, request(n=2))
    for name in (STAR, f"{STAR}.candidate1"):
        (desk / f"{name}.answer.md").write_text("x")
    ask(desk, request(n=2))


class Editor:
    """Stands in for `time.sleep`: writes the answer further at every look."""

    def __init__(self, desk, *states):
        self._answer = desk / f"{STAR}.answer.md"
        self._states = list(states)
        self.sleeps = 0

    def sleep(self, _):
        self.sleeps += 1
        if self._states and (text := self._states.pop(0)) is not None:
            self._answer.write_text(text)


def test_a_half_written_answer_is_not_taken(desk, monkeypatch, capsys):
    editor = Editor(desk, None, " ", "def", "def gen", "def gen_plan")
    monkeypatch.setattr(time, "sleep", editor.sleep)
    assert ask(desk, wait=None).text == "def gen_plan"
    assert editor.sleeps == 6
    assert capsys.readouterr().err.count(f"{STAR}.answer.md") == 1


def test_an_answer_that_is_there_when_the_waiting_begins_may_be_half_written_too(desk, monkeypatch, capsys):
    pending(desk)
    (desk / f"{STAR}.answer.md").write_text("def")
    monkeypatch.setattr(time, "sleep", Editor(desk, "def gen_plan").sleep)
    assert ask(desk, wait=None).text == "def gen_plan"
    assert capsys.readouterr().err == ""


def test_waiting_ends(desk):
    begun = time.monotonic()
    assert "pending" in pending(desk, wait=0.2)
    assert 0.2 <= time.monotonic() - begun < 5


def test_an_answer_that_is_there_is_taken_even_in_a_short_time(desk):
    pending(desk)
    (desk / f"{STAR}.answer.md").write_text("x")
    assert ask(desk, wait=0.05).text == "x"


def test_several_wait_at_once(desk):
    found = {}
    threads = [
        threading.Thread(target=lambda n=n: found.update({n: ask(desk, request(seed=n), wait=20).text}))
        for n in range(3)
    ]
    for thread in threads:
        thread.start()
    while len(prompts(desk)) < 3:
        time.sleep(0.02)
    for n in range(3):
        (desk / f"drawing.star.proc3s.seed{n}.answer.md").write_text(str(n))
    for thread in threads:
        thread.join(20)
    assert found == {n: str(n) for n in range(3)}


def test_a_folder_that_cannot_be_written(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(LLMError, match="file"):
        ask(tmp_path / "file")
    with pytest.raises(LLMError, match="manual:DIR"):
        Manual("", Options())
    assert not Manual(str(tmp_path), Options()).live
