import json

import pytest

KEYS = [
    "task",
    "method",
    "llm",
    "llm_source",
    "stale",
    "solver",
    "preset",
    "seed",
    "world",
    "solved",
    "executed",
    "goal_reached",
    "goal_reason",
    "goal_expected",
    "rounds",
    "samples",
    "evaluations",
    "rehearsals",
    "rejected_by",
    "room",
    "improved",
    "seconds",
    "cpu_seconds",
    "plan",
    "violations",
    "program_errors",
    "nearest",
    "usage",
    "run_dir",
    "stopped",
    "error",
]
METHODS = ["proc3s", "proc3s-nf", "cap", "cap-gaussian", "llm3", "llm3-nf", "llm3-gaussian"]


def test_the_first_command_of_the_readme(cli, here):
    result = cli("run", "drawing/star")
    assert result.code == 0
    assert "solved" in result.stdout
    assert "reached: " in result.stdout
    assert "authored" in result.stdout
    run, _ = sorted((here / "runs").iterdir())  # and `latest`
    assert run.name in result.stdout
    names = {path.name for path in run.iterdir()}
    assert {
        "events.jsonl",
        "film.json",
        "prompt-0.md",
        "answer-0.md",
        "program-0.py",
        "plan.json",
        "plan.png",
        "score.json",
        "summary.json",
    } == names


def test_the_summary_is_one_document_with_exactly_these_keys(shell, here):
    result = shell("run", "drawing/star", "--json")
    assert result.code == 0
    assert result.stderr == ""
    summary = result.json
    assert list(summary) == KEYS
    assert list(summary["seconds"]) == list(summary["cpu_seconds"]) == ["llm", "solve", "execute", "total"]
    assert all(set(action) == {"skill", "args"} for action in summary["plan"])
    assert (summary["solved"], summary["executed"], summary["error"]) == (True, "solution", None)
    assert (summary["goal_reached"], summary["llm"], summary["llm_source"]) == (True, "replay", "authored")
    assert (summary["task"], summary["method"], summary["seed"]) == ("drawing/star", "proc3s", 0)
    assert (summary["solver"], summary["preset"], summary["rounds"]) == ("portfolio", "best", 0)
    assert summary["samples"] >= summary["evaluations"] >= 1
    assert json.loads((here / summary["run_dir"] / "summary.json").read_text()) == summary


def test_an_unsolved_run_is_exit_code_1_and_says_why(cli, stub, answers):
    result = cli(
        "run",
        "drawing/star",
        "--llm",
        stub(answers.outside, answers.outside),
        "--feedback",
        1,
        "--samples",
        30,
        "--json",
    )
    assert result.code == 1
    summary = result.json
    assert list(summary) == KEYS
    assert (summary["solved"], summary["executed"], summary["plan"]) == (False, "none", None)
    assert (summary["rounds"], summary["samples"], summary["goal_reached"]) == (1, 60, None)
    assert summary["violations"] == [
        {
            "constraint": "inside",
            "step": 1,
            "skill": "draw_line",
            "text": "the x coordinate leaves the canvas",
            "share": 100,
        }
    ]
    assert summary["error"] is None


def test_a_missed_goal_is_still_solved(cli, stub, answers):
    plan = answers.star.replace("range(5)", "range(3)")
    result = cli("run", "drawing/star", "--llm", stub(plan), "--no-check-goal", "--json")
    assert result.code == 0
    assert (result.json["solved"], result.json["goal_reached"]) == (True, False)
    assert result.json["goal_reason"]


def plan_of(result):
    return result.json["plan"], result.json["samples"], result.json["evaluations"]


@pytest.mark.parametrize("method", METHODS)
def test_all_seven_methods_run_on_bundled_answers_and_give_the_identical_plan_twice(cli, method):
    one, two = (cli("run", "drawing/star", "--method", method, "--json") for _ in range(2))
    assert one.code == 0, one.stderr
    assert (one.json["solved"], one.json["goal_reached"], one.json["method"]) == (True, True, method)
    assert plan_of(one) == plan_of(two)
    assert one.json["run_dir"] != two.json["run_dir"]


@pytest.mark.slow
@pytest.mark.parametrize("method", ["cap", "llm3"])
@pytest.mark.parametrize("task", ["arrow", "letters", "enclosed"])
def test_the_other_tasks_on_bundled_answers(cli, method, task):
    result = cli("run", f"drawing/{task}", "--method", method, "--json")
    assert result.json["error"] is None
    assert result.json["executed"] != "none"


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("task", ["star", "arrow", "letters", "enclosed"])
def test_the_four_tasks_are_solved_with_bundled_answers(cli, task, seed):
    result = cli("run", f"drawing/{task}", "--seed", seed, "--json")
    assert result.code == 0
    assert (result.json["solved"], result.json["goal_reached"]) == (True, True), result.json["goal_reason"]


def test_a_feedback_round_with_bundled_answers(cli, here, events):
    result = cli("run", "drawing/enclosed", "--json", "--samples", 3000)
    assert (result.code, result.json["rounds"], result.json["goal_reached"]) == (0, 1, True)
    kinds = [e["event"] for e in events(here / result.json["run_dir"]) if e["event"] != "batch_evaluated"]
    assert kinds == [
        "run_started",
        *("prompt_rendered", "answer_received", "program_extracted", "sketch_loaded"),
        *("attempt_ended", "round_ended"),
        *("prompt_rendered", "answer_received", "program_extracted", "sketch_loaded"),
        "plan_improved",
        "attempt_ended",
        "plan_executed",
        "run_ended",
    ]


def test_other_seeds_give_other_scenes_and_plans(cli, stub, answers):
    llm = stub(answers.star)
    one, two = (cli("run", "drawing/star", "--llm", llm, "--seed", s, "--json") for s in (1, 2))
    assert one.json["plan"] != two.json["plan"]


def test_the_size_of_batches_changes_nothing(cli, stub, answers):
    llm = stub(answers.star)
    args = ("run", "drawing/star", "--llm", llm, "--seed", 3, "--json", "--solver", "rejection")
    one = cli(*args)
    two = cli(*args, "-S", "first=1", "-S", "largest=3")
    assert plan_of(one) == plan_of(two)


def test_the_log_has_every_sample_in_columns(cli, stub, answers, here, events):
    result = cli(
        *("run", "drawing/star", "--llm", stub(answers.outside), "--feedback", 0, "--samples", 200, "--json"),
        *("--solver", "rejection"),
    )
    batches = events(here / result.json["run_dir"], "batch_evaluated")
    columns = ("u", "accepted", "reached", "violation", "step", "text", "margin")
    assert [b["first"] for b in batches] == [0, 64, 192]
    for batch in batches:
        assert len({len(batch[name]) for name in columns}) == 1
    assert sum(len(b["u"]) for b in batches) == 200
    assert {s for b in batches for s in b["step"]} == {1}


def test_cap_executes_its_plan_whatever_it_violates(cli, stub, answers):
    program = (
        answers.outside.replace("(initial, x)", "(initial)")
        .replace("x, 1", "0, 1")
        .split("def gen_domain")[0]
        + "```"
    )
    result = cli("run", "drawing/star", "--method", "cap", "--llm", stub(program), "--json")
    assert result.code == 1
    summary = result.json
    assert (summary["solved"], summary["executed"], summary["samples"]) == (False, "fallback", 0)
    assert len(summary["plan"]) == 2
    assert [v["step"] for v in summary["violations"]] == [1]
    assert summary["goal_reached"] is False


def test_llm3_falls_back_on_its_last_plan(cli, stub, answers):
    llm = stub(answers.literal(-1), answers.literal(-2))
    result = cli("run", "drawing/star", "--method", "llm3", "--feedback", 1, "--llm", llm, "--json")
    summary = result.json
    assert (result.code, summary["executed"], summary["rounds"], summary["samples"]) == (1, "fallback", 1, 2)
    assert summary["plan"][1]["args"][0] == -2


def test_llm3_gaussian_repairs_a_plan_by_noise(cli, stub, answers):
    llm = stub(answers.literal(-0.5))
    result = cli(
        "run", "drawing/free", "--goal", "two lines", "--method", "llm3-gaussian", "--llm", llm, "--json"
    )
    assert (result.code, result.json["executed"]) == (0, "solution")
    assert 1 < result.json["samples"] < 10000
    assert result.json["solver"] == "gaussian"


def test_cap_gaussian_falls_back_on_the_unperturbed_plan(cli, stub):
    program = "```python\ndef gen_plan(initial):\n    return [Action('draw_line', [-999, 0, 0, 0])]\n```"
    result = cli(
        *(
            "run",
            "drawing/star",
            "--method",
            "cap-gaussian",
            "--llm",
            stub(program),
            "--samples",
            50,
            "--json",
        )
    )
    assert (result.code, result.json["executed"]) == (1, "fallback")
    assert result.json["plan"] == [{"skill": "draw_line", "args": [-999.0, 0.0, 0.0, 0.0]}]


def test_an_instruction_of_ones_own_is_not_judged_and_says_so(cli, stub, answers):
    result = cli("run", "drawing/free", "--goal", "draw anything", "--llm", stub(answers.star))
    assert result.code == 0
    assert "not judged" in result.stdout


def test_the_bundled_answer_is_no_answer_to_another_goal(cli):
    result = cli("run", "drawing/star", "--goal", "draw a house", "--json")
    assert result.code == 2
    assert "--llm" in result.json["error"]


def test_solve_needs_no_llm_and_no_goal(cli, here, answers):
    program = here / "mine.py"
    program.write_text(answers.star.split("```python\n")[1].split("```")[0])
    result = cli("solve", "drawing/free", "--sketch", program, "--json")
    assert result.code == 0
    assert list(result.json) == KEYS
    assert (result.json["llm"], result.json["llm_source"], result.json["rounds"]) == (None, "none", 0)
    judged = cli("solve", "drawing/star", "--sketch", program, "--json")
    assert judged.json["goal_reached"] is True


def test_options_of_the_scene(cli, stub, answers, here, events):
    result = cli("run", "drawing/star", "-D", "count=2", "--llm", stub(answers.star), "--json")
    scene = json.loads(events(here / result.json["run_dir"], "run_started")[0]["scene"])
    assert len(scene["obstacles"]) == 2


def test_the_folder_may_be_chosen(cli, here):
    result = cli("run", "drawing/star", "--out", "a/b", "--json")
    assert result.json["run_dir"] == "a/b"
    assert (here / "a/b/summary.json").is_file()
    assert not (here / "runs").exists()


def test_presets_are_recorded(cli):
    assert cli("run", "drawing/star", "--preset", "release", "--json").json["preset"] == "release"


def test_a_template_folder_goes_before_all_others(cli, here, events):
    (here / "mine/partials").mkdir(parents=True)
    (here / "mine/partials/task.j2").write_text("MY WORDS {{ goal }}")
    result = cli("run", "drawing/star", "--template-dir", "mine", "--json")
    prompt = (here / result.json["run_dir"] / "prompt-0.md").read_text()
    assert "MY WORDS Draw a star" in prompt


def test_a_listener_that_breaks_does_not_cost_the_run(cli, here):
    plugin = here / "ear.py"
    plugin.write_text(
        "from proc3s import hookimpl\n\n@hookimpl\ndef on_event(event):\n    raise KeyError('ear')\n"
    )
    result = cli("run", "drawing/star", "--plugin", plugin, "--json")
    assert (result.code, result.json["solved"]) == (0, True)


def test_coordinates_have_four_digits_on_the_console_as_in_an_explanation(cli, stub):
    line = "[0.012345678, 1 / 3, 49.123456789, 1e-17]"
    program = f"```python\ndef gen_plan(initial):\n    return [Action('draw_line', {line})]\n```"
    result = cli(
        "run", "drawing/free", "--goal", "A line.", "--method", "cap", "--llm", stub(program), "--out", "r"
    )
    assert "  0  draw_line(0.01235, 0.3333, 49.12, 0)\n" in result.stdout
    assert "  0  draw_line(0.01235, 0.3333, 49.12, 0)\n" in cli("explain", "r").stdout
