"""Tables, files, comparison and people's verdicts, from episodes that are made up."""

import csv
import io
import json
import sqlite3

import pytest

from browser import needs_chromium, visiting
from proc3s import UsageError
from proc3s.plugins.registry import open_registry
from proc3s.specs.suite import Cell, SuiteSpec
from proc3s.suites.comparison import comparison
from proc3s.suites.episode import Episode
from proc3s.suites.export import FIGURES, write_files
from proc3s.suites.outcomes import Unfinished
from proc3s.suites.results import read_results
from proc3s.suites.runner import remaining
from proc3s.suites.store import FILE, Store

TASKS = ("drawing/star", "drawing/letters")
MARK = "<script>document.title = 'reason'</script>"


def spec(**more):
    given = {"name": "mine", "summary": "Mine.", "tasks": TASKS, "methods": ("cap", "proc3s"), "seeds": 10}
    return SuiteSpec.model_validate({**given, **more})


def episode(task, method, seed, reached, **more):
    given = {
        "source": "live",
        "model": "tiny-2026",
        "answered": "2026-11-01T10:00:00+00:00",
        "llm_seconds": 2.0,
    }
    given |= {"judged": True, "solved": True, "executed": "solution", "goal_reason": MARK}
    given |= {
        "prompt_sha256": "ab" * 32,
        "samples": 10 + seed,
        "seconds": {"solve": 1.0, "total": 3.0 + seed},
    }
    given |= {
        "prompt_tokens": 1000,
        "completion_tokens": 200,
        "cost": 0.01,
        "violations": {"collision": seed},
    }
    place = {
        "task": task,
        "method": method,
        "preset": "best",
        "seed": seed,
        "run_dir": f"runs/{task[-4:]}{method}{seed}",
    }
    return Episode.model_validate({**given, **place, "goal_reached": reached, **more})


def filled(folder, episodes, suite=None, figures=None):
    """The folder of a suite with these results."""
    folder.mkdir(exist_ok=True)
    store = Store(folder, make=True)
    store.note({"spec": (suite or spec()).model_dump(mode="json"), "began": "2026-11-01"})
    for one in episodes:
        store.add(one)
    if figures:
        (folder / FIGURES).write_text(figures)
    return folder


@pytest.fixture
def folder(tmp_path):
    """cap succeeds with 2 of 10 stars and all letters, proc3s with 9 of 10 and all."""
    episodes = [episode(t, "cap", s, t != TASKS[0] or s < 2) for t in TASKS for s in range(10)]
    episodes += [episode(t, "proc3s", s, t != TASKS[0] or s < 9) for t in TASKS for s in range(10)]
    figures = "quantity,method,domain,task,mean,std\nsuccess_percent,proc3s,drawing,star,80,\n"
    figures += "ccsp_samples,proc3s,drawing,star,31,4\n"
    return filled(tmp_path / "suite", episodes, figures=figures)


def made(folder):
    """The tables of a folder by title, lines by their first cell."""
    tables = write_files(read_results(folder), folder, open_registry())
    return {t.title: {line[0]: line[1:] for line in t.lines} for t in tables}


def test_success_has_intervals_the_best_in_bold_and_the_published_figure(folder):
    success = made(folder)["Success, %"]
    assert success["cap"] == ("20 [6, 51]", "**100 [72, 100]**")
    assert success["proc3s"] == ("**90 [60, 98]**", "**100 [72, 100]**")
    assert success["· published"] == ("80", "")


def test_six_tables_and_what_the_paper_leaves_out(folder):
    tables = made(folder)
    assert [*tables] == [
        *("Success, %", "Outcomes", "Samples", "Search, s", "Total, s", "Feedback rounds", "LLM, s"),
        *("Beside that", "First violations of samples"),
    ]
    assert tables["Outcomes"]["cap"] == ("12", "8", "0", "0", "0")
    assert tables["Samples"]["cap"][0] == "14 ± 3"
    assert tables["Samples"]["· published"] == ("31 ± 4", "")
    assert tables["Total, s"]["cap"][0] == "7.50 ± 3.03"
    assert tables["LLM, s"]["cap"] == ("2.00 ± 0.00",) * 2
    assert tables["Beside that"]["cap"] == ("20", "20", "8", "0", "1,000", "200", "0.2000")
    assert tables["First violations of samples"]["cap"] == ("90",)


def test_no_rate_is_made_of_answers_written_by_hand(tmp_path):
    own = [episode(t, m, 0, True, source="authored") for t in TASKS for m in ("cap", "proc3s")]
    folder = filled(tmp_path / "hand", own)
    assert made(folder)["Success, %"]["cap"] == ("1/1 by hand",) * 2
    text = (folder / "results.md").read_text()
    assert "4 episodes use answers that were written by hand: no success rate is made of them." in text
    assert "%" not in json.dumps(json.loads((folder / "results.json").read_text())["tables"][0]["lines"])


def test_a_recorded_model_is_named_with_date_and_prompt_and_what_was_dropped(tmp_path):
    old = [episode(TASKS[0], "cap", s, True, source="recorded", dropped=("seed",)) for s in range(3)]
    text = "\n".join(json.loads(made_json(filled(tmp_path / "old", old)))["origin"])
    assert "3 episodes: recorded answers of tiny-2026, answered 2026-11-01" in text
    assert "abababababab" in text
    assert "In 3 episodes the provider did not take the parameter `seed`" in text


def made_json(folder):
    made(folder)
    return (folder / "results.json").read_text()


def test_what_is_not_judged_or_not_known_is_said(tmp_path):
    free = [episode(TASKS[0], "cap", 0, None, judged=False, cost=None, prompt_tokens=None)]
    tables = made(filled(tmp_path / "free", free))
    assert tables["Success, %"]["cap"] == ("not judged", "")
    assert tables["Beside that"]["cap"][4] == "?"
    assert tables["Beside that"]["cap"][6] == "?"


def test_a_sum_with_an_unknown_part_is_said_to_be_at_least_that(tmp_path):
    some = [episode(TASKS[0], "cap", s, True, cost=None if s else 0.01) for s in range(3)]
    some += [episode(TASKS[1], "cap", s, True, prompt_tokens=None) for s in range(1)]
    folder = filled(tmp_path / "some", some)
    line = made(folder)["Beside that"]["cap"]
    assert line[6] == "at least 0.0200"
    assert line[4] == "1,000 (of 3 known)"
    episodes = json.loads((folder / "results.json").read_text())["episodes"]
    assert [e["cost"] for e in episodes if e["task"] == TASKS[0]] == [0.01, None, None]
    rows = list(csv.DictReader(io.StringIO((folder / "results.csv").read_text())))
    assert [row["cost"] for row in rows if row["task"] == TASKS[0]] == ["0.01", "", ""]


def test_an_episode_without_a_plan_is_a_failure_if_there_is_a_judge(tmp_path):
    none = [episode(TASKS[0], "cap", 0, None, solved=False, executed="none")]
    tables = made(filled(tmp_path / "none", none))
    assert tables["Success, %"]["cap"][0].startswith("**0 [")
    assert tables["Outcomes"]["cap"] == ("0", "0", "1", "0", "0")


ENDINGS = {
    ("goal reached", None): {"reached": True},
    ("goal missed", None): {"reached": False},
    ("no plan", None): {"reached": None, "solved": False, "executed": "none"},
    ("out of budget", "--max-cost is spent"): "budget",
    ("out of time", "broken off after 60 s"): "time",
    ("error", "no such key"): "llm",
}


@pytest.fixture
def endings(tmp_path):
    """A suite whose episodes all end otherwise, the seed saying how."""
    folder = filled(tmp_path / "ends", [], spec(tasks=TASKS[:1], methods=("cap",)))
    store = Store(folder)
    for seed, ((_, error), how) in enumerate(ENDINGS.items()):
        if isinstance(how, str):
            store.leave(Unfinished(Cell(TASKS[0], "cap", "best", seed), how, error))
        else:
            store.add(episode(TASKS[0], "cap", seed, **how))
    return folder


def test_what_could_not_be_carried_out_is_told_from_failures_everywhere(endings, cli):
    tables = made(endings)
    assert tables["Success, %"]["cap"] == ("**33 [6, 79]**",)
    words = [word for word, _ in ENDINGS]
    assert json.loads((endings / "results.json").read_text())["tables"][1]["head"] == ["method", *words]
    assert tables["Outcomes"]["cap"] == ("1",) * 6
    rows = list(csv.DictReader(io.StringIO((endings / "results.csv").read_text())))
    assert [(row["outcome"], row["error"]) for row in rows] == [(w, e or "") for w, e in ENDINGS]
    data = json.loads((endings / "results.json").read_text())
    assert [e["outcome"] for e in (*data["episodes"], *data["unfinished"])] == words
    assert "3 episodes could not be carried out and count in no rate" in (endings / "results.md").read_text()
    page = (endings / "results.html").read_text()
    for word, error in ENDINGS:
        assert word in page
        assert error is None or error in page
    compared = cli("compare", endings, endings, "--json").json
    assert [(line["outcome"], line["A"], line["B"]) for line in compared["outcomes"]] == [
        (word, "1", "1") for word in words
    ]
    assert compared["differences"][0]["pairs"] == "3"


def test_the_judge_says_what_there_is_nothing_to_see_of(endings):
    from typer.testing import CliRunner

    from proc3s.cli import app

    run = endings / read_results(endings).all[0].episode.run_dir
    run.mkdir(parents=True)
    options = {"task": TASKS[0], "plugins": []}
    (run / "events.jsonl").write_text(json.dumps({"event": "run_started", "options": options}) + "\n")
    said = CliRunner().invoke(app, ["judge", str(endings)], input="q\n").output
    assert "nothing to look at: 1 no plan, 1 out of budget, 1 out of time, 1 error" in said
    assert "2 outcomes" in said


def test_a_table_with_nothing_in_it_is_left_out(tmp_path):
    nothing = filled(tmp_path / "pending", [])
    Store(nothing).leave(Unfinished(Cell(TASKS[0], "cap", "best", 0), "pending", "an answer is awaited"))
    assert list(made(nothing)) == ["Outcomes"]
    by_hand = filled(
        tmp_path / "hand", [episode(TASKS[0], "cap", 0, True, source="authored", llm_seconds=None)]
    )
    assert not {"LLM, s"} & set(made(by_hand))


def test_an_episode_that_is_finished_later_replaces_its_reason(endings):
    store = Store(endings)
    (broken,) = (one for one in store.unfinished() if one.word == "error")
    store.add(episode(TASKS[0], "cap", broken.cell.seed, True))
    assert broken.cell not in [one.cell for one in store.unfinished()]
    assert broken.cell in [one.cell for one in store.episodes()]


def test_a_store_of_an_earlier_version_opens_and_its_errors_are_no_failures(tmp_path):
    """It kept what could not be carried out among the finished episodes, and had no table for it."""
    old = [episode(TASKS[0], "cap", 0, True)]
    old += [episode(TASKS[0], "cap", 1, None, solved=False, executed="none", error="needs a key")]
    folder = filled(tmp_path / "old", old)
    with sqlite3.connect(folder / FILE) as table:
        table.execute("DROP TABLE unfinished")
    assert made(folder)["Success, %"]["cap"][0].startswith("**100 [")
    assert [(one.word, one.error) for one in read_results(folder).unfinished] == [("error", "needs a key")]
    assert Cell(TASKS[0], "cap", "best", 1) in remaining(spec(), Store(folder))
    Store(folder).add(episode(TASKS[0], "cap", 1, True))
    assert Store(folder).unfinished() == []
    assert len(Store(folder).episodes()) == 2


def test_the_rows_as_csv(folder):
    made(folder)
    rows = list(csv.DictReader(io.StringIO((folder / "results.csv").read_text())))
    assert len(rows) == 40
    assert (rows[0]["task"], rows[0]["seconds.total"], rows[0]["goal_reached"]) == (TASKS[0], "3.0", "True")


@needs_chromium
def test_the_page_shows_it_and_asks_nobody(folder):
    made(folder)
    with visiting() as visit:
        seen = visit((folder / "results.html").as_uri())
        text = seen.page.inner_text("body")
        assert seen.page.title() == "mine: results"
        assert seen.page.locator(".gallery figure").count() == 40
        assert seen.page.locator("img.chart").evaluate_all("all => all.every(one => one.naturalWidth > 100)")
        assert MARK in text
        assert [url for url in seen.requests if not url.startswith(("file:", "data:"))] == []
        assert seen.complaints == []


@pytest.mark.slow
@needs_chromium
def test_a_card_leads_to_the_report_of_its_run_and_none_leads_nowhere(cli, here):
    run = "runs/drawing-star.proc3s.best.seed0"
    assert cli("run", TASKS[0], "--out", f"suite/{run}").code == 0
    folder = filled(
        here / "suite",
        [episode(TASKS[0], "proc3s", 0, True, run_dir=run), episode(TASKS[0], "proc3s", 1, True)],
    )
    made(folder)
    with visiting() as visit:
        page = visit((folder / "results.html").as_uri()).page
        assert page.locator(".gallery figure").count() == 2
        assert page.locator(".gallery a").count() == 2  # the picture, and the word below it
        page.click(".gallery a")
        assert page.url == (folder / run / "report.html").as_uri()
        assert TASKS[0] in page.title()
    written = (folder / run / "report.html").stat().st_mtime_ns
    made(folder)
    assert (folder / run / "report.html").stat().st_mtime_ns == written


@pytest.mark.slow
def test_a_person_overrules_the_judge(folder, cli):
    from typer.testing import CliRunner

    from proc3s.cli import app

    for one in read_results(folder).all:
        run = folder / one.episode.run_dir
        run.mkdir(parents=True, exist_ok=True)
        options = {"task": one.episode.task, "plugins": []}
        (run / "events.jsonl").write_text(json.dumps({"event": "run_started", "options": options}) + "\n")
    result = CliRunner().invoke(app, ["judge", str(folder)], input="y\nlooks right\nn\n\ns\nq\n")
    assert result.exit_code == 0, result.output
    assert "Draw a star with at least five points." in result.output
    assert f"machine  goal reached: {MARK}" in result.output
    assert "2 verdicts kept" in result.output
    results = {r.episode.cell: r for r in read_results(folder).all if r.verdict}
    verdicts = [(r.episode.goal_reached, r.success, r.verdict.why) for r in results.values()]
    assert sorted(verdicts) == [(True, False, ""), (True, True, "looks right")]
    assert json.loads((folder / "results.json").read_text())["episodes"][0]["human"] is not None
    again = CliRunner().invoke(app, ["judge", str(folder)], input="q\n")
    assert "38 outcomes" in again.output


def test_two_suites_are_compared_pair_by_pair(folder, tmp_path, cli):
    other = [episode(TASKS[0], "cap", s, s < 5, samples=5 + s) for s in range(10)]
    second = filled(tmp_path / "second", other)
    lines = cli("compare", folder, second, "--json").json["differences"]
    assert [(line["task"], line["pairs"]) for line in lines] == [("drawing/star", "10")]
    assert lines[0]["samples"] == "-5.00 [-5.00, -5.00]"
    assert lines[0]["success, points"].startswith("+30 [")
    assert "drawing/star" in cli("compare", folder, second).stdout


def test_two_methods_of_one_suite_each_are_compared_too(tmp_path, cli):
    one = filled(tmp_path / "one", [episode(TASKS[0], "cap", s, s < 5) for s in range(10)])
    two = filled(tmp_path / "two", [episode(TASKS[0], "proc3s", s, True) for s in range(10)])
    (line,) = cli("compare", one, two, "--json").json["differences"]
    assert line["success, points"].startswith("+50 [")


def test_what_cannot_be_compared_is_said(folder, tmp_path, cli):
    other = filled(tmp_path / "other", [episode("blocks/line", "cap", 0, True)])
    assert "no task, method and seed in common" in cli("compare", folder, other).stderr
    result = cli("compare", folder, tmp_path)
    assert (result.code, "has no results of a suite" in result.stderr) == (2, True)


def test_an_episode_is_kept_once(folder):
    with pytest.raises(UsageError, match="another process has finished"):
        Store(folder).add(episode(TASKS[0], "cap", 0, True))


def test_stale_answers_have_a_table_of_their_own(tmp_path):
    star = TASKS[0]
    episodes = [episode(star, "cap", s, True) for s in range(5)]
    episodes += [episode(star, "cap", s, False, stale=True) for s in range(5, 10)]
    folder = filled(tmp_path / "suite", episodes)
    tables = made(folder)
    assert tables["Success, %"]["cap"][0] == "**100 [57, 100]**"
    assert tables["Success with answers to earlier prompts, %"]["cap"][0] == "**0 [0, 43]**"
    assert tables["Samples"]["cap"][0].startswith("12 ")
    assert tables["Beside that"]["cap"][0] == "5"
    document = json.loads((folder / "results.json").read_text())
    assert any("5 episodes use answers to earlier prompts" in sentence for sentence in document["origin"])
    assert sum(one["stale"] for one in document["episodes"]) == 5


def test_without_stale_answers_there_is_no_such_table(folder):
    assert not [title for title in made(folder) if "earlier" in title]


def test_stale_answers_say_nothing_in_a_comparison(tmp_path):
    fresh = filled(tmp_path / "a", [episode(TASKS[0], "cap", s, True) for s in range(4)])
    stale = filled(tmp_path / "b", [episode(TASKS[0], "cap", s, False, stale=True) for s in range(4)])
    assert "Success, %" not in made(stale)
    (line,) = comparison(read_results(fresh), read_results(stale)).lines
    assert line[2] == "to earlier prompts"
