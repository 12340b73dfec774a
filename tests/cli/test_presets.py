"""What preset `best` does beyond the paper: the judge inside the loop, repairs, restarts, graded feedback."""

import pytest

BROKEN = """
```python
def gen_plan(initial, x):
    return [Action('draw_lien', [x, 1, 2, 2])]

def gen_domain(initial):
    return {'y': ContinuousSampler(0, 1)}
```
"""
POLYGON = """
```python
def gen_plan(initial, points, radius):
    corners = []
    for k in range(points):
        angle = 4 * math.pi * k / points if points % 2 else 2 * math.pi * k / points
        corners.append([50 + radius * math.cos(angle), 50 + radius * math.sin(angle)])
    return [Action("draw_line", corners[k - 1] + corners[k]) for k in range(points)]

def gen_domain(initial):
    return {"points": DiscreteSampler([4, 4, 4, 5]), "radius": ContinuousSampler(10, 20)}
```
"""


def far(reach):
    """A program whose first `reach` lines are legal and whose next is not."""
    lines = ", ".join(f'Action("draw_line", [1, {k + 1}, 2 + x, {k + 1}])' for k in range(reach))
    return f"""
```python
def gen_plan(initial, x):
    return [{lines}{"," if reach else ""} Action("draw_line", [50, 1, 60 + x, -5 + 4 * x])]

def gen_domain(initial):
    return {{"x": ContinuousSampler(0, 1)}}
```
"""


def run(cli, llm, *options):
    args = ("run", "drawing/star", "--llm", llm, "--samples", 200, "--preset", "best", "--json")
    return cli(*args, "--solver", "rejection", "-D", "count=0", *options)


def prompt(here, result, round_):
    return (here / result.json["run_dir"] / f"prompt-{round_}.md").read_text()


def test_a_legal_plan_that_misses_the_goal_is_sampled_past(cli, stub):
    wrong = run(cli, stub(POLYGON), "--no-check-goal", "--seed", 1)
    assert (wrong.json["solved"], wrong.json["goal_reached"]) == (True, False)
    right = run(cli, stub(POLYGON), "--seed", 1)
    assert (right.json["solved"], right.json["goal_reached"]) == (True, True)
    assert right.json["samples"] > wrong.json["samples"]


def test_a_missed_goal_is_fed_back_like_a_violation(cli, stub, here, answers):
    result = run(cli, stub(POLYGON.replace("[4, 4, 4, 5]", "[4]"), answers.star))
    assert result.json["goal_reached"]
    assert "100 % broke no rule, but missed the goal: a closed convex polygon" in prompt(here, result, 1)


def test_a_program_that_cannot_be_used_costs_a_repair_and_no_round(cli, stub, here, answers):
    llm = stub(BROKEN, BROKEN, answers.star)
    result = run(cli, llm, "--feedback", 1)
    assert result.json["solved"]
    assert result.json["rounds"] == 0
    asked = prompt(here, result, 1)
    assert "Your program could not be used" in asked
    assert "draw_lien" in asked
    paper = cli("run", "drawing/star", "--llm", llm, "--preset", "paper", "--feedback", 1, "--json")
    assert (paper.code, paper.json["rounds"]) == (1, 1)


@pytest.mark.slow
def test_repairs_are_limited(cli, stub, answers):
    result = run(cli, stub(*[BROKEN] * 3, answers.star), "--feedback", 1)
    assert (result.json["solved"], result.json["rounds"]) == (True, 1)
    result = run(cli, stub(*[BROKEN] * 6, answers.star), "--feedback", 1)
    assert not result.json["solved"]


def test_after_two_rounds_without_progress_the_best_program_is_shown_again(cli, stub, here, answers):
    result = run(cli, stub(far(3), far(1), far(0), answers.star))
    assert result.json["solved"]
    before, restarted = prompt(here, result, 2), prompt(here, result, 3)
    assert before.count("<!-- assistant: reply -->") == 2
    assert restarted.count("<!-- assistant: reply -->") == 1
    assert far(3).strip() in restarted
    assert "Do not repeat them" in restarted
    again = cli(
        "render-prompt",
        "drawing/star",
        "--round",
        3,
        "--from",
        result.json["run_dir"],
        "--format",
        "markdown",
    )
    assert again.stdout == restarted


def test_graded_feedback_says_how_far_and_which_values_are_better(cli, stub, here, answers):
    llm = stub(far(2).replace("-5 + 4 * x", "-5 if x < 0.8 else -1"), answers.star)
    told = prompt(here, run(cli, llm), 1)
    assert "The samples that got furthest carried out 2 steps" in told
    assert 'broke the rule "inside" at step 2' in told
    assert "The nearest miss was off by 1." in told
    assert "had `x` between 0.8" in told
    assert "Never broken: collision." in told


def test_the_prompt_of_best_lists_the_rules_and_that_of_the_paper_does_not(cli):
    best, paper = (
        cli("render-prompt", "drawing/star", "--preset", name).stdout for name in ("best", "paper")
    )
    assert "keeps at least 1 canvas unit clear" in best
    assert "keeps at least 1 canvas unit clear" not in paper


def test_without_a_judge_there_is_no_goal_to_check(cli, stub, answers):
    result = cli(
        "run", "drawing/free", "--goal", "A star.", "--llm", stub(answers.star), "--check-goal", "--json"
    )
    assert (result.code, result.json["goal_reached"]) == (0, None)
