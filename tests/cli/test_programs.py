"""Answers that are no good are fed back with line numbers; never is there a traceback of ours."""

import pytest

DOMAIN = '\ndef gen_domain(initial):\n    return {"x": ContinuousSampler(0, 1)}\n'
PLAN = "def gen_plan(initial, x):\n"


def fence(code):
    return f"Here it is.\n\n```python\n{code}\n```\n"


@pytest.fixture
def told(cli, stub, answers, here):
    """What the second prompt says after a first answer; the second answer is fine."""

    def run(answer, *args):
        result = cli(
            "run",
            "drawing/star",
            "--preset",
            "paper",
            "--llm",
            stub(answer, answers.star),
            "--samples",
            "300",
            "--json",
            *args,
        )
        assert result.code == 0, result.stdout
        assert result.json["rounds"] == 1
        prompt = (here / result.json["run_dir"] / "prompt-1.md").read_text(encoding="utf-8")
        return prompt.split("<!-- user: feedback -->")[1]

    return run


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        ("I cannot do this.", ["no program", "gen_plan"]),
        ("", ["no program"]),
        (fence("def gen_plan(initial:\n    pass"), ["line 1 (`def gen_plan(initial:`)"]),
        (fence(PLAN + "    return [\n" + DOMAIN), ["line 2"]),
        (fence("x = 1"), ["gen_plan"]),
        (fence(PLAN + "    return []\n"), ["gen_domain"]),
        (fence(PLAN + "    return []\n" + DOMAIN), ["empty"]),
        (fence(PLAN + '    return [Action("draw_lin", [1, 1, 2, 2])]\n' + DOMAIN), ["draw_lin", "line 2"]),
        (fence(PLAN + '    return [Action("draw_line", [1, 1, 2])]\n' + DOMAIN), ["4", "3"]),
        (fence(PLAN + '    return [Action("draw_line", [1, 1, 2, "a"])]\n' + DOMAIN), ["p2_y"]),
        (fence(PLAN + '    return [Action("draw_line", [1, 1, 2, float("nan")])]\n' + DOMAIN), ["p2_y"]),
        (
            fence("def gen_plan(initial, y):\n    return [Action('draw_line', [1, 1, 2, y])]\n" + DOMAIN),
            ["'x'", "'y'"],
        ),
        (
            fence(
                PLAN + "    return [Action('draw_line', [1, 1, 2, x])]\n" + DOMAIN.replace("(0, 1)", "(1, 0)")
            ),
            ["line 5", "min", "max"],
        ),
        (fence("import socket\n" + PLAN + "    pass\n" + DOMAIN), ["line 1 (`import socket`)", "socket"]),
        (fence("while True:\n    pass\n"), ["line ", "took longer than"]),
    ],
)
def test_a_program_that_cannot_be_used(told, answer, words):
    text = told(answer)
    assert "could not be used" in text
    for word in words:
        assert word in text, text
    assert "Traceback" not in text
    assert "site-packages" not in text
    assert "proc3s/" not in text


def test_an_error_in_every_sample_is_told_with_its_line(told):
    text = told(fence(PLAN + "    return undefined_name\n" + DOMAIN))
    assert "line 2 (`return undefined_name`): NameError" in text


def test_all_mistakes_are_told_at_once(told):
    text = told(
        fence(
            "def gen_plan(initial, x, y, z):\n    return [Action('draw_line', [1, 1, 2, 2])]\n"
            "def gen_domain(initial):\n"
            "    return {'x': ContinuousSampler(2, 1),\n"
            "            'w': ContinuousSampler(0, 1),\n"
            "            'y': 7}\n"
        )
    )
    for word in ("x", "'w'", "y", "'z'"):
        assert word in text
    assert text.count("\n- ") >= 4


SOMETIMES = fence(
    PLAN
    + "    if x < 0.3:\n        print(1 / 0)\n"
    + '    return [Action("draw_line", [-5, 1, 2, 2])]\n'
    + DOMAIN
)


def test_a_sample_that_raises_is_a_failed_sample_not_the_end_of_the_round(told, here):
    text = told(SOMETIMES)
    assert "line 3 (`print(1 / 0)`): " in text
    assert "division by zero" in text
    assert "step 0, action draw_line: the x coordinate leaves the canvas" in text
    assert "Traceback" not in text


def test_errors_of_samples_stand_in_the_summary(cli, stub):
    result = cli(
        "run",
        "drawing/star",
        "--preset",
        "paper",
        "--llm",
        stub(SOMETIMES),
        "--feedback",
        0,
        "--samples",
        400,
        "--json",
    )
    (error,) = result.json["program_errors"]
    assert set(error) == {"kind", "message", "line", "source", "share", "parameters"}
    assert (error["kind"], error["line"], error["share"]) == ("SketchRuntimeError", 3, 30)
    assert "print(1 / 0)" in error["source"]
    (violation,) = result.json["violations"]
    assert violation["share"] == 70
    assert result.json["samples"] == 400


def test_numbers_in_a_message_do_not_split_one_mistake_into_hundreds(cli, stub):
    answer = fence(PLAN + '    return [Action("draw_line", [1, 1, 2, (2 + x) * 1e9])]\n' + DOMAIN)
    result = cli(
        "run",
        "drawing/star",
        "--preset",
        "paper",
        "--llm",
        stub(answer),
        "--feedback",
        0,
        "--samples",
        400,
        "--json",
    )
    (error,) = result.json["program_errors"]
    assert error["share"] == 100
    assert "p2_y" in error["message"]


def test_a_solution_among_samples_that_raise_is_found(cli, stub):
    answer = SOMETIMES.replace("x < 0.3", "x > 0.1").replace("-5, 1", "1, 1")
    result = cli(
        "run", "drawing/free", "--preset", "paper", "--goal", "a line", "--llm", stub(answer), "--json"
    )
    assert result.code == 0
    assert result.json["samples"] > 1


@pytest.mark.slow
def test_an_endless_loop_in_some_samples_ends_the_round_with_its_line(cli, stub, answers, here):
    hang = fence(
        PLAN
        + "    while x > 0.95:\n        pass\n"
        + '    return [Action("draw_line", [-5, 1, 2, 2])]\n'
        + DOMAIN
    )
    result = cli("run", "drawing/star", "--preset", "paper", "--llm", stub(hang, answers.star), "--json")
    assert (result.code, result.json["rounds"]) == (0, 1)
    text = (here / result.json["run_dir"] / "prompt-1.md").read_text().split("<!-- user: feedback -->")[1]
    assert "line 2 (`while x > 0.95:`)" in text or "line 3 (`pass`)" in text
    assert "the x coordinate leaves the canvas" in text


def test_an_unusable_last_answer_is_exit_code_1(cli, stub):
    result = cli(
        "run",
        "drawing/star",
        "--preset",
        "paper",
        "--llm",
        stub("no code", fence("def f(:")),
        "--feedback",
        1,
        "--json",
    )
    assert result.code == 1
    assert (result.json["error"], result.json["plan"], result.json["samples"]) == (None, None, 0)
    assert [(e["kind"], e["line"]) for e in result.json["program_errors"]] == [("SketchSyntaxError", 1)]


def test_an_unusable_program_of_ones_own_is_exit_code_1(cli, here):
    (here / "mine.py").write_text("def gen_plan(initial):\n    return 1\n")
    result = cli("solve", "drawing/star", "--sketch", "mine.py")
    assert result.code == 1
    assert "gen_domain" in result.stderr
    assert "Traceback" not in result.stderr


def test_a_person_reads_why_without_json(cli, stub):
    result = cli("run", "drawing/star", "--preset", "paper", "--llm", stub(fence("def f(:")), "--feedback", 0)
    assert result.code == 1
    assert "unsolved" in result.stdout
    assert "line 1: def f(:" in result.stderr


def test_markup_of_an_answer_is_not_ours(cli, stub):
    answer = fence(PLAN + "    raise ValueError('[bold red]x[/] [/nothing]')\n" + DOMAIN)
    result = cli(
        "run", "drawing/star", "--preset", "paper", "--llm", stub(answer), "--feedback", 0, "--samples", 5
    )
    assert result.code == 1
    assert "[bold red]x[/]" in result.stderr


@pytest.mark.parametrize(
    "text", ["größer ✓ 星", "a\u2028b", "lone \ud800 surrogate", "nul \0 and \x1b[31m red"]
)
def test_any_text_in_an_answer_is_kept(cli, stub, answers, here, text):
    result = cli("run", "drawing/star", "--preset", "paper", "--llm", stub(text + answers.star), "--json")
    assert result.code == 0
    again = cli("replay", result.json["run_dir"], "--json")
    assert (again.code, again.json["plan"]) == (0, result.json["plan"])


def test_the_llm_failing_in_a_later_round_keeps_what_there_is(cli, stub, answers, here):
    result = cli(
        "run", "drawing/star", "--preset", "paper", "--llm", stub(answers.outside), "--samples", 40, "--json"
    )
    assert result.code == 3
    summary = result.json
    assert "none for round 1" in summary["error"]
    assert (summary["samples"], summary["solved"]) == (40, False)
    assert summary["violations"][0]["constraint"] == "inside"
    names = {path.name for path in (here / summary["run_dir"]).iterdir()}
    assert {
        "events.jsonl",
        "summary.json",
        "answer-0.md",
        "program-0.py",
        "prompt-0.md",
        "prompt-1.md",
    } <= names
