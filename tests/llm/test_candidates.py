"""Several programs for one question."""

import pytest

from proc3s import Message, Request, Sampling, answer
from proc3s.llm.call_options import CallOptions
from proc3s.llm.candidates import ask_all
from proc3s.llm.errors import LLMError
from proc3s.llm.types import LLM


def test_candidates_race_and_one_solves(cli, script, texts, asked, events, here):
    args = script([texts.hopeless, texts.outside, texts.star])
    result = cli("run", "drawing/star", *args, "--candidates", 3, "--out", "r", "--json")
    assert (result.code, len(asked())) == (0, 1)
    assert asked()[0]["sampling"]["n"] == 3
    (executed,) = events(here / "r", "plan_executed")
    assert (executed["round"], executed["candidate"]) == (0, 2)
    names = sorted(path.name for path in (here / "r").glob("program-*"))
    assert names == ["program-0.1.py", "program-0.2.py", "program-0.py"]


def test_candidates_that_are_missing_are_asked_for_one_by_one(cli, script, texts, asked):
    args = script([texts.hopeless], texts.outside, texts.star)
    result = cli("run", "drawing/star", *args, "--candidates", 3, "--out", "r", "--json")
    assert (result.code, result.json["usage"]["calls"]) == (0, 3)
    assert [request["candidate"] for request in asked()] == [0, 1, 2]
    assert len({request["sampling"]["seed"] for request in asked()}) == 3


def test_the_samples_are_divided(cli, script, texts, events, here):
    args = script([texts.hopeless, texts.outside])
    flags = ("--candidates", 2, "--samples", 100, "--feedback", 0, "--no-screens")
    result = cli("run", "drawing/star", *args, *flags, "--out", "r", "--json")
    assert (result.code, result.json["samples"]) == (1, 100)
    spent = {e["candidate"]: e["samples"] for e in events(here / "r", "attempt_ended")}
    assert spent == {0: 25, 1: 75}  # two heats of 50: one for both, one for the better


def test_feedback_is_about_the_best(cli, script, texts, asked, events, here):
    args = script([texts.hopeless, texts.outside], [texts.star, texts.star])
    flags = ("--candidates", 2, "--samples", 100)
    assert cli("run", "drawing/star", *args, *flags, "--out", "r").code == 0
    replies = [m["text"] for m in asked()[1]["messages"] if m["kind"] == "reply"]
    assert replies == [texts.outside]
    (ended,) = events(here / "r", "round_ended")
    assert ended["candidate"] == 1


def test_one_candidate_that_cannot_be_used_costs_nothing(cli, script, texts):
    result = cli("run", "drawing/star", *script(["no program", texts.star]), "--candidates", 2, "--json")
    assert (result.code, result.json["rounds"]) == (0, 0)


@pytest.mark.slow
def test_the_outcome_does_not_depend_on_processes(cli, script, texts, here):
    args = script([texts.outside, texts.star], [texts.outside, texts.star])
    flags = ("--candidates", 2, "--no-screens", "--json")
    alone = cli("run", "drawing/star", *args, *flags, "--jobs", 1).json
    together = cli("run", "drawing/star", *args, *flags, "--jobs", 2).json
    same = ("plan", "samples", "evaluations")
    assert [alone[key] for key in same] == [together[key] for key in same]


def test_candidates_come_back_from_a_run(cli, script, texts, asked):
    args = script([texts.hopeless], texts.outside, texts.star)
    live = cli("run", "drawing/star", *args, "--candidates", 3, "--out", "live", "--json")
    again = cli("run", "drawing/star", "--llm", "replay:live", "--candidates", 3, "--json")
    assert (again.code, again.json["plan"], len(asked())) == (0, live.json["plan"], 3)
    search = cli("replay", "live", "--json")
    assert (search.code, search.json["plan"]) == (0, live.json["plan"])


def test_literal_plans_are_checked_once_each(cli, script):
    plans = [f'```python\ngen_plan = [Action("draw_line", [{x}, 1, 2, 1])]\n```' for x in (-1, 1)]
    flags = ("--method", "llm3", "--candidates", 2, "--no-check-goal", "--json")
    result = cli("run", "drawing/star", *script(plans), *flags)
    assert (result.code, result.json["samples"]) == (0, 2)


class Counting(LLM):
    """Answers each candidate alone; those in `broken` fail."""

    def __init__(self, broken=()):
        self.broken = broken

    def complete(self, request):
        if request.candidate in self.broken:
            raise LLMError("no")
        return answer(str(request.candidate), "m")


def request(n):
    message = Message(role="user", kind="task", text="x")
    return Request(
        messages=(message,), task="a/b", method="m", template="t", seed=1, sampling=Sampling(n=n, seed=1)
    )


@pytest.mark.parametrize("jobs", [1, 3])
def test_every_candidate_comes_once_with_its_number(jobs):
    found = ask_all(Counting(), request(5), jobs, pytest.fail)
    assert sorted((number, completion.text) for number, completion in found) == list(enumerate("01234"))


def test_a_candidate_that_fails_is_missed_aloud():
    said = []
    found = ask_all(Counting(broken=[2]), request(4), 2, said.append)
    assert sorted((number, completion.text) for number, completion in found) == [(0, "0"), (1, "1"), (3, "3")]
    assert said == ["candidate 2 is missing: no"]


def test_the_first_answer_must_come():
    with pytest.raises(LLMError):
        list(ask_all(Counting(broken=[0]), request(4), 2, pytest.fail))


@pytest.mark.slow
def test_calls_in_flight(cli, script, texts, here):
    """With two jobs, candidates are waited for together."""
    slow = [{"texts": [texts.hopeless], "seconds": 0.4}] * 5
    flags = ("--candidates", 5, "--samples", 20, "--feedback", 0, "--json")
    alone = cli("run", "drawing/star", *script(*slow), *flags, "--llm-jobs", 1).json["seconds"]["llm"]
    (here / "script.asked").unlink()
    together = cli("run", "drawing/star", *script(*slow), *flags, "--llm-jobs", 4).json["seconds"]["llm"]
    assert alone > 2.0
    assert together < 1.5


@pytest.mark.parametrize(("given", "wanted"), [({}, (0.0, 0.7)), ({"temperature": 0.2}, (0.2, 0.2))])
def test_several_candidates_vary(given, wanted):
    options = CallOptions(**given)
    assert tuple(options.sampling(0, n).temperature for n in (1, 4)) == wanted
