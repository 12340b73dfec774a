"""Suites against a real server on this machine: failures in passing, what they cost, where keys go."""

import pytest

from proc3s.suites.store import FILE, Store
from provider import refuses

# The import of litellm takes seconds, in every process anew.
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("litellm")]

SUITE = "name: mine\nsummary: Mine.\ntasks: [drawing/star]\nmethods: [proc3s]\nseeds: 2\n"
SECRET = "sk-planted-7f3a9c51e2"


@pytest.fixture
def args(provider, monkeypatch, here, answers_of_star):
    """A suite that asks the server, at a price: an answer costs 0.022 dollars, its prompt 0.011."""
    monkeypatch.setenv("OPENAI_API_KEY", SECRET)
    (here / "mine.yaml").write_text(SUITE)
    provider.text = answers_of_star
    price = ("-L", "prompt_price=1000", "-L", "completion_price=1000")
    return ("bench", "mine.yaml", "--llm", "openai/tiny", "-L", f"api_base={provider.address}", *price)


def test_a_provider_that_fails_leaves_episodes_to_go_on_with(args, cli, provider, here):
    provider.script(*[refuses(401, "no such key")] * 2)
    failed = cli(*args, "--out", "out")
    assert failed.code == 3, failed.stderr
    assert "2 episodes are not finished; go on with --resume out" in failed.stderr
    assert Store(here / "out").episodes() == []
    done = cli(*args, "--resume", "out", "--json")
    assert done.code == 0, done.stderr
    episodes = done.json["episodes"]
    assert [(e["source"], e["model"], e["goal_reached"]) for e in episodes] == [
        ("live", "tiny-2026", True)
    ] * 2
    assert [(e["prompt_tokens"], e["completion_tokens"]) for e in episodes] == [(11, 22)] * 2
    assert [e["cost"] for e in episodes] == pytest.approx([0.033] * 2)
    assert all(e["answered"] for e in episodes)
    assert done.json["tables"][0]["lines"][0][1].startswith("**100 [")
    for path in (here / "out").rglob("*"):
        if path.is_file():
            assert SECRET.encode() not in path.read_bytes(), path


def test_no_episode_begins_when_the_money_is_spent(args, cli, provider, here):
    spent = cli(*args, "--max-cost", 0.034, "--out", "out")
    assert spent.code == 1, spent.stderr
    assert "go on with --resume out" in spent.stderr
    asked = len(provider.asked)
    assert asked <= 1
    assert cli(*args, "--max-cost", 20, "--resume", "out").code == 0
    assert len(Store(here / "out").episodes()) == 2
    assert (here / "out" / FILE).is_file()
