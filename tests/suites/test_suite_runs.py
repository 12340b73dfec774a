"""Suites from the command line: all methods, pending answers, a killed process, and what resuming does."""

import json
import signal
import sqlite3

import pytest

from proc3s.specs.suite import load_suite
from proc3s.suites.results import read_results
from proc3s.suites.store import FILE, Store

PROGRAM = """```python
def gen_plan(initial):
    points = [(2, 2), (6, 98), (10, 2), (1, 60), (11, 60)]
    ends = points[1:] + points[:1]
    return [Action("draw_line", [*a, *b]) for a, b in zip(points, ends)]

def gen_domain(initial):
    return {}
```"""
METHODS = ("llm3", "llm3-nf", "llm3-gaussian", "cap", "cap-gaussian", "proc3s-nf", "proc3s")


@pytest.fixture
def suite(here):
    """Writes a suite's file; returns its name."""

    def write(**more):
        given = {"name": "mine", "summary": "Mine.", "tasks": ["drawing/star"], "methods": ["proc3s"], **more}
        (here / "mine.yaml").write_text(json.dumps(given))  # JSON is YAML
        return "mine.yaml"

    return write


def times(folder):
    """When each episode began, by its log."""
    logs = sorted(folder.glob("runs/*/events.jsonl"))
    return {log.parent.name: json.loads(log.read_text().splitlines()[0])["time"] for log in logs}


@pytest.mark.slow
def test_all_seven_methods_through_the_stub(cli, suite, stub, here):
    name = suite(methods=METHODS, seeds=1, samples=20, feedback=1)
    result = cli("bench", name, "--llm", stub(*[PROGRAM] * 9), "--jobs", 2, "--out", "out", "--json")
    assert result.code == 0, result.stderr
    episodes = {e["method"]: e for e in result.json["episodes"]}
    assert set(episodes) == set(METHODS)
    assert episodes["cap"]["executed"] != "none"
    assert episodes["proc3s"]["rounds"] <= 1
    assert episodes["llm3"]["program_errors"] >= 2
    assert episodes["llm3"]["executed"] == "none"
    for one in episodes.values():
        assert one["prompt_sha256"]
        assert (here / "out" / one["run_dir"] / "summary.json").is_file()
    for end in ("md", "csv", "json", "html"):
        assert (here / f"out/results.{end}").stat().st_size > 500
    assert json.loads((here / "out/results.json").read_text())["episodes"] == result.json["episodes"]


@pytest.mark.slow
def test_pending_answers_are_written_by_hand_and_the_suite_goes_on(cli, suite, answers_of_star, here):
    name = suite(seeds=2, presets=["best", "paper"])
    args = ("bench", name, "--llm", "manual:desk", "-L", "wait=0", "--jobs", 2)
    pending = cli(*args, "--out", "out")
    assert pending.code == 4, pending.stderr
    assert "4 episodes are not finished; go on with --resume out" in pending.stderr
    prompts = sorted(here.glob("desk/*/*.prompt.md"))
    assert [p.relative_to(here / "desk").as_posix() for p in prompts] == [
        f"{preset}/drawing.star.proc3s.seed{seed}.prompt.md"
        for preset in ("best", "paper")
        for seed in (0, 1)
    ]
    prompts[0].with_name(prompts[0].name.replace(".prompt.", ".answer.")).write_text(answers_of_star)
    assert cli(*args, "--resume", "out").code == 4
    first = times(here / "out")
    for prompt in prompts[1:]:
        prompt.with_name(prompt.name.replace(".prompt.", ".answer.")).write_text(answers_of_star)
    done = cli(*args, "--resume", "out", "--json")
    assert done.code == 0, done.stderr
    assert [e["source"] for e in done.json["episodes"]] == ["manual"] * 4
    assert all(e["goal_reached"] for e in done.json["episodes"])
    assert times(here / "out") == first  # each went on, none began anew
    kept = Store(here / "out").episodes()
    assert cli(*args, "--resume", "out").code == 0
    assert Store(here / "out").episodes() == kept


@pytest.mark.slow
def test_a_kill_loses_the_episode_in_flight_and_no_other(background, cli, suite, here, eventually):
    name = suite(seeds=4)

    def finished():
        try:
            return [e.seed for e in Store(here / "out").episodes()]
        except Exception:
            return []

    with background("bench", name, "--out", "out") as process:
        eventually(lambda: len(finished()) >= 1, 60)
        process.send_signal(signal.SIGKILL)
        process.wait()
    kept = finished()
    assert 1 <= len(kept) < 4
    began = times(here / "out")
    result = cli("bench", name, "--resume", "out", "--json")
    assert result.code == 0, result.stderr
    assert [e["seed"] for e in result.json["episodes"]] == [0, 1, 2, 3]
    for seed in kept:
        folder = f"drawing-star.proc3s.best.seed{seed}"
        assert times(here / "out")[folder] == began[folder]
    with sqlite3.connect(here / "out" / FILE) as table:
        assert table.execute("SELECT count(*) FROM episodes").fetchone() == (4,)


@pytest.mark.slow
def test_ctrl_c_leaves_a_folder_to_go_on_with(background, cli, suite, here, eventually):
    name = suite(seeds=4)
    with background("bench", name, "--out", "out") as process:
        eventually(lambda: list(here.glob("out/runs/*/prompt-0.md")), 60)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
    assert process.returncode == 130, said
    assert "go on with --resume out" in said
    assert (here / "out/results.md").is_file()
    assert cli("bench", name, "--resume", "out").code == 0
    assert len(read_results(here / "out").all) == 4


@pytest.mark.slow
def test_a_provider_that_fails_is_asked_again_later(cli, suite, here):
    """Without a bundled answer `replay` fails as a provider does: nothing is kept as done."""
    name = suite(methods=["cap", "proc3s"], seeds=2)
    failed = cli("bench", name, "--out", "out")
    assert failed.code == 3
    assert "no answer is bundled for drawing/star" in failed.stderr
    assert "1 episode is not finished" in failed.stderr
    assert [one.word for one in Store(here / "out").unfinished()] == ["error"]
    assert len(Store(here / "out").episodes()) == 3


@pytest.mark.slow
def test_an_episode_that_ended_as_the_suite_was_killed_is_taken_as_it_is(cli, suite, here):
    assert cli("bench", suite(seeds=1), "--out", "out").code == 0
    (kept,) = Store(here / "out").episodes()
    with sqlite3.connect(here / "out" / FILE) as table:
        table.execute("DELETE FROM episodes")
    began = times(here / "out")
    assert cli("bench", suite(seeds=1), "--resume", "out").code == 0
    (again,) = Store(here / "out").episodes()
    assert times(here / "out") == began
    same = ("cell", "samples", "goal_reached", "prompt_sha256", "source", "violations")
    assert [getattr(again, name) for name in same] == [getattr(kept, name) for name in same]


@pytest.mark.slow
def test_what_changed_since_is_said(cli, suite, here):
    assert cli("bench", suite(seeds=1), "--out", "out").code == 0
    store = Store(here / "out")
    facts = store.facts()
    store.note({"versions": {**facts["versions"], "proc3s": "0.0.1"}})
    with sqlite3.connect(here / "out" / FILE) as table:
        table.execute("UPDATE episodes SET document = json_set(document, '$.prompt_sha256', 'other')")
    said = cli("bench", suite(seeds=2), "--resume", "out").stderr
    assert "the suite is not as it was: seeds changed" in said
    assert "other versions are installed: proc3s 0.0.1 -> " in said
    assert "these prompts are not as they were: drawing/star proc3s best" in said
    assert [e.seed for e in Store(here / "out").episodes()] == [0, 1]
    again = cli("bench", suite(seeds=2), "--resume", "out").stderr
    assert "the suite is not" not in again
    assert "other versions" not in again


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (["papr"], "there is no benchmark 'papr'; did you mean 'paper'?"),
        (["mine.yml"], "there is no suite mine.yml"),
        (["smoke", "--tasks", "drawing/stars"], "has no task 'drawing/stars'; did you mean 'drawing/star'?"),
        (["smoke", "--methods", "capp"], "there is no method 'capp'; did you mean 'cap'?"),
        (["smoke", "--preset", "bst"], "there is no preset 'bst'"),
        (["smoke", "--resume", "nothing"], "nothing has no results of a suite"),
        (["smoke", "--llm", "nobody/nothing", "-L", "x"], "an option is given as key=value"),
    ],
)
def test_mistakes_are_said(cli, args, words):
    result = cli("bench", *args)
    assert (result.code, words in result.stderr) == (2, True), result.stderr


def test_a_mistake_in_a_suite_names_its_line(cli, here):
    (here / "mine.yaml").write_text("name: mine\nsummary: Mine.\ntasks: [drawing/star]\nmethod: [cap]\n")
    said = cli("bench", "mine.yaml").stderr
    assert "mine.yaml:4: method: unknown key 'method'; did you mean 'methods'?" in said


@pytest.mark.slow
def test_results_are_not_begun_twice(cli, suite):
    name = suite(seeds=1)
    assert cli("bench", name, "--out", "out").code == 0
    again = cli("bench", name, "--out", "out")
    assert (again.code, "go on with them by --resume out" in again.stderr) == (2, True)


def test_the_shipped_suites_name_what_there_is(cli):
    from proc3s.plugins.registry import open_registry
    from proc3s.specs.parts import MethodSpec, PresetSpec
    from proc3s.specs.suite import SuiteSpec
    from proc3s.suites.results import read_figures

    registry = open_registry()
    suites = registry.all(SuiteSpec)
    assert {"paper", "release", "best", "smoke"} <= set(suites)
    for suite in suites.values():
        for task in suite.tasks:
            assert registry.task(task)[1].judge
        for method in suite.methods:
            registry.get(MethodSpec, method)
        for preset in suite.presets:
            registry.get(PresetSpec, preset)
    paper = suites["paper"]
    assert (len(paper.tasks), len(paper.methods), paper.seeds) == (10, 7, 10)
    figures = read_figures(paper.figures_file)
    assert len(figures) == 320
    assert figures["success_percent", "proc3s", "ycb/packing"] == (60.0, None)


def test_a_suite_of_a_file_runs_its_seeds_outermost(suite, here):
    cells = list(load_suite(here / suite(methods=["cap", "proc3s"], seeds=2)).cells())
    assert [(c.method, c.seed) for c in cells] == [("cap", 0), ("proc3s", 0), ("cap", 1), ("proc3s", 1)]


@pytest.mark.slow
def test_templates_of_ones_own_reach_every_episode(cli, suite, here):
    (here / "mine/partials").mkdir(parents=True)
    (here / "mine/partials/task.j2").write_text("A task in words of my own.\n")
    desk = ("--llm", "manual:desk", "-L", "wait=0")
    pending = cli("bench", suite(seeds=1), *desk, "--template-dir", "mine", "--out", "out")
    assert pending.code == 4, pending.stderr
    (prompt,) = here.glob("desk/*.prompt.md")
    assert "A task in words of my own." in prompt.read_text()
