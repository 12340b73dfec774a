"""`proc3s doctor --ask`: one question tests key, model, options and price."""

import json

import pytest

from provider import refuses

SECRET = "sk-planted-7f3a9c51e2"
READY = {"texts": ["ready"], "usage": {"prompt_tokens": 20, "completion_tokens": 2}}


@pytest.fixture
def doctor(cli):
    """What asking brings: the exit code, and the findings beyond those of every installation."""

    def run(*args):
        result = cli("doctor", "--ask", *args, "--json")
        return result.code, {f["subject"]: f for f in result.json}, result

    return run


def test_an_answer_its_parameters_and_an_unknown_price(doctor, script, asked):
    code, found, _ = doctor(*script(READY), "-L", "max_tokens=50")
    assert code == 0
    assert "answered 'ready'" in found["question"]["text"]
    assert found["parameters"]["text"] == "temperature=0.0, seed=0, max_tokens=50 taken"
    assert (found["cost"]["level"], "20 + 2 tokens, cost unknown" in found["cost"]["text"]) == ("note", True)
    assert "-L prompt_price" in found["cost"]["advice"]
    (request,) = asked()
    assert request["sampling"]["max_tokens"] == 50


def test_a_declared_price(doctor, script):
    prices = ("-L", "prompt_price=10", "-L", "completion_price=100")
    _, found, _ = doctor(*script(READY), *prices)
    assert found["cost"] == {
        "level": "ok",
        "subject": "cost",
        "text": "1 call, 20 + 2 tokens, $0.0004",
        "advice": "",
    }


def test_a_parameter_that_is_refused_is_named_and_the_attempt_counted(doctor, script):
    refusal = {"fault": "parameter", "message": "no seed here", "parameters": ["seed"]}
    code, found, result = doctor(*script(refusal, READY))
    assert code == 0
    texts = [f["text"] for f in result.json]
    assert "talker-1 does not support seed: runs go without it" in texts
    assert any("no seed here" in text for text in texts)
    assert found["cost"]["text"].startswith("2 calls")


def test_what_a_model_says_cannot_paint_the_terminal(doctor, script):
    _, found, _ = doctor(*script({"texts": ["\x1b[31mready" + "y" * 500]}))
    assert "\x1b" not in found["question"]["text"]
    assert len(found["question"]["text"]) < 120


@pytest.mark.parametrize(
    ("entry", "options", "code", "words"),
    [
        ({"fault": "auth", "message": "the key is refused; check TALKER_KEY"}, (), 3, "check TALKER_KEY"),
        ({"fault": "unknown_model", "message": "there is no such model"}, (), 3, "no such model"),
        (READY, ("--max-tokens", 1), 1, "--max-tokens"),
        (READY, ("--max-cost", 1), 2, "--max-cost cannot be kept"),
    ],
)
def test_what_is_wrong_is_a_finding_and_an_exit_code(doctor, script, entry, options, code, words):
    ended, found, _ = doctor(*script(entry), *options)
    assert (ended, found["question"]["level"]) == (code, "error")
    assert words in found["question"]["text"]


@pytest.mark.parametrize("llm", ["replay", "manual:desk", "stub"])
def test_where_nobody_is_to_be_asked(doctor, stub, here, llm):
    code, found, _ = doctor("--llm", stub("ready") if llm == "stub" else llm)
    assert (code, found["question"]["level"]) == (2, "error")
    assert "was not asked" in found["question"]["text"]
    assert "--llm PROVIDER/MODEL" in found["question"]["advice"]
    assert not (here / "desk").exists()


def test_an_llm_that_cannot_be_opened_is_reported_once(doctor, monkeypatch):
    monkeypatch.delenv("OPENAI_API_KEY", raising=False)
    code, found, _ = doctor("--llm", "openai/gpt-5")
    assert (code, "needs a key" in found["llm"]["text"]) == (3, True)
    assert "question" not in found
    code, found, _ = doctor("--llm", "nonsense")
    assert (code, "question" in found) == (2, False)


@pytest.mark.parametrize("option", ["--max-cost", "--max-tokens", "--max-calls"])
def test_a_budget_is_for_asking(cli, option):
    result = cli("doctor", option, 1)
    assert (result.code, f"{option} goes with --ask" in result.stderr) == (2, True)


def test_for_people(cli, script):
    result = cli("doctor", "--ask", *script(READY))
    assert "ok     question: " in result.stdout
    assert "note   cost: 1 call" in result.stdout


@pytest.mark.slow
@pytest.mark.xdist_group("litellm")
def test_a_server_and_a_key_that_it_refuses(doctor, provider, monkeypatch):
    monkeypatch.setenv("OPENAI_API_KEY", SECRET)
    provider.text = f"ready {SECRET}"
    llm = ("--llm", "openai/tiny", "-L", f"api_base={provider.address}")
    code, found, result = doctor(*llm)
    assert code == 0, result.stdout
    assert found["cost"]["text"] == "1 call, 11 + 22 tokens, cost unknown"
    assert SECRET not in result.stdout + result.stderr
    assert provider.keys == [SECRET]
    assert len(json.dumps(provider.asked[0].body["messages"])) < 300

    provider.script(refuses(401, f"Incorrect API key provided: {SECRET}"))
    code, found, result = doctor(*llm)
    assert (code, found["question"]["level"]) == (3, "error")
    assert "check OPENAI_API_KEY" in found["question"]["text"]
    assert SECRET not in result.stdout + result.stderr


@pytest.mark.slow
@pytest.mark.xdist_group("litellm")
def test_a_model_with_a_listed_price(doctor, provider, monkeypatch):
    """Anthropic's protocol at an address of our own: the price is that of the list where it is declared."""
    monkeypatch.setenv("ANTHROPIC_API_KEY", SECRET)
    provider.text = "ready"
    llm = ("--llm", "anthropic/claude-sonnet-4-5", "-L", f"api_base={provider.root}")
    code, _, result = doctor(*llm, "-L", "prompt_price=3", "-L", "completion_price=15", "--max-cost", "0.1")
    texts = [f["text"] for f in result.json]
    assert code == 0
    assert "1 call, 11 + 22 tokens, $0.00036" in texts
    assert any("does not support seed" in text for text in texts)
