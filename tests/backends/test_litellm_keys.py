"""Keys and checks: everything that is known before litellm is imported."""

import os
import subprocess
import sys
from importlib import metadata

import pytest

from proc3s import LLMError
from proc3s.errors import SpecError
from proc3s.specs.yaml_files import validate
from proc3s_litellm.backend import LiteLLM, Options
from proc3s_litellm.checks import check
from proc3s_litellm.keys import find_key, hide_secrets
from proc3s_litellm.providers import PROVIDERS, server_of
from provider import sends

KEY = "sk-planted-0123456789"


@pytest.fixture(autouse=True)
def _no_keys(monkeypatch):
    """No key of this machine is looked at."""
    for name in [n for n in os.environ if n.endswith(("_KEY", "_TOKEN", "_API_BASE", "_BASE_URL"))]:
        monkeypatch.delenv(name)


def findings(model=None, options=None):
    return list(check(model, options))


def test_neither_backend_nor_checks_import_litellm_or_open_a_socket():
    code = """
import socket, sys
def refuse(*_): raise AssertionError("a socket is opened")
socket.socket.connect = refuse
from proc3s_litellm import SPEC
from proc3s import LLMError
from proc3s.specs.base import Target
from proc3s_litellm.backend import LiteLLM, Options
check = Target(target=SPEC.check).load()
for model in (None, "openai/gpt-4o", "bedrock/x"):
    assert list(check(model, Options()))
try:
    LiteLLM("openai/gpt-4o", Options())
except LLMError as error:
    assert error.fault == "missing_key"
else:
    raise AssertionError("a key is found")
assert not {"litellm", "openai", "httpx"} & set(sys.modules), "imported"
"""
    clean = {k: v for k, v in os.environ.items() if not k.endswith("_KEY")}
    done = subprocess.run([sys.executable, "-c", code], env=clean, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("name", sorted(n for n, p in PROVIDERS.items() if not p.local))
def test_a_missing_key_is_named_before_any_call(name):
    with pytest.raises(LLMError, match=PROVIDERS[name].keys[0]) as caught:
        LiteLLM(f"{name}/some-model", Options())
    assert caught.value.fault == "missing_key"


@pytest.mark.parametrize("empty", ["", "  \n"])
def test_an_empty_variable_is_no_key(monkeypatch, empty):
    monkeypatch.setenv("OPENAI_API_KEY", empty)
    with pytest.raises(LLMError, match="OPENAI_API_KEY"):
        LiteLLM("openai/gpt-4o", Options())


@pytest.mark.parametrize(
    ("provider", "variable"), [("together_ai", "TOGETHERAI_API_KEY"), ("groq", "GROQ_API_KEY")]
)
def test_a_key_is_found_and_never_shown(monkeypatch, provider, variable):
    monkeypatch.setenv(variable, f"{KEY}\n")
    llm = LiteLLM(f"{provider}/m", Options())
    assert find_key("m", provider, None).get_secret_value() == KEY
    assert KEY not in f"{llm!r} {vars(llm)!r}"


def test_a_key_that_cannot_travel_in_a_header_is_refused_without_being_shown(monkeypatch):
    monkeypatch.setenv("OPENAI_API_KEY", "sk-plänted-secret")
    with pytest.raises(LLMError) as caught:
        LiteLLM("openai/gpt-4o", Options())
    assert caught.value.fault == "auth"
    assert "OPENAI_API_KEY" in str(caught.value)
    assert "nted-secret" not in str(caught.value)


def test_another_way_to_sign_in_is_left_to_litellm(monkeypatch):
    monkeypatch.setenv("ANTHROPIC_AUTH_TOKEN", KEY)
    assert find_key("anthropic/m", "anthropic", None) is None


@pytest.mark.parametrize(
    "model", ["ollama/qwen3", "ollama_chat/qwen3", "llamafile/x", "bedrock/x", "vertex_ai/x"]
)
def test_local_servers_and_providers_with_tools_of_their_own_need_no_key(model):
    LiteLLM(model, Options())


@pytest.mark.parametrize("model", ["lm_studio/qwen3", "hosted_vllm/qwen3"])
def test_a_local_server_without_an_address_is_never_taken_for_openai(monkeypatch, model):
    with pytest.raises(LLMError, match="api_base"):
        LiteLLM(model, Options())
    monkeypatch.setenv(f"{model.partition('/')[0].upper()}_API_BASE", "http://127.0.0.1:1/v1")
    LiteLLM(model, Options())


@pytest.mark.parametrize("model", ["gpt-4o", "", "openai/", "/gpt-4o"])
def test_a_model_without_its_provider_is_refused(model):
    with pytest.raises(LLMError, match="PROVIDER/MODEL"):
        LiteLLM(model, Options())


@pytest.mark.parametrize(
    "address",
    [
        f"http://me:{KEY}@host/v1",
        f"http://{KEY}@host/v1",
        f"http://host/v1?api_key={KEY}",
        f"http://host/v1#{KEY}",
        "localhost:11434",
        "ftp://host/v1",
        "http:///v1",
    ],
)
def test_an_address_that_is_none_or_holds_a_secret_is_refused_without_being_repeated(address):
    with pytest.raises(SpecError, match="api_base") as caught:
        validate(Options, {"api_base": address}, "llm litellm")
    assert KEY not in str(caught.value)
    with pytest.raises(ValueError, match="api_base") as plain:
        Options(api_base=address)
    assert KEY not in str(plain.value)


@pytest.mark.parametrize("name", ["api_key", "headers"])
def test_an_unknown_option_is_refused_without_repeating_its_value(name):
    with pytest.raises(SpecError, match=name) as caught:
        validate(Options, {name: KEY}, "llm litellm")
    assert KEY not in str(caught.value)
    with pytest.raises(ValueError, match=name) as plain:
        Options(**{name: KEY})
    assert KEY not in str(plain.value)


def test_a_server_from_the_environment_is_shown_without_its_password(monkeypatch):
    assert server_of("openai", None) is None
    monkeypatch.setenv("OPENAI_BASE_URL", f"http://me:{KEY}@127.0.0.1:9/v1")
    assert server_of("openai", None) == "http://127.0.0.1:9/v1"
    assert server_of("openai", "http://mine/v1") == "http://mine/v1"


def test_whatever_the_environment_calls_a_secret_is_hidden(monkeypatch):
    monkeypatch.setenv("SOME_TOKEN", "token-0123456789")
    monkeypatch.setenv("SHORT_KEY", "star")
    monkeypatch.setenv("LONGER_KEY", f"{KEY}-and-more")
    monkeypatch.setenv("OPENAI_API_KEY", KEY)
    text = f"a star {KEY} and {KEY}-and-more and token-0123456789"
    assert hide_secrets(text, None) == "a star *** and *** and ***"


@pytest.mark.parametrize(
    ("version", "level", "said"),
    [
        ("1.106.2", "ok", "1.106.2"),
        ("1.109.14", "ok", "1.109.14"),
        ("1.82.7", "error", "malicious"),
        ("1.82.8", "error", "malicious"),
        ("1.106.1", "error", "1.106.1"),
        ("1.110.0", "error", "1.110.0"),
    ],
)
def test_the_installed_version_is_checked(monkeypatch, version, level, said):
    monkeypatch.setattr(metadata, "version", lambda _: version)
    found = findings()[0]
    assert (found.subject, found.level) == ("litellm", level)
    assert said in found.text
    assert bool(found.advice) == (level == "error")


def test_that_litellm_is_missing_is_an_error(monkeypatch):
    def missing(name):
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(metadata, "version", missing)
    assert findings()[0].level == "error"


def test_the_range_that_is_checked_is_the_one_that_is_required():
    (required,) = [line for line in metadata.requires("proc3s") if line.startswith("litellm")]
    assert all(part in required for part in (">=1.106.2", "<1.110", "!=1.82.7", "!=1.82.8"))


def test_which_keys_are_set_is_told_by_name_alone(monkeypatch):
    assert "none" in findings()[1].text
    monkeypatch.setenv("GROQ_API_KEY", KEY)
    monkeypatch.setenv("GEMINI_API_KEY", KEY)
    found = findings()[1]
    assert (found.level, found.text) == ("note", "set: GEMINI_API_KEY, GROQ_API_KEY")
    assert KEY not in str(findings("groq/x"))


@pytest.mark.parametrize(
    ("model", "variable", "level"),
    [
        ("openai/gpt-4o", "OPENAI_API_KEY", "ok"),
        ("openai/gpt-4o", "GROQ_API_KEY", "error"),
        ("bedrock/x", "GROQ_API_KEY", "note"),
        ("neverheardof/x", "GROQ_API_KEY", "note"),
    ],
)
def test_the_key_of_the_chosen_model_is_checked(monkeypatch, model, variable, level):
    monkeypatch.setenv(variable, KEY)
    found = findings(model, Options())
    assert [f.level for f in found if f.subject == model.partition("/")[0]] == [level]


def test_a_server_is_asked_whether_it_answers_and_gets_no_key(monkeypatch, provider):
    monkeypatch.setenv("OPENAI_API_KEY", KEY)
    found = findings("openai/tiny", Options(api_base=provider.address))[-1]
    assert (found.subject, found.level) == ("server", "ok")
    assert [(request.path, request.key) for request in provider.looked_up] == [("/v1/models", None)]
    assert provider.asked == []


@pytest.mark.parametrize("status", [302, 401, 404, 500])
def test_any_answer_shows_that_a_server_is_there(provider, status):
    provider.listing = sends({}, status, Location="http://127.0.0.1:1/")
    assert findings("openai/tiny", Options(api_base=provider.address))[-1].level == "ok"


def test_a_server_that_is_not_there_is_an_error():
    found = findings("ollama/qwen3", Options(api_base="http://127.0.0.1:1"))[-1]
    assert (found.subject, found.level) == ("server", "error")
    assert "refused" in found.text
    assert "ollama serve" in found.advice
