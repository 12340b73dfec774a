"""What could not be carried out is no failure of a model: not finished, with a reason, and tried again."""

import json

import pytest

from proc3s.suites.lock import alone_in
from proc3s.suites.runner import ALIKE
from proc3s.suites.store import Store

DOMAIN = """
import os
import signal
from pathlib import Path

from proc3s import Score, hookimpl, load_domain


def scene(rng):
    first = rng.random()  # 0.64 and 0.51 for the seeds 0 and 1
    if Path("broken").exists() and first < 0.6:
        raise OSError("no light in here")
    return {}


def step(world, length):
    if Path("deadly").exists():
        os.kill(os.getpid(), signal.SIGKILL)


def judge(state, plan):
    if Path("blind").exists():
        raise OSError("the judge cannot see")
    return Score(True, "done")


def never(transition):
    return -1.0 if Path("impossible").exists() else 1.0


@hookimpl
def register_domains(register):
    register(load_domain(Path(__file__).with_name("hall.yaml")))
"""
SPEC = """
spec_version: 1
name: hall
summary: A hall.
world: {target: "proc3s.domain.world:World"}
state: Hall
types: {Hall: {summary: A hall., fields: {lamps: {type: float, default: 1.0}}}}
skills: {step: {summary: Steps., target: "hall:step", params: {length: {type: float}}}}
samplers: [ContinuousSampler]
constraints: {never: {says: "never", target: "hall:never"}}
tasks: {walk: {instruction: Walk., initial: {target: "hall:scene"}, judge: [{target: "hall:judge"}]}}
budget: {paper: 10, release: 10}
"""
PROGRAM = """```python
def gen_plan(initial, a):
    return [Action("step", [a])]

def gen_domain(initial):
    return {"a": ContinuousSampler(0, 1)}
```"""


@pytest.fixture
def bench(cli, here, stub):
    """Runs a suite of a task in a domain that files in the working directory break; one seed by default."""
    (here / "hall.py").write_text(DOMAIN)
    (here / "hall.yaml").write_text(SPEC)
    model = stub(PROGRAM)

    def run(*args, seeds=1, llm=model):
        suite = {"name": "mine", "summary": "Mine.", "tasks": ["hall/walk"], "methods": ["proc3s-nf"]}
        (here / "mine.yaml").write_text(json.dumps({**suite, "seeds": seeds}))
        return cli("bench", "mine.yaml", "--llm", llm, "--plugin", "hall.py", *args)

    return run


def left(folder):
    return [(one.cell.seed, one.word, one.error) for one in Store(folder).unfinished()]


@pytest.mark.parametrize(
    ("args", "code", "words"),
    [
        ({"llm": "stub:nothing.json"}, 3, "nothing.json' cannot be read"),
        ({"llm": "replay:nothing"}, 3, "there is no nothing to replay"),
        ({"llm": "openai/gpt-4"}, 3, "needs a key"),
        ({"llm": "replay", "-L": "lenint=true"}, 2, "no option 'lenint'"),
        ({"--limit": "rond=3"}, 2, "there is no limit 'rond'"),
        ({"--plugin": "nothing.py"}, 2, "there is no file or folder nothing.py"),
    ],
)
def test_what_is_certain_before_the_first_episode_ends_the_suite_at_once(
    bench, here, monkeypatch, args, code, words
):
    monkeypatch.delenv("OPENAI_API_KEY", raising=False)
    options = [word for name, value in args.items() if name != "llm" for word in (name, value)]
    result = bench("--out", "out", *options, seeds=700, **{k: v for k, v in args.items() if k == "llm"})
    assert (result.code, words in result.stderr) == (code, True), result.stderr
    assert not (here / "out").exists()


def test_a_scene_that_raises_ends_the_suite_before_the_first_episode(bench, here):
    (here / "hall.py").write_text(DOMAIN.replace("first < 0.6", "first"))
    (here / "broken").touch()
    result = bench("--out", "out", seeds=700)
    assert (result.code, "no light in here" in result.stderr) == (2, True), result.stderr
    assert not (here / "out").exists()


@pytest.mark.slow
def test_an_episode_that_cannot_be_carried_out_is_tried_again_and_in_no_rate(bench, here):
    (here / "broken").touch()
    result = bench("--out", "out", seeds=2)
    assert result.code == 2
    assert "hall/walk proc3s-nf seed 1: not finished, error: " in result.stderr
    assert "1 episode is not finished; go on with --resume out" in result.stderr
    assert [(seed, word) for seed, word, _ in left(here / "out")] == [(1, "error")]
    assert "no light in here" in left(here / "out")[0][2]
    assert [e.goal_reached for e in Store(here / "out").episodes()] == [True]
    assert bench("--resume", "out", seeds=2).code == 2
    (here / "broken").unlink()
    done = bench("--resume", "out", "--json", seeds=2)
    assert done.code == 0, done.stderr
    assert [(e["outcome"], e["error"]) for e in done.json["episodes"]] == [("goal reached", None)] * 2
    assert done.json["unfinished"] == left(here / "out") == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("what", "words"),
    [("deadly", "ended by signal SIGKILL; was there memory enough?"), ("blind", "the judge cannot see")],
)
def test_a_process_that_is_killed_and_a_judge_that_raises_are_no_failures(bench, here, what, words):
    (here / what).touch()
    result = bench("--out", "out")
    assert (result.code, words in result.stderr) == (2, True), result.stderr
    assert [word for _, word, _ in left(here / "out")] == ["error"]
    (here / what).unlink()
    assert bench("--resume", "out").code == 0


@pytest.mark.slow
def test_the_same_error_again_and_again_ends_the_suite(bench, here):
    (here / "blind").touch()
    result = bench("--out", "out", seeds=40)
    assert result.code == 2
    assert "40 episodes are not finished" in result.stderr
    assert f"the latest {ALIKE} ended with the same error, so no more were begun" in result.stderr
    assert len(left(here / "out")) == ALIKE


@pytest.mark.slow
def test_a_limit_of_the_clock_leaves_an_episode_to_go_on_with(bench, here):
    result = bench("--out", "out", "--limit", "round=0.0001")
    assert (result.code, "out of time" in result.stderr) == (1, True), result.stderr
    assert [word for _, word, _ in left(here / "out")] == ["out of time"]
    assert bench("--resume", "out", "--limit", "round=60").code == 0


def test_a_model_that_finds_no_plan_has_failed(bench, here):
    (here / "impossible").touch()
    result = bench("--out", "out", "--json")
    assert result.code == 0
    assert [e["outcome"] for e in result.json["episodes"]] == ["no plan"]
    assert result.json["tables"][0]["lines"][0][1] == "0/1 by hand"


@pytest.mark.parametrize("suite", ["mine.yaml", "ccsp", "execution"])
def test_two_benchmarks_do_not_share_a_folder(bench, cli, here, suite):
    (here / "out").mkdir()
    with alone_in(here / "out"):
        result = bench("--out", "out") if suite == "mine.yaml" else cli("bench", suite, "--out", "out")
    assert result.code == 2
    assert "another benchmark is at work in out" in result.stderr
