"""What servers send beside a plain text, what they refuse, and how long they may take; through litellm."""

import os
import subprocess
import sys
import threading
import time

import pytest

from proc3s import LLMError, Message, Request
from proc3s.llm.types import Sampling
from proc3s.llm.usage import Usage
from proc3s_litellm.backend import LiteLLM, Options
from proc3s_litellm.loading import load_litellm
from provider import DRIPS, MODEL, USAGE, Reply, refuses, running, says, sends

pytestmark = pytest.mark.xdist_group("litellm")

COUNTED = Usage(prompt_tokens=11, completion_tokens=22)


@pytest.fixture(autouse=True)
def _clean_environment(monkeypatch):
    for name in [n for n in os.environ if n.endswith(("_KEY", "_TOKEN", "_API_BASE", "_BASE_URL"))]:
        monkeypatch.delenv(name)


def request(**sampling):
    message = Message(role="user", kind="task", text="Draw a star.")
    return Request(
        messages=(message,), task="d/t", method="m", template="m", seed=0, sampling=Sampling(**sampling)
    )


@pytest.fixture
def llm(provider):
    """A model of the server, as `model` names it."""

    def make(model="openai/tiny", timeout=5.0):
        return LiteLLM(model, Options(api_base=provider.address, timeout=timeout))

    return make


def message(finish="stop", **content):
    choice = {"index": 0, "message": {"role": "assistant", **content}, "finish_reason": finish}
    return sends(
        {"id": "1", "object": "chat.completion", "model": MODEL, "choices": [choice], "usage": USAGE}
    )


TEXT = {"type": "text", "text": "def gen"}
MORE = {"type": "text", "text": "_plan"}


@pytest.mark.parametrize("model", ["openai/tiny", "lm_studio/tiny", "groq/tiny", "openrouter/a/b"])
@pytest.mark.parametrize(
    "content",
    [
        [TEXT, MORE],
        [{"type": "thinking", "thinking": "hm"}, TEXT, MORE],
        [{"type": "reasoning", "text": "hm"}, {"type": "output_text", "text": "def gen_plan"}],
        [{"type": "reasoning", "summary": []}, {"type": "image_url", "image_url": {"url": "x"}}, TEXT, MORE],
        ["def gen", "_plan"],
        [{"type": "text", "text": {"value": "def gen_plan", "annotations": []}}],
        {"type": "text", "text": "def gen_plan"},
        "def gen_plan",
    ],
    ids=["texts", "thinking", "output", "picture", "words", "value", "one", "plain"],
)
def test_a_content_in_parts_is_joined_without_what_is_no_text(llm, provider, model, content):
    provider.script(message(content=content))
    completion = llm(model).complete(request())
    assert (completion.text, completion.candidates[0].finish_reason) == ("def gen_plan", "stop")
    assert (completion.usage, completion.model) == (COUNTED, MODEL)


CALL = {"id": "1", "type": "function", "function": {"name": "f", "arguments": "{}"}}


@pytest.mark.parametrize(
    ("reply", "finish", "refusal"),
    [
        (message(content=None, refusal="I cannot help"), "stop", "I cannot help"),
        (message(content=[{"type": "refusal", "refusal": "I cannot help"}]), "stop", "I cannot help"),
        (message(content=None, finish="content_filter"), "content_filter", None),
        (message(content="", finish="content_filter"), "content_filter", None),
        (message(content=None, tool_calls=[CALL], finish="tool_calls"), "tool_calls", None),
        (message(content="", function_call={"name": "f", "arguments": "{}"}), "tool_calls", None),
        (message(content=[], tool_calls=[CALL]), "tool_calls", None),
    ],
)
def test_why_there_is_no_text_is_handed_on_with_what_it_cost(llm, provider, reply, finish, refusal):
    provider.script(reply)
    completion = llm().complete(request())
    (candidate,) = completion.candidates
    assert (candidate.text, candidate.finish_reason, candidate.refusal) == ("", finish, refusal)
    assert completion.usage == COUNTED


def test_an_answer_without_candidates_has_cost_something_too(llm, provider):
    provider.script(sends({"id": "1", "model": "m", "choices": [], "usage": USAGE}))
    completion = llm().complete(request())
    assert (completion.candidates, completion.usage) == ((), COUNTED)


def test_an_answer_that_cannot_be_read_has_cost_what_it_says(llm, provider):
    provider.script(sends({"choices": [{"message": None}], "usage": USAGE}))
    with pytest.raises(LLMError) as caught:
        llm().complete(request())
    assert (caught.value.fault, caught.value.usage) == ("broken", COUNTED)


@pytest.mark.parametrize("does", DRIPS, ids=lambda reply: reply.does)
@pytest.mark.parametrize("model", ["openai/tiny", "openrouter/a/b"])
def test_a_server_that_drips_is_given_up_in_time(llm, provider, model, does):
    llm(model).complete(request())  # the first call imports the provider's client
    provider.script(does)
    begun = time.monotonic()
    with pytest.raises(LLMError, match=r"no answer within 0\.4 s") as caught:
        llm(model, timeout=0.4).complete(request())
    assert caught.value.fault == "timeout"
    assert time.monotonic() - begun < 2


@pytest.mark.parametrize("model", ["openai/tiny", "openrouter/a/b"])
def test_only_the_call_is_the_models_time(llm, provider, model):
    provider.script(says("x", after=0.2))
    completion = llm(model).complete(request())
    assert 0.2 <= completion.latency < 1


LEFT = """
import sys, time
from proc3s import LLMError, Message, Request
from proc3s_litellm.backend import LiteLLM, Options
message = Message(role="user", kind="task", text="x")
request = Request(messages=(message,), task="d/t", method="m", template="m", seed=0)
llm = LiteLLM("openai/tiny", Options(api_base=sys.argv[1], timeout=0.3))
llm.prepare()
try:
    llm.complete(request)
except LLMError as error:
    print(error.fault, time.time())
"""


@pytest.mark.slow
def test_a_call_that_was_given_up_keeps_no_process_alive(provider):
    provider.script(DRIPS[0])
    done = subprocess.run(
        [sys.executable, "-c", LEFT, provider.address], capture_output=True, text=True, timeout=60
    )
    fault, ended = done.stdout.split()
    assert (done.returncode, fault, done.stderr) == (0, "timeout", "")
    assert time.time() - float(ended) < 20  # the server would go on for 50


def test_what_ends_a_thread_reaches_the_caller(llm, monkeypatch):
    def quits(**_):
        raise SystemExit(0)

    monkeypatch.setattr(load_litellm(), "completion", quits)
    with pytest.raises(SystemExit):
        llm().complete(request())


REFUSALS = {
    "temperature": [
        refuses(400, "'temperature' does not support 0.0 with this model, only 1 does."),
        refuses(422, "temperature: unsupported"),
        sends({"detail": [{"loc": ["body", "temperature"], "msg": "Extra inputs"}]}, 422),
        sends({"error": {"message": "Unsupported value", "param": "temperature"}}, 400),
        sends({"error": {"message": "`temperature` is deprecated for this model.", "code": 400}}),
    ],
    "seed": [
        refuses(400, "Unrecognized request argument supplied: seed"),
        sends({"detail": [{"loc": ["body", "random_seed"], "msg": "Extra inputs are not permitted"}]}, 422),
        sends(b"unknown field: seed", 400),
    ],
    "max_tokens": [
        refuses(400, "max_tokens is too large: 99. This model supports at most 4"),
        refuses(400, "'max_tokens' or 'max_completion_tokens' is too large: 99. This model's maximum context "
                "length is 50 tokens"),
        refuses(422, "maxOutputTokens is not supported"),
    ],
    "n": [
        refuses(400, "Only one candidate can be specified: candidate_count"),
        refuses(400, "This model does not support n > 1"),
        refuses(422, "Unrecognized request argument supplied: n"),
    ],
    "reasoning_effort": [refuses(400, "reasoning_effort is not supported by this model")],
}  # fmt: skip
EVERYTHING = {"temperature": 0.0, "seed": 3, "n": 2, "max_tokens": 99, "reasoning_effort": "low"}


@pytest.mark.parametrize(
    ("name", "reply"),
    [(name, reply) for name, replies in REFUSALS.items() for reply in replies],
    ids=lambda x: x if isinstance(x, str) else x.body.decode()[:40],
)
def test_a_refusal_names_the_parameter_in_whichever_words(llm, provider, name, reply):
    provider.script(reply)
    with pytest.raises(LLMError) as caught:
        llm().complete(request(**EVERYTHING))
    assert (caught.value.fault, caught.value.parameters) == ("parameter", (name,))
    assert f"refuses {name}" in str(caught.value)


@pytest.mark.parametrize(
    "reply",
    [
        refuses(400, "no image generation for this session"),
        refuses(400, "the model doubao-seed-1.6 is not deployed"),
        refuses(404, "temperature"),
        refuses(500, "the temperature of the machine room is too high"),
        refuses(400, "This model's maximum context length is 8 tokens", code="context_length_exceeded"),
    ],
    ids=lambda reply: reply.body.decode()[:40],
)
def test_another_refusal_is_not_taken_for_one_of_a_parameter(llm, provider, reply):
    provider.script(reply)
    with pytest.raises(LLMError) as caught:
        llm().complete(request(**EVERYTHING))
    assert caught.value.fault != "parameter"


def test_a_parameter_that_was_not_sent_is_not_refused(llm, provider):
    provider.script(refuses(400, "temperature is not supported"))
    with pytest.raises(LLMError) as caught:
        llm().complete(request(seed=1))
    assert caught.value.fault == "other"


def test_another_name_of_the_longest_answer_is_taken_up(llm, provider):
    said = "Unsupported parameter: 'max_tokens' is not supported with this model. Use 'max_completion_tokens'"
    provider.script(refuses(400, said))
    model = llm()
    with pytest.raises(LLMError) as caught:
        model.complete(request(max_tokens=99))
    assert (caught.value.fault, caught.value.parameters) == ("parameter", ())
    assert model.complete(request(max_tokens=99)).dropped == ()
    assert [asked.body.get("max_completion_tokens") for asked in provider.asked] == [None, 99]
    assert "max_tokens" not in provider.asked[1].body


def test_several_calls_at_once_keep_their_bodies_apart(llm, provider):
    model, answers = llm(), {}
    provider.script(*[message(content=[TEXT, {"type": "text", "text": str(k)}]) for k in range(6)])

    def ask(number):
        answers[number] = model.complete(request()).text

    threads = [threading.Thread(target=ask, args=(k,)) for k in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(10)
    assert sorted(answers.values()) == [f"def gen{k}" for k in range(6)]


def test_the_server_of_the_tests_drips():
    """Otherwise the tests of dripping servers would show nothing."""
    import urllib.request

    with running() as server:
        server.script(Reply(text="x", does="drip"))
        begun = time.monotonic()
        asked = urllib.request.Request(f"{server.address}/chat/completions", data=b"{}", method="POST")
        with urllib.request.urlopen(asked, timeout=0.2) as answer:
            answer.read(10)
        assert time.monotonic() - begun > 0.4


def whole(**more):
    choice = {"index": 0, "message": {"content": "def gen_plan"}, "finish_reason": "stop"}
    return sends({"id": "1", "model": "m", "choices": [choice], "usage": USAGE, **more})


@pytest.mark.parametrize(
    ("usage", "counted"),
    [
        ({"prompt_tokens": -1, "completion_tokens": -1}, Usage()),
        ({"prompt_tokens": "many", "completion_tokens": "few"}, Usage()),
        ({"prompt_tokens": 11.5, "completion_tokens": 2.5}, Usage()),
        ({"prompt_tokens": 0, "completion_tokens": 0}, Usage()),
        ([], Usage()),
        ("x", Usage()),
        (None, Usage()),
        ({"total_tokens": 9}, Usage()),
        ({"prompt_tokens": 5}, Usage(prompt_tokens=5)),
        ({"prompt_tokens": 5, "completion_tokens": None}, Usage(prompt_tokens=5)),
        (
            {"prompt_tokens": 5, "completion_tokens": 1, "prompt_tokens_details": {"cached_tokens": -3}},
            Usage(prompt_tokens=5, completion_tokens=1),
        ),
    ],
    ids=str,
)
def test_strange_counts_are_unknown_and_do_not_cost_the_answer(llm, provider, usage, counted):
    provider.script(whole(usage=usage))
    completion = llm().complete(request())
    assert (completion.text, completion.usage) == ("def gen_plan", counted)


@pytest.mark.parametrize("model", [3, None, [], {"a": 1}, ""], ids=str)
def test_a_strange_name_does_not_cost_the_answer(llm, provider, model):
    provider.script(whole(model=model))
    assert llm().complete(request()).model == "tiny"


@pytest.mark.parametrize(
    ("sent", "finish"),
    [
        ("length", "length"),
        ("LENGTH", "length"),
        ("max_tokens", "length"),
        ("MAX_TOKENS", "length"),
        ("error", "error"),
        ("STOP", "stop"),
        ("weird", "stop"),
        (None, "stop"),
        (3, "stop"),
        ([], "stop"),
    ],
    ids=str,
)
def test_an_answer_that_ends_in_the_middle_is_never_whole(llm, provider, sent, finish):
    provider.script(whole(choices=[{"index": 0, "message": {"content": "def"}, "finish_reason": sent}]))
    assert llm().complete(request()).candidates[0].finish_reason == finish


def test_errors_in_a_list_are_read(llm, provider):
    provider.script(sends({"errors": [{"message": "the tea is cold"}]}, 418))
    with pytest.raises(LLMError, match="the tea is cold"):
        llm().complete(request())


@pytest.mark.parametrize("seconds", [0, -1, "inf", "nan", 1e9])
def test_a_timeout_is_a_number_of_seconds(seconds):
    with pytest.raises(ValueError, match="timeout"):
        Options(timeout=seconds)
