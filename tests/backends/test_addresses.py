"""Addresses of servers that are none, or not the one that is meant: found before any call."""

import json
import os
import time

import pytest

from proc3s_litellm.addresses import corrected
from provider import DRIPS, HANGS, MODEL, sends


@pytest.fixture(autouse=True)
def _clean_environment(monkeypatch):
    for name in [n for n in os.environ if n.endswith(("_KEY", "_TOKEN", "_API_BASE", "_BASE_URL"))]:
        monkeypatch.delenv(name)


WRONG = [
    ("http://local host:11434/v1", "space"),
    ("http://localhost:11434/v1 ", "space"),
    ("http://localhost\t/v1", "character"),
    ("http://localhost:99999/v1", "65535"),
    ("http://localhost:-1/v1", "port"),
    ("http://localhost:port/v1", "port"),
    ("http://localhost:0/v1", "port"),
    ("http://[::1/v1", "such as"),
    ("localhost:11434/v1", "such as"),
    ("http://", "such as"),
    ("v1", "such as"),
]


@pytest.mark.parametrize(("address", "word"), WRONG)
def test_an_option_that_is_no_address(cli, here, address, word):
    args = ("--llm", "openai/tiny", "-L", f"api_base={address}", "--out", "r", "--json")
    result = cli("run", "drawing/star", *args)
    assert (result.code, "api_base" in result.json["error"], word in result.json["error"]) == (2, True, True)
    assert not (here / "r").exists()


@pytest.mark.parametrize(("address", "word"), WRONG)
@pytest.mark.parametrize(
    ("variable", "model"),
    [
        ("OPENAI_API_BASE", "openai/tiny"),
        ("OPENAI_BASE_URL", "openai/tiny"),
        ("OLLAMA_API_BASE", "ollama_chat/tiny"),
        ("ANTHROPIC_API_BASE", "anthropic/tiny"),
        ("AZURE_API_BASE", "azure/tiny"),
    ],
)
def test_a_variable_that_is_no_address_is_named(monkeypatch, address, word, variable, model):
    from proc3s import UsageError
    from proc3s_litellm.backend import LiteLLM, Options

    monkeypatch.setenv("ANTHROPIC_API_KEY", "sk-0123456789")
    monkeypatch.setenv(variable, address)
    with pytest.raises(UsageError, match=variable) as caught:
        LiteLLM(model, Options())
    assert word in str(caught.value)


def test_a_variable_is_a_usage_error_of_a_run_and_of_the_doctor(cli, here, monkeypatch):
    monkeypatch.setenv("OPENAI_API_BASE", "localhost:11434")
    result = cli("run", "drawing/star", "--llm", "openai/tiny", "--out", "r", "--json")
    assert (result.code, "OPENAI_API_BASE" in result.json["error"]) == (2, True)
    assert not (here / "r").exists()
    found = cli("doctor", "--llm", "openai/tiny", "--json")
    assert found.code == 2
    assert any(f["level"] == "error" and "OPENAI_API_BASE" in f["text"] for f in found.json)


def test_an_option_goes_before_a_variable_that_is_wrong(monkeypatch, provider):
    from proc3s_litellm.backend import LiteLLM, Options

    monkeypatch.setenv("OPENAI_API_BASE", "localhost:11434")
    LiteLLM("openai/tiny", Options(api_base=provider.address))


@pytest.mark.parametrize(
    ("provider_", "address", "meant"),
    [
        ("openai", "http://h:1", "http://h:1/v1"),
        ("openai", "http://h:1/", "http://h:1/v1"),
        ("openai", "http://h:1/v1/chat/completions", "http://h:1/v1"),
        ("openai", "http://h:1/v1/models/", "http://h:1/v1"),
        ("openai", "http://h:1/chat/completions", "http://h:1/v1"),
        ("openai", "http://h:1/v1", None),
        ("openai", "http://h:1/v1/", None),
        ("openai", "http://h:1/openai/v3", None),
        ("lm_studio", "http://h:1", "http://h:1/v1"),
        ("groq", "http://h:1", None),
        ("ollama_chat", "http://h:1", None),
        ("ollama_chat", "http://h:1/v1", "http://h:1"),
        ("ollama", "http://h:1/api/chat", "http://h:1"),
        ("anthropic", "http://h:1/v1/messages", "http://h:1"),
    ],
)
def test_the_address_that_is_meant(provider_, address, meant):
    assert corrected(address, provider_) == meant


@pytest.fixture
def doctor(cli):
    """Findings on the server behind an address."""

    def examine(address, model="openai/tiny"):
        result = cli("doctor", "--llm", model, "-L", f"api_base={address}", "--json")
        return result.code, [f for f in result.json if f["subject"] == "server"]

    return examine


@pytest.mark.parametrize("path", ["", "/v1/chat/completions", "/chat/completions"])
def test_the_doctor_finds_the_right_address(doctor, provider, path):
    provider.under = "/v1/models"
    code, (found,) = doctor(f"{provider.root}{path}")
    assert (code, found["level"]) == (2, "error")
    assert f"-L api_base={provider.address}" in found["advice"]


def test_the_doctor_finds_the_root_of_ollama(doctor, provider):
    provider.under = "/api/tags"
    provider.listing = sends({"models": [{"name": "tiny:latest"}]})
    code, (found,) = doctor(provider.address, "ollama_chat/tiny")
    assert (code, f"api_base={provider.root}" in found["advice"]) == (2, True)
    assert doctor(provider.root, "ollama_chat/tiny")[1][0]["level"] == "ok"


def test_an_address_of_a_request_is_never_fine(doctor, provider):
    """Even where every path has a list of models, or none has one."""
    address = f"{provider.address}/chat/completions"
    assert doctor(address)[1][0]["level"] == "error"
    provider.listing = sends("<html>a page</html>")
    assert doctor(address)[1][0]["level"] == "error"
    assert doctor(provider.address)[1][0]["level"] == "ok"


@pytest.mark.parametrize(
    "entry",
    [
        {"id": "tiny", "max_model_len": 4096},
        {"id": "tiny", "meta": {"n_ctx": 4096, "n_ctx_train": 32768}},
        {"id": "tiny", "max_context_length": 32768, "loaded_context_length": 4096},
    ],
    ids=json.dumps,
)
def test_a_short_context_is_said(doctor, provider, entry):
    provider.listing = sends({"data": [{"id": "other", "max_model_len": 10}, entry]})
    _, (server, context) = doctor(provider.address)
    assert (server["level"], context["level"]) == ("ok", "note")
    assert "tiny takes 4,096 tokens" in context["text"]


def test_a_long_context_is_nothing_to_say(doctor, provider):
    provider.listing = sends({"data": [{"id": "tiny", "max_model_len": 32768}]})
    assert len(doctor(provider.address)[1]) == 1


@pytest.mark.parametrize("listing", [*DRIPS, HANGS], ids=lambda reply: reply.does)
def test_the_doctor_does_not_wait_for_ever(doctor, provider, listing, monkeypatch):
    monkeypatch.setattr("proc3s_litellm.servers._SECONDS", 0.3)
    provider.listing = listing
    begun = time.monotonic()
    code, (found, *_) = doctor(provider.address)
    assert (code, found["level"]) == (2, "error")
    assert "0.3 s" in found["text"] or "timed out" in found["text"]
    assert time.monotonic() - begun < 5


@pytest.mark.parametrize("body", [b"[" * 100_000, b"\xff\xfe", b'{"data": 3}', b"null", MODEL.encode()])
def test_a_strange_list_of_models_is_none(doctor, provider, body):
    provider.listing = sends(body)
    assert doctor(provider.address)[1][0]["level"] == "ok"
