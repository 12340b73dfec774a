"""The stub: scripted answers by round and candidate."""

import json

import pytest

from proc3s import LLMError, Message, Request, Sampling
from proc3s_replay.stub import Stub


@pytest.fixture
def script(tmp_path):
    def write(content):
        (tmp_path / "script.json").write_text(json.dumps(content))
        return Stub(str(tmp_path / "script.json"), None)

    return write


def texts(stub, n=1, **changes):
    usual = {"task": "drawing/star", "method": "proc3s", "template": "proc3s", "seed": 0}
    messages = (Message(role="user", kind="task", text="Draw."),)
    completion = stub.complete(Request(messages=messages, sampling=Sampling(n=n), **(usual | changes)))
    assert (completion.source, stub.live) == ("authored", False)
    return [candidate.text for candidate in completion.candidates]


def test_one_text_a_round(script):
    stub = script(["a", "b"])
    assert [texts(stub, round=1), texts(stub), texts(stub, n=3)] == [["b"], ["a"], ["a"]]


def test_a_list_holds_the_candidates_of_a_round(script):
    stub = script([["a", "b", "c"], "d"])
    assert texts(stub, n=3) == ["a", "b", "c"]
    assert texts(stub, n=2) == ["a", "b"]
    assert texts(stub, n=3, candidate=1) == ["b", "c"]
    assert texts(stub, candidate=2) == ["c"]


@pytest.mark.parametrize("past", [{"round": 2}, {"candidate": 3}, {"round": 1, "candidate": 1}])
def test_past_the_end_there_is_no_answer(script, past):
    with pytest.raises(LLMError, match="script") as caught:
        texts(script([["a", "b", "c"], "d"]), **past)
    assert caught.value.fault == "no_answer"


@pytest.mark.parametrize("content", [{}, "a", 1, [1], [["a", 1]], [[]], [None]])
def test_anything_else_is_refused(script, content):
    with pytest.raises(LLMError, match="list of texts"):
        script(content)
