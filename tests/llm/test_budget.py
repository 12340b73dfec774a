"""What may be spent, from the command line."""

import json


def priced(text, prompt=1000, completion=500, **more):
    return {"texts": [text], "usage": {"prompt_tokens": prompt, "completion_tokens": completion}, **more}


def test_calls_are_counted_before_they_are_made(cli, script, texts, asked):
    args = script(texts.outside, texts.outside, texts.star)
    result = cli("run", "drawing/star", *args, "--samples", 20, "--max-calls", 2, "--json")
    assert (result.code, result.json["solved"], len(asked())) == (1, False, 2)
    assert result.json["error"].startswith("budget: 2 of 2 calls are spent")
    assert "--max-calls" in result.json["error"]


def test_a_failed_call_is_a_call(cli, script, texts, asked):
    fault = {"fault": "server", "message": "no", "retry_after": 0.01}
    result = cli("run", "drawing/star", *script(fault, texts.star), "--max-calls", 1, "--json")
    assert (result.code, len(asked())) == (1, 1)


def test_tokens(cli, script, texts, asked):
    args = script(priced(texts.outside, 9000, 900), texts.star)
    result = cli("run", "drawing/star", *args, "--samples", 20, "--max-tokens", 10_000, "--json")
    assert (result.code, len(asked())) == (1, 1)
    assert result.json["error"].startswith("budget: 9,900 of 10,000 tokens")
    assert result.json["usage"]["prompt_tokens"] == 9000


def test_a_prompt_that_is_longer_than_the_budget_is_not_sent(cli, script, texts, asked):
    result = cli("run", "drawing/star", *script(texts.star), "--max-tokens", 100, "--json")
    assert (result.code, asked()) == (1, [])


def test_tokens_that_nobody_counted_are_estimated(cli, script, texts, asked):
    """A provider that counts nothing does not make the budget endless."""
    args = script(*[texts.outside] * 6)
    result = cli("run", "drawing/star", *args, "--samples", 20, "--max-tokens", 5000, "--json")
    assert result.code == 1
    assert 0 < len(asked()) < 6
    assert result.json["usage"]["prompt_tokens"] is None
    assert result.json["usage"]["cost"] is None


def test_money(cli, script, texts, asked):
    args = script(priced(texts.outside, cost=0.02), priced(texts.outside, cost=0.02), texts.star)
    price = ("-L", "prompt_price=10", "-L", "completion_price=20")
    # What is declared counts: 1,000 tokens at 10 dollars and 500 at 20 dollars a million are 2 cents.
    result = cli("run", "drawing/star", *args, *price, "--samples", 20, "--max-cost", 0.045, "--json")
    assert (result.code, len(asked())) == (1, 2)
    assert result.json["usage"]["cost"] == 0.04
    assert "US dollars" in result.json["error"]


def test_a_price_that_the_backend_knows(cli, script, texts, asked, here):
    (here / "script.price").write_text(json.dumps({"prompt": 10, "completion": 20}))
    args = script(priced(texts.outside), texts.star)
    result = cli("run", "drawing/star", *args, "--samples", 20, "--max-cost", 0.03, "--json")
    assert (result.code, len(asked())) == (1, 1)


def test_a_cost_limit_without_a_price_is_refused(cli, script, texts, asked, here):
    result = cli("run", "drawing/star", *script(texts.star), "--max-cost", 1, "--out", "r", "--json")
    assert (result.code, asked()) == (2, [])
    assert "prompt_price" in result.json["error"]
    assert not (here / "r").exists()


def test_half_a_price_is_none(cli, script, texts):
    args = script(texts.star)
    assert cli("run", "drawing/star", *args, "--max-cost", 1, "-L", "prompt_price=1").code == 2


def test_the_plan_that_came_furthest_is_kept(cli, script, texts, here):
    args = script(texts.outside, texts.hopeless, texts.star)
    result = cli("run", "drawing/star", *args, "--samples", 20, "--max-calls", 2, "--out", "r", "--json")
    nearest = result.json["nearest"]
    assert (nearest["round"], nearest["reached"], len(nearest["plan"])) == (0, 1, 2)
    assert nearest["violations"][0]["step"] == 1
    assert json.loads((here / "r/summary.json").read_text())["nearest"] == nearest


def test_a_method_with_a_fallback_executes_it(cli, script, asked):
    plan = '```python\ngen_plan = [Action("draw_line", [-1, 1, 2, 1])]\n```'
    result = cli("run", "drawing/star", *script(plan, plan), "--method", "llm3", "--max-calls", 1, "--json")
    assert (result.code, result.json["executed"], len(asked())) == (1, "fallback", 1)
    assert result.json["error"].startswith("budget:")


def test_answers_that_cost_nothing_need_no_budget(cli):
    result = cli("run", "drawing/star", "--max-cost", 0.01, "--max-calls", 1, "--max-tokens", 1, "--json")
    assert (result.code, result.json["usage"]["calls"]) == (0, 0)


def test_a_limit_of_nothing_is_a_mistake(cli):
    assert cli("run", "drawing/star", "--max-cost", 0).code == 2
    assert cli("run", "drawing/star", "--max-cost", -1).code == 2


def test_the_summary_says_what_was_spent(cli, script, texts):
    args = script(priced(texts.outside, cost=0.5), priced(texts.star, cost=0.25))
    result = cli("run", "drawing/star", *args, "--samples", 60, "--json")
    usage = result.json["usage"]
    assert (usage["calls"], usage["prompt_tokens"], usage["completion_tokens"]) == (2, 2000, 1000)
    assert usage["cost"] == 0.75
    assert usage["latency"] > 0


def test_a_call_that_cost_more_than_was_left_is_said(cli, script, texts):
    args = script(priced(texts.star, 90_000, 10_000))
    result = cli("run", "drawing/star", *args, "--max-tokens", 50_000)
    assert result.code == 0  # what is paid for is used
    assert "budget: 100,000 tokens are spent, more than --max-tokens 50,000" in result.stderr


def test_what_ended_a_run_is_a_word(cli, script, texts):
    args = script(texts.outside, texts.star)
    result = cli("run", "drawing/star", *args, "--samples", 20, "--max-calls", 1, "--json")
    assert result.json["stopped"] == "budget"


def test_unknown_usage_is_not_forgotten(cli, script, texts, asked):
    """What was estimated before a resume counts after it too."""
    args = script(texts.outside, texts.outside, texts.star)
    price = ("-L", "prompt_price=10", "-L", "completion_price=10")
    flags = ("--samples", 20, "--max-cost", 0.02, "--out", "r")
    assert cli("run", "drawing/star", *args, *price, *flags).code == 1
    calls = len(asked())
    again = cli("run", "--resume", "r", "--json")
    assert (again.json["stopped"], len(asked())) == ("budget", calls)


def test_refused_connections_cost_nothing(cli, script, texts, asked):
    fault = {"fault": "connection", "message": "no", "retry_after": 0.01}
    args = script(fault, fault, fault, texts.star)
    assert cli("run", "drawing/star", *args, "--max-tokens", 3000).code == 0
    assert len(asked()) == 4
