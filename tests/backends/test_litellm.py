"""The litellm backend, through the real litellm, against a real server on this machine.

All of it runs in one process: importing litellm takes seconds.
"""

import os
import socket
import subprocess
import sys
import threading
import traceback
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from proc3s import LLMError, Message, Request
from proc3s.llm.errors import TRANSIENT
from proc3s.llm.types import Price, Sampling
from proc3s.llm.usage import Usage
from proc3s_litellm import prices
from proc3s_litellm.backend import LiteLLM, Options
from proc3s_litellm.loading import load_litellm
from proc3s_litellm.parameters import split
from proc3s_litellm.wire import takes_marks
from provider import CLOSES, CUTS, HANGS, MODEL, USAGE, refuses, running, says, sends

pytestmark = pytest.mark.xdist_group("litellm")

KEY = "sk-planted-0123456789"
HTML = "<!DOCTYPE html><html><head><title>Gateway</title></head><body><p>lost</p></body></html>"
STABLE = (
    Message(role="system", kind="system", text="You are a robot."),
    Message(role="user", kind="example", text="Draw a square."),
    Message(role="assistant", kind="example", text="def gen_plan"),
)
TASK = Message(role="user", kind="task", text="Draw a star of platypuses.")


def request(messages=(*STABLE, TASK), **sampling):
    return Request(
        messages=messages,
        task="drawing/star",
        method="proc3s",
        template="proc3s",
        seed=0,
        sampling=Sampling(**sampling),
    )


@pytest.fixture(autouse=True)
def _clean_environment(monkeypatch):
    """No key and no server of this machine."""
    for name in [n for n in os.environ if n.endswith(("_KEY", "_TOKEN", "_API_BASE", "_BASE_URL"))]:
        monkeypatch.delenv(name)


@pytest.fixture(autouse=True)
def _only_this_machine(monkeypatch):
    """Nobody is looked for but the server on this machine, and one that does not exist."""
    resolve, hosts = socket.getaddrinfo, set()

    def watched(host, *args, **kwargs):
        hosts.add(host)
        return resolve(host, *args, **kwargs)

    monkeypatch.setattr(socket, "getaddrinfo", watched)
    yield
    assert hosts <= {"127.0.0.1", "no.such.host.invalid"}


@pytest.fixture(autouse=True)
def _silent(capfd):
    """Neither litellm nor the backend prints anything."""
    yield
    assert tuple(capfd.readouterr()) == ("", "")


@pytest.fixture
def ask(provider):
    """Asks a model behind the server; `model` decides which protocol is spoken."""

    def ask(model="openai/tiny", timeout=5.0, messages=(*STABLE, TASK), **sampling):
        base = provider.root if model.startswith(("anthropic/", "ollama", "gemini/")) else provider.address
        return LiteLLM(model, Options(api_base=base, timeout=timeout)).complete(request(messages, **sampling))

    return ask


@pytest.fixture
def fault_of(ask, provider):
    """The error of a model that gets this reply, once it is certain that it was asked only once."""

    def fault_of(reply, model="openai/tiny", **options):
        provider.script(reply)
        with pytest.raises(LLMError) as caught:
            ask(model, **options)
        assert len(provider.asked) == 1
        return caught.value

    return fault_of


FAULTS = {
    "refused key": (refuses(401, "Incorrect API key", code="invalid_api_key"), "auth", "OPENAI_API_KEY"),
    "refused access": (refuses(403, "This region is not supported"), "auth", "This region"),
    "refused by a page": (sends(HTML, 401), "auth", "a page of HTML"),
    "unpaid": (refuses(402, "Insufficient Balance"), "quota", "Insufficient Balance"),
    "quota": (refuses(429, "You exceeded your quota", code="insufficient_quota"), "quota", "top it up"),
    "too many": (refuses(429, "Rate limit reached", code="rate_limit_exceeded"), "rate_limit", "Rate limit"),
    "no model": (refuses(404, "The model does not exist", code="model_not_found"), "unknown_model", "name"),
    "no path": (sends("<html>404</html>", 404), "unknown_model", "api_base"),
    "bad model": (refuses(400, "tiny is not a valid model ID"), "unknown_model", "valid model"),
    "too long": (refuses(400, "too long", code="context_length_exceeded"), "context", "too long"),
    "too large": (refuses(413, "Request too large", code="rate_limit_exceeded"), "context", "too large"),
    "filter": (refuses(400, "no", code="content_filter"), "filtered", "content filter"),
    "bad request": (refuses(400, "temperature is out of range"), "other", "out of range"),
    "bad value": (refuses(422, "no such value"), "other", "no such value"),
    "request timeout": (refuses(408, "gave up"), "timeout", "gave up"),
    "gateway timeout": (sends(HTML, 504), "timeout", "HTTP 504"),
    "fell over": (refuses(500, "the model fell over"), "server", "fell over"),
    "bad gateway": (sends(HTML, 502), "server", "a page of HTML"),
    "loading": (refuses(503, "Loading model"), "server", "Loading model"),
    "overloaded": (refuses(529, "overloaded"), "server", "overloaded"),
    "hangs up": (CLOSES, "connection", "nobody answers"),
    "half a body": (CUTS, "broken", "breaks off"),
    "a page": (sends(HTML), "broken", "a page of HTML"),
    "no JSON": (sends(b"{this is no JSON"), "broken", "not JSON"),
    "nothing": (sends(b""), "broken", "not JSON"),
    "a list": (sends([1, 2]), "broken", "not in the shape"),
    "a text": (sends(b'"hello"'), "broken", "not in the shape"),
    "null": (sends(None), "broken", "not in the shape"),
    "no choices": (sends({"id": "1"}), "broken", "not in the shape"),
    "null choices": (sends({"choices": None}), "broken", "not in the shape"),
    "strange choices": (sends({"choices": [{"foo": 1}]}), "broken", "not in the shape"),
    "error as success": (sends({"error": {"message": "upstream fell", "code": 502}}), "server", "upstream"),
    "limit as success": (sends({"error": {"message": "slow down", "code": 429}}), "rate_limit", "slow down"),
    "error as a word": (sends({"error": "upstream fell"}), "server", "upstream fell"),
    "no such endpoint": (sends({"error": "Unexpected endpoint or method. (POST /x)"}), "other", "api_base"),
    "moved": (sends({}, 301), "other", "api_base"),
    "no content": (sends(b"", 204), "broken", "not JSON"),
    "no gzip": (sends(b"none", content_encoding="gzip"), "broken", "decompressed"),
    "ever deeper": (sends(b"[" * 100_000), "broken", "not in the shape"),
    "a number for a text": (sends({"choices": [{"message": {"content": 3}}]}), "broken", "not in the shape"),
}


@pytest.mark.parametrize(("reply", "fault", "said"), FAULTS.values(), ids=FAULTS.keys())
def test_a_fault_is_recognised_and_told_in_one_line(fault_of, provider, reply, fault, said):
    error = fault_of(reply)
    assert (error.fault, error.exit_code) == (fault, 3)
    assert said in str(error)
    assert str(error).startswith(f"openai/tiny at {provider.address}: ")
    assert "\n" not in str(error)
    assert "<" not in str(error)
    assert "platypuses" not in str(error)


@pytest.mark.parametrize("model", ["anthropic/claude-x", "ollama_chat/tiny", "gemini/tiny", "mistral/tiny"])
@pytest.mark.parametrize(
    "name",
    [
        "refused key",
        "quota",
        "too many",
        "no model",
        "too long",
        "filter",
        "bad request",
        "overloaded",
        "hangs up",
        "half a body",
        "a page",
        "no JSON",
        "a list",
    ],
)
def test_a_fault_is_the_same_whichever_protocol_is_spoken(fault_of, model, name):
    reply, fault, _ = FAULTS[name]
    assert fault_of(reply, model).fault == fault


def test_a_server_that_says_nothing_is_given_up(fault_of):
    error = fault_of(HANGS, timeout=0.3)
    assert error.fault == "timeout"
    assert "0.3 s" in str(error)
    assert "-L timeout" in str(error)


@pytest.mark.parametrize(
    ("model", "address", "advice"),
    [
        ("openai/tiny", "http://127.0.0.1:1/v1", "api_base"),
        ("anthropic/claude-x", "http://127.0.0.1:1", "api_base"),
        ("ollama_chat/qwen3", "http://127.0.0.1:1", "ollama serve"),
        ("openai/tiny", "http://no.such.host.invalid/v1", "api_base"),
    ],
)
def test_a_server_that_is_not_there(model, address, advice):
    with pytest.raises(LLMError, match="nobody answers") as caught:
        LiteLLM(model, Options(api_base=address, timeout=5)).complete(request())
    assert caught.value.fault == "connection"
    assert advice in str(caught.value)
    assert address in str(caught.value)


def test_a_model_that_ollama_does_not_have_yet(fault_of):
    error = fault_of(sends({"error": "model 'qwen3' not found"}, 404), "ollama_chat/qwen3")
    assert error.fault == "unknown_model"
    assert "ollama pull qwen3" in str(error)


def test_a_provider_that_nobody_knows(monkeypatch):
    monkeypatch.setenv("OPENAI_API_KEY", KEY)
    with pytest.raises(LLMError, match="no provider 'neverheardof'") as caught:
        LiteLLM("neverheardof/tiny", Options()).complete(request())
    assert caught.value.fault == "unknown_model"


@pytest.mark.parametrize(
    ("model", "variable"), [("veniceai/m", "VENICE_AI_API_KEY"), ("edenai/m", "EDENAI_API_KEY")]
)
def test_the_key_of_openai_goes_to_nobody_else(monkeypatch, provider, model, variable):
    monkeypatch.setenv("OPENAI_API_KEY", KEY)
    with pytest.raises(LLMError, match=variable) as caught:
        LiteLLM(model, Options()).complete(request())
    assert caught.value.fault == "missing_key"
    LiteLLM(model, Options(api_base=provider.address)).complete(request())
    assert KEY not in str(provider.asked)


def test_what_litellm_cannot_do_without_another_package_is_said(provider, monkeypatch):
    monkeypatch.setitem(sys.modules, "google", None)
    with pytest.raises(LLMError, match="module google"):
        LiteLLM("vertex_ai/gemini-1.5-pro", Options(api_base=provider.address)).complete(request())


@pytest.mark.parametrize(
    ("headers", "seconds"),
    [
        ({"Retry_After": "7"}, 7.0),
        ({"retry_after_ms": "1500"}, 1.5),
        ({"Retry_After": "Wed, 21 Oct 2015 07:28:00 GMT"}, 0.0),
        ({}, None),
    ],
)
@pytest.mark.parametrize("model", ["openai/tiny", "anthropic/claude-x"])
def test_how_long_the_provider_asks_to_wait(fault_of, model, headers, seconds):
    assert fault_of(refuses(429, "later", **headers), model).retry_after == seconds


def test_what_can_be_tried_again_is_what_passes():
    assert {fault for _, fault, _ in FAULTS.values()} >= TRANSIENT - {"empty"}  # of which a run makes a fault
    assert not TRANSIENT & {"quota", "auth", "unknown_model", "context", "filtered"}


def test_an_answer_with_all_that_is_known_of_it(ask, provider):
    details = {"prompt_tokens_details": {"cached_tokens": 5}}
    provider.script(says("def gen_plan", usage={**USAGE, **details}))
    completion = ask(temperature=0.5, seed=7, max_tokens=99)
    assert (completion.text, completion.candidates[0].finish_reason) == ("def gen_plan", "stop")
    assert (completion.source, completion.model, completion.model_asked) == ("live", MODEL, "openai/tiny")
    assert completion.usage == Usage(prompt_tokens=11, completion_tokens=22, cached_tokens=5)
    assert (completion.cost, completion.dropped, completion.notes) == (None, (), ())
    (asked,) = provider.asked
    assert asked.path == "/v1/chat/completions"
    assert asked.body == {
        "model": "tiny",
        "messages": [{"role": m.role, "content": m.text} for m in (*STABLE, TASK)],
        "temperature": 0.5,
        "seed": 7,
        "max_tokens": 99,
    }


def test_all_candidates_come_back(ask, provider):
    provider.script(says("plan"))
    completion = ask(n=3)
    assert provider.asked[0].body["n"] == 3
    assert [c.text for c in completion.candidates] == ["plan 0", "plan 1", "plan 2"]


def test_what_is_not_set_is_not_sent(ask, provider):
    ask()
    assert provider.asked[0].body.keys() == {"model", "messages"}


@pytest.mark.parametrize("model", ["openai/tiny", "anthropic/claude-x"])
def test_tokens_that_nobody_counted_are_unknown(ask, provider, model):
    provider.script(says("plan", usage=None))
    assert ask(model).usage == Usage()


@pytest.mark.parametrize(
    ("reply", "text", "finish"),
    [
        (says(None), "", "stop"),
        (says(""), "", "stop"),
        (says("def gen", finish="length"), "def gen", "length"),
    ],
)
def test_an_answer_without_a_text_or_without_its_end_is_handed_on_as_it_is(
    ask, provider, reply, text, finish
):
    provider.script(reply)
    (candidate,) = ask().candidates
    assert (candidate.text, candidate.finish_reason) == (text, finish)


def test_the_prefix_of_the_provider_is_not_part_of_the_models_name(ask):
    assert ask("lm_studio/tiny").model == MODEL


def ollama(text):
    message = {"role": "assistant", "content": text}
    counts = {"prompt_eval_count": 3, "eval_count": 4}
    return sends({"model": "qwen3", "message": message, "done": True, "done_reason": "stop", **counts})


def test_ollama_is_asked_once_and_only_where_it_was_named(ask, provider):
    provider.script(ollama("def gen_plan"))
    assert ask("ollama_chat/never-listed").text == "def gen_plan"
    provider.closing.wait(0.3)  # litellm goes on working in a thread
    assert [asked.path for asked in provider.asked] == ["/api/chat"]


@pytest.mark.parametrize("model", ["anthropic/claude-sonnet-4-5", "openrouter/anthropic/claude-sonnet-4.5"])
def test_a_mark_says_where_the_part_ends_that_can_be_cached(ask, provider, model):
    ask(model)
    sent = provider.asked[0].body["messages"]
    mark = {"type": "text", "text": "def gen_plan", "cache_control": {"type": "ephemeral"}}
    assert [message["content"] for message in sent if message["role"] == "assistant"] == [[mark]]
    assert str(provider.asked[0].body).count("cache_control") == 1


def test_without_examples_the_mark_is_on_the_system_message(ask, provider):
    ask("anthropic/claude-sonnet-4-5", messages=(STABLE[0], TASK))
    assert provider.asked[0].body["system"] == [
        {"type": "text", "text": STABLE[0].text, "cache_control": {"type": "ephemeral"}}
    ]
    assert "cache_control" not in str(provider.asked[0].body["messages"])


@pytest.mark.parametrize("model", ["openai/claude", "openrouter/qwen/qwen3", "mistral/tiny", "deepseek/tiny"])
def test_nobody_else_gets_marks(ask, provider, model):
    ask(model)
    assert [m["content"] for m in provider.asked[0].body["messages"]] == [m.text for m in (*STABLE, TASK)]


@pytest.mark.parametrize(
    ("model", "marks"),
    [
        ("bedrock/us.anthropic.claude-3-7-sonnet-20250219-v1:0", True),
        ("bedrock/anthropic.claude-3-5-sonnet-20240620-v1:0", False),
        ("bedrock/meta.llama3-70b-instruct-v1:0", False),
        ("vertex_ai/claude-sonnet-4-5", True),
        ("vertex_ai/gemini-2.5-pro", False),
    ],
)
def test_a_cloud_gets_marks_for_the_models_of_its_that_take_them(model, marks):
    assert takes_marks(load_litellm(), model) == marks


EVERYTHING = {"temperature": 0.0, "seed": 3, "n": 2, "max_tokens": 4000, "reasoning_effort": "low"}


@pytest.mark.parametrize(
    ("model", "dropped"),
    [
        ("openai/gpt-4o", {"reasoning_effort"}),
        ("openai/gpt-5", {"temperature"}),
        ("openai/o3", {"temperature"}),
        ("openai/gpt-5-pro", {"temperature", "seed", "n"}),
        ("openai/never-heard-of", set()),
        ("anthropic/claude-3-5-haiku-20241022", {"seed", "n", "reasoning_effort"}),
        ("anthropic/claude-sonnet-4-5", {"seed", "n", "temperature"}),
        ("anthropic/claude-opus-4-7", {"seed", "n", "temperature"}),
        ("gemini/gemini-2.5-pro", set()),
        ("gemini/gemini-2.0-flash", {"reasoning_effort"}),
        ("mistral/mistral-large-latest", {"n", "reasoning_effort"}),
        ("ollama_chat/qwen3", {"n"}),
        ("groq/llama-3.3-70b-versatile", {"reasoning_effort"}),
        ("groq/openai/gpt-oss-120b", set()),
        ("perplexity/sonar", {"seed", "n", "reasoning_effort"}),
    ],
)
def test_what_a_model_does_not_take_is_left_out_and_named(model, dropped):
    kept, named = split(load_litellm(), model, Sampling(**EVERYTHING))
    assert set(named) == dropped
    assert kept == {k: v for k, v in EVERYTHING.items() if k not in dropped}


def test_a_temperature_is_refused_by_claude_only_while_it_thinks():
    kept, dropped = split(load_litellm(), "anthropic/claude-sonnet-4-5", Sampling(temperature=0.0))
    assert (kept, dropped) == ({"temperature": 0.0}, ())


def test_one_candidate_is_nothing_to_ask_for():
    assert split(load_litellm(), "anthropic/claude-sonnet-4-5", Sampling(n=1)) == ({}, ())


@pytest.mark.parametrize(
    ("model", "dropped", "sent"),
    [
        (
            "openai/gpt-5",
            ("temperature",),
            {"seed": 3, "n": 2, "max_completion_tokens": 4000, "reasoning_effort": "low"},
        ),
        (
            "mistral/mistral-large-latest",
            ("n", "reasoning_effort"),
            {"temperature": 0.0, "random_seed": 3, "max_tokens": 4000},
        ),
        (
            "anthropic/claude-sonnet-4-5",
            ("temperature", "seed", "n"),
            {"max_tokens": 4000, "thinking": {"type": "enabled", "budget_tokens": 1024}},
        ),
    ],
)
def test_what_is_not_named_as_dropped_is_what_goes_out(ask, provider, model, dropped, sent):
    assert ask(model, **EVERYTHING).dropped == dropped
    body = provider.asked[0].body
    assert {k: v for k, v in body.items() if k not in ("model", "messages", "system")} == sent


def test_prices_come_from_the_list_and_unknown_ones_are_not_made_up(monkeypatch):
    for name in ("OPENAI_API_KEY", "GEMINI_API_KEY", "OPENROUTER_API_KEY"):
        monkeypatch.setenv(name, KEY)
    listed = load_litellm().model_cost["gpt-4o"]
    price = LiteLLM("openai/gpt-4o", Options()).price
    assert price == Price(
        prompt=1e6 * listed["input_cost_per_token"], completion=1e6 * listed["output_cost_per_token"]
    )
    assert load_litellm().model_cost["gemini/gemini-exp-1206"]["input_cost_per_token"] == 0
    assert LiteLLM("gemini/gemini-exp-1206", Options()).price is None
    assert LiteLLM("openai/never-heard-of", Options()).price is None
    assert LiteLLM("openrouter/never/heard", Options()).price is None
    assert LiteLLM("ollama/qwen3", Options()).price is None


def test_behind_a_server_of_ones_own_a_name_proves_no_price(ask, provider, monkeypatch):
    assert LiteLLM("openai/gpt-4o", Options(api_base=provider.address)).price is None
    assert ask("openai/gpt-4o").cost is None
    monkeypatch.setenv("OPENAI_BASE_URL", provider.address)
    llm = LiteLLM("openai/gpt-4o", Options())
    assert llm.price is None
    assert llm.complete(request()).cost is None
    assert len(provider.asked) == 2


def test_a_call_of_a_listed_model_has_a_cost_and_cached_tokens_are_cheaper(monkeypatch, provider):
    monkeypatch.setenv("AZURE_API_BASE", provider.root)
    monkeypatch.setenv("AZURE_API_KEY", KEY)
    llm = LiteLLM("azure/gpt-4o", Options(timeout=5))
    counted = {"prompt_tokens": 2000, "completion_tokens": 100, "total_tokens": 2100}
    cached = {**counted, "prompt_tokens_details": {"cached_tokens": 1500}}
    provider.script(says("x", usage=counted), says("x", usage=cached), says("x", usage=None))
    plain, cheaper, unknown = (llm.complete(request()) for _ in range(3))
    assert plain.cost == pytest.approx((2000 * llm.price.prompt + 100 * llm.price.completion) / 1e6)
    assert 0 < cheaper.cost < plain.cost
    assert unknown.cost is None
    assert provider.asked[0].headers["api-key"] == KEY


def test_a_cost_that_cannot_be_worked_out_does_not_cost_the_answer(monkeypatch, provider):
    def broken(*_):
        raise KeyError("input_cost_per_token")

    monkeypatch.setattr(prices, "cost", broken)
    monkeypatch.setenv("AZURE_API_BASE", provider.root)
    monkeypatch.setenv("AZURE_API_KEY", KEY)
    assert LiteLLM("azure/gpt-4o", Options()).complete(request()).cost is None


@pytest.mark.parametrize(
    ("model", "variable"), [("openai/tiny", "OPENAI_API_KEY"), ("anthropic/claude-x", "ANTHROPIC_API_KEY")]
)
def test_the_key_goes_to_the_server_and_nowhere_else(monkeypatch, provider, fault_of, ask, model, variable):
    monkeypatch.setenv(variable, f"{KEY}\n")
    echo = f"no such key: {KEY} (Bearer {KEY})"
    error = fault_of(refuses(401, echo), model)
    assert provider.keys == [KEY]
    assert str(error).count("***") == 2
    assert KEY not in "".join(traceback.format_exception(error))
    assert KEY not in repr(error)
    provider.script(says(f"your key is {KEY}"))
    completion = ask(model)
    assert completion.text == "your key is ***"
    assert KEY not in completion.model_dump_json()


def test_long_words_are_cut_after_300_characters_and_never_amid_a_key(monkeypatch, fault_of):
    monkeypatch.setenv("OPENAI_API_KEY", KEY)
    said = str(fault_of(refuses(400, f"{'x' * 295}{KEY}{'y' * 500}"))).partition("HTTP 400: ")[2]
    assert said == f"{'x' * 295}***y…)"


def test_other_secrets_of_the_environment_are_hidden_too(monkeypatch, fault_of):
    monkeypatch.setenv("MY_DATABASE_PASSWORD", "correct-horse")
    assert "correct-horse" not in str(fault_of(refuses(500, "cannot log in with correct-horse")))


@pytest.mark.parametrize("model", ["openai/tiny", "lm_studio/tiny", "mistral/tiny", "anthropic/claude-x"])
def test_a_server_without_a_key_gets_a_dummy(monkeypatch, provider, ask, model):
    monkeypatch.setenv("GROQ_API_KEY", KEY)
    ask(model)
    assert provider.keys == ["none"]


def test_a_server_that_wants_a_key_after_all(fault_of):
    error = fault_of(refuses(401, "key needed"))
    assert "asks for a key" in str(error)
    assert "set OPENAI_API_KEY" in str(error)


def test_several_threads_may_ask_at_once(provider):
    llm = LiteLLM("openai/tiny", Options(api_base=provider.address, timeout=10))
    together = threading.Barrier(8)

    def ask(number):
        together.wait(10)
        return llm.complete(request((Message(role="user", kind="task", text=f"task {number}"),), n=2))

    provider.script(*[says("plan", after=0.2)] * 8)
    with ThreadPoolExecutor(8) as pool:
        answers = list(pool.map(ask, range(8)))
    assert [len(answer.candidates) for answer in answers] == [2] * 8
    assert {asked.body["messages"][0]["content"] for asked in provider.asked} == {
        f"task {k}" for k in range(8)
    }


FRESH = """
import logging, os, socket, sys
from concurrent.futures import ThreadPoolExecutor

logging.basicConfig(level=logging.DEBUG, filename=os.devnull)
hosts, resolve = set(), socket.getaddrinfo
def watched(host, *args, **kwargs):
    hosts.add(host)
    return resolve(host, *args, **kwargs)
socket.getaddrinfo = watched

from proc3s import LLMError, Message, Request
from proc3s_litellm.backend import LiteLLM, Options

message = Message(role="user", kind="task", text="Draw a star.")
request = Request(messages=(message,), task="d/t", method="m", template="m", seed=0)
openai, anthropic = sys.argv[1:]
llms = [LiteLLM("openai/tiny", Options(api_base=openai)), LiteLLM("anthropic/x", Options(api_base=anthropic))]
with ThreadPoolExecutor(4) as pool:
    answers = list(pool.map(lambda llm: llm.complete(request).text, llms * 4))
assert answers == ["an answer"] * 8, answers
for expected in sys.stdin.read().split():
    try:
        llms[0].complete(request)
    except LLMError as error:
        assert error.fault == expected, error
assert "litellm" in sys.modules
assert hosts == {"127.0.0.1"}, hosts
assert "PLANTED_BY_DOTENV" not in os.environ
"""


@pytest.mark.slow
def test_a_fresh_process_stays_silent_at_home_and_ends_at_once(tmp_path: Path):
    """Several threads import litellm at the same time, with logging asked for and a `.env` at hand."""
    (tmp_path / ".env").write_text("PLANTED_BY_DOTENV=1\n")
    clean = {k: v for k, v in os.environ.items() if not k.startswith("LITELLM_")}
    faults = [sends({"choices": "abc"}), sends(HTML), refuses(500, "fell over")]
    with running() as server:
        server.script(*[says("an answer")] * 8, *faults)
        done = subprocess.run(
            [sys.executable, "-c", FRESH, server.address, server.root],
            input="broken broken server",
            env={**clean, "LITELLM_LOG": "DEBUG", "LITELLM_MODE": "DEV", "OPENAI_API_KEY": KEY},
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=120,
        )
        assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
        assert len(server.asked) == 8 + len(faults)
    assert [path.name for path in tmp_path.iterdir()] == [".env"]


@pytest.mark.slow
def test_no_process_is_started_to_learn_what_machine_this_is():
    code = """
import subprocess
from proc3s_litellm.loading import load_litellm
load_litellm()
def refuse(*args, **options): raise AssertionError(f"a process is started: {args}")
subprocess.Popen.__init__ = refuse
import platform
platform.platform()
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
