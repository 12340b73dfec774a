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
    for limit, words in (("cal=2", "did you mean 'call'?"), ("call=soon", "call"), ("call=0", "above 0")):
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
