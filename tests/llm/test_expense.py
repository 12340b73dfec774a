"""The most that a run may cost is said before the first call, and is never exceeded."""

import json

import pytest

from proc3s.llm.budget import Budget
from proc3s.planning.expense import Bound, in_words

MODEL = """
import threading
import time
from pathlib import Path

from proc3s import LLM, LLMSpec, answer, hookimpl

AT_ONCE = threading.Lock()


class Counting(LLM):
    def __init__(self, model, options):
        self.running = 0

    def complete(self, request):
        with AT_ONCE:
            self.running += 1
            with Path("calls").open("a") as file:
                file.write(f"{self.running}\\\\n")
        time.sleep(float(Path("slow").read_text()) if Path("slow").exists() else 0)
        with AT_ONCE:
            self.running -= 1
        return answer("no program", "counting")


@hookimpl
def register_llms(register):
    target = "counting_llm:Counting"
    register(LLMSpec(name="counting", summary="Notes its calls.", usage="counting", target=target))
""".replace("\\\\n", "\\n")


@pytest.fixture
def counting(here):
    (here / "counting_llm.py").write_text(MODEL)
    return ("--llm", "counting", "--plugin", "counting_llm.py")


def calls(here):
    """For every call how many were in flight with it."""
    return [int(line) for line in (here / "calls").read_text().split()]


def test_the_most_calls_are_said_and_can_be_needed(cli, here, counting):
    result = cli("run", "drawing/star", *counting)
    said = result.stderr.splitlines()[0]
    assert said.startswith("counting: at most 18 calls, tokens and cost without a limit")
    assert len(calls(here)) == 18


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (["--feedback", 0], "at most 1 call,"),
        (["--feedback", 1, "--preset", "paper"], "at most 2 calls,"),
        (["--max-calls", 3], "at most 3 calls (--max-calls)"),
        (["--feedback", 0, "--candidates", 3], "at most 3 calls,"),
        (["--feedback", 0, "-L", "max_tokens=1000"], "tokens, at an unknown price"),
    ],
)
def test_what_bounds_the_calls_is_taken_in(cli, counting, args, words):
    assert words in cli("run", "drawing/star", *counting, *args).stderr.splitlines()[0]


def test_a_price_makes_dollars(cli, here, counting):
    """Authors of budgets want a number: 1000 tokens at 1 $ each are 1000 $, and the prompt comes on top."""
    price = ("-L", "prompt_price=1000000", "-L", "completion_price=1000000", "-L", "max_tokens=1000")
    said = cli("run", "drawing/star", *counting, *price, "--feedback", 0).stderr.splitlines()[0]
    tokens = int(said.split("about ")[1].split(" ")[0].replace(",", ""))
    assert f"about ${tokens}.00" in said
    prompt = cli("render-prompt", "drawing/star", "--format", "json").stdout
    assert tokens == pytest.approx(1000 + len(json.dumps(json.loads(prompt))) / 4, rel=0.15)


def test_a_limit_in_dollars_is_the_bound_where_it_is_lower():
    assert "$2 (--max-cost)" in in_words(Bound(18, 9000, 3.0), Budget(max_cost=2))
    assert "about $1.00" in in_words(Bound(18, 9000, 1.0), Budget(max_cost=2))
    assert "$2 (--max-cost)" in in_words(Bound(18, None, None), Budget(max_cost=2))


def test_answers_that_cost_nothing_are_not_announced(cli):
    assert "at most" not in cli("run", "drawing/star").stderr


@pytest.mark.slow
def test_a_suite_says_it_before_its_first_episode(cli, here, counting):
    suite = {"name": "m", "summary": "m", "tasks": ["drawing/star"], "methods": ["proc3s", "cap"]}
    (here / "mine.yaml").write_text(json.dumps({**suite, "seeds": 2, "feedback": 0}))
    said = cli("bench", "mine.yaml", *counting).stderr.splitlines()
    assert said[0].startswith("proc3s: counting for 4 episodes: at most 4 calls")
    assert len(calls(here)) == 4


def test_all_candidates_are_asked_for_at_once(cli, here, counting):
    """The first call may bring them all; what it does not bring is asked for together."""
    (here / "slow").write_text("0.3")
    cli("run", "drawing/star", *counting, "--feedback", 0, "--candidates", 4)
    assert (len(calls(here)), max(calls(here))) == (4, 3)
    (here / "calls").unlink()
    cli("run", "drawing/star", *counting, "--feedback", 0, "--candidates", 4, "--llm-jobs", 1)
    assert (len(calls(here)), max(calls(here))) == (4, 1)
