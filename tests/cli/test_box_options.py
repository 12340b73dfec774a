"""What the command line says about the box: limits, the way out of the lock, and plans that must repeat."""

import json

DOMAIN = "\n\ndef gen_domain(initial):\n    return {'x': ContinuousSampler(1, 9)}\n"
COUNTS = """\
calls = []

def gen_plan(initial, x):
    calls.append(x)
    return [Action("draw_line", [x, 1, x, -5 if len(calls) < 4 else 5])]
"""
RANDOM = """\
def gen_plan(initial, x):
    return [Action("draw_line", [x, 1, x, 1 + random.random() + np.random.rand()])]
"""
ONE_LINE = """\
def gen_plan(initial, x):
    return [Action("draw_line", [2, 2, 3, 2])]
"""
SLOW = """\
def gen_plan(initial, x):
    for _ in range(10**9):
        pass
    return [Action("draw_line", [x, 1, x, 2])]
"""


def fence(program):
    return f"```python\n{program}{DOMAIN}```\n"


def run(cli, stub, program, *options):
    args = (
        "run",
        "drawing/free",
        "--goal",
        "A line.",
        "--feedback",
        0,
        "--seed",
        2,
        "--llm",
        stub(fence(program)),
    )
    return cli(*args, "--json", *options)


def test_a_program_that_keeps_state_between_calls_is_not_believed(cli, stub):
    result = run(cli, stub, COUNTS, "--samples", 50)
    assert result.code == 1
    messages = [error["message"] for error in result.json["program_errors"]]
    assert any("gave another plan" in message for message in messages)
    assert result.json["plan"] is None


def test_random_numbers_of_the_program_itself_repeat(cli, stub):
    first, second = (run(cli, stub, RANDOM) for _ in range(2))
    assert first.code == 0
    assert first.json["plan"] == second.json["plan"]


def test_a_limit_is_a_setting(cli, stub):
    result = run(cli, stub, SLOW, "--limit", "call=0.2", "--limit", "load=0.4")
    assert result.code == 1
    (error,) = result.json["program_errors"]
    assert error["kind"] == "SketchTimeout"
    assert error["line"] in (2, 3)


def test_limits_that_cannot_be(cli, stub):
    for limit, words in (
        ("cal=2", "did you mean 'call'?"),
        ("round=-1", "above 0"),
        ("round=nan", "above 0"),
        ("call=soon", "call"),
        ("call=0", "above 0"),
    ):
        result = run(cli, stub, RANDOM, "--limit", limit)
        assert result.code == 2
        assert words in result.json["error"]


def test_unlocked_programs_are_warned_of_and_recorded(cli, stub, here):
    result = run(cli, stub, RANDOM, "--unsafe-exec")
    assert result.code == 0
    assert "WARNING" in result.stderr
    first = json.loads((here / result.json["run_dir"] / "events.jsonl").read_text().splitlines()[0])
    assert first["options"]["unsafe_exec"] is True
    assert "WARNING" not in run(cli, stub, RANDOM).stderr


def test_a_round_that_takes_too_long_is_broken_off_and_gone_on_with(cli, stub, here):
    """The limit is nobody's fault: no feedback, no verdict, the same samples when it is repeated."""
    program = RANDOM.replace("x, 1, x, 1", "-1, x, -1, 1")
    args = (
        "drawing/free",
        "--goal",
        "A line.",
        "--samples",
        800,
        "--feedback",
        3,
        "--out",
        "late",
        "--json",
    )
    late = cli("run", *args, "--llm", stub(fence(program)), "--limit", "round=0.001")
    assert (late.code, late.json["stopped"], late.json["goal_reached"]) == (1, "time", None)
    assert "broken off after 0.001 s (--limit round=0.001)" in late.json["error"]
    assert late.json["samples"] < 800
    assert [path.name for path in here.glob("late/prompt-*")] == ["prompt-0.md"]
    changed = cli("run", "--resume", "late", "--limit", "call=3")
    assert (changed.code, "keeps the limits of its box" in changed.stderr) == (2, True)
    stub(fence(program), fence(ONE_LINE))
    done = cli("run", "--resume", "late", "--limit", "round=60", "--json")
    assert (done.code, done.json["solved"], done.json["stopped"]) == (0, True, None)
    assert done.json["samples"] == 801
