"""No option is ignored without a word: it is refused, or it is said that it changes nothing."""

import pytest

REFUSED = [
    (["run", "drawing/star", "--goal", ""], "--goal is empty"),
    (["run", "drawing/star", "--goal", "  "], "--goal is empty"),
    (["render-prompt", "drawing/star", "--goal", ""], "--goal is empty"),
    (["run", "drawing/star", "--executor", "serial", "--jobs", 4], "serial takes at most --jobs 1, not 4"),
    (["run", "drawing/star", "-S", "x=1", "--solver", "rejection"], "unknown key 'x'"),
    (["run", "drawing/star", "-D", "count=3", "-D", "count=4"], "'count' is given several times"),
    (["run", "drawing/star", "--feedback", 1, "-M", "rounds=2"], "--feedback and -M rounds"),
    (["render-prompt", "drawing", "--check", ".", "--round", 1], "--check compares whole renderings"),
    (["bench", "smoke", "--solvers", "cma"], "No such option: --solvers"),
    (["bench", "smoke", "--throughput", 1], "No such option: --throughput"),
    (["bench", "smoke", "--robust", 2], "No such option: --robust"),
    (["bench", "smoke", "--methods", ""], "--methods is empty"),
    (["bench", "smoke", "--tasks", ","], "--tasks is empty"),
    (["bench", "smoke", "--resume", "a", "--out", "b"], "--out changes nothing"),
    (["bench", "smoke", "--template-dir", "nowhere"], "there is no template folder"),
    (["bench", "--seeds", 2, "ccsp"], "`proc3s bench ccsp` comes first, its options after that"),
    (["bench", "ccsp", "--llm", "replay"], "No such option: --llm"),
    (["bench", "ccsp", "--robust", 0], "No such option: --robust"),
    (["bench", "execution", "--solvers", "cma"], "No such option: --solvers"),
    (["bench", "execution", "--jobs", 2], "No such option: --jobs"),
    (["run", "drawing/star", "--check-goal", "--no-check-goal"], "contradict each other"),
]
CAP = ["run", "drawing/star", "--method", "cap"]
STAR = ["run", "drawing/star"]
SAID = [
    ([*CAP, "--solver", "cma"], "cap draws no samples, so --solver changes nothing"),
    (
        [*CAP, "--samples", 9, "--no-screens"],
        "cap draws no samples, so --samples, --no-screens change nothing",
    ),
    ([*STAR, "--audit", 5, "--no-screens"], "--audit changes nothing"),
    ([*STAR, "--goal", "A house.", "--llm", "STUB", "--check-goal"], "this instruction has no judge"),
    ([*STAR, "--llm-jobs", 3], "--llm-jobs changes nothing"),
    ([*STAR, "--max-calls", 3], "--max-calls changes nothing: asking replay costs nothing"),
]


@pytest.mark.parametrize(("args", "words"), REFUSED, ids=[" ".join(map(str, a)) for a, _ in REFUSED])
def test_options_that_make_no_sense_are_refused(cli, args, words):
    result = cli(*args)
    assert (result.code, words in result.stderr) == (2, True), result.stderr


@pytest.mark.parametrize(("args", "words"), SAID, ids=[" ".join(map(str, a)) for a, _ in SAID])
def test_options_without_effect_are_named(cli, stub, answers, args, words):
    model = stub(answers.star)
    result = cli(*(model if word == "STUB" else word for word in args))
    assert (result.code, words in result.stderr) == (0, True), result.stderr


def test_options_that_count_are_not_named(cli):
    said = cli(
        "run", "drawing/star", "--solver", "cma", "--samples", 900, "--audit", 3, "--check-goal"
    ).stderr
    assert "changes nothing" not in said


def test_a_run_of_several_processes_is_replayed_in_one(cli):
    assert cli("run", "drawing/star", "--jobs", 2, "--out", "two").code == 0
    again = cli("replay", "two", "--executor", "serial", "--json")
    assert (again.code, again.json["solved"]) == (0, True), again.stderr


def test_one_is_one_and_what_says_nothing_is_not_said(cli, stub):
    """Counts agree with their nouns, and a method that draws no samples has no line about them."""
    one = "```python\ndef gen_plan(initial, a):\n    return [Action('draw_line', [a, 1, a, -1])]\n\n"
    one += "def gen_domain(initial):\n    return {'a': ContinuousSampler(1, 9)}\n```"
    failed = cli("run", "drawing/star", "--llm", stub(one), "--samples", 1, "--feedback", 0)
    assert "a program with 1 open parameter a" in failed.stderr
    assert "samples  1 in 1 round" in failed.stdout
    cap = cli("run", "drawing/star", "--method", "cap")
    assert "a program without open parameters" in cap.stderr
    assert "no sample was drawn" in cap.stdout
    assert "samples  0" not in cap.stdout
    assert "rejected 0" not in cap.stdout
