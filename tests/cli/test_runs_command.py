"""Which runs there are, and which one is meant where none is named."""

import pytest

import proc3s
from proc3s.plugins.versions import versions
from proc3s.runs.events import RunEnded, RunStarted
from proc3s.runs.folder import RunFolder
from proc3s.runs.newest import link_latest, newest_run

STAR = {"task": "drawing/star", "method": "proc3s", "llm": "replay", "seed": 0}
ENDS = {
    "solved": {"solved": True, "error": None, "samples": 7},
    "unsolved": {"llm": "replay", "solved": False, "error": None, "samples": 1200, "goal_reached": False},
    "error": {"solved": False, "error": "no key", "stopped": "llm", "samples": 0},
    "interrupted": {"solved": False, "error": "interrupted", "stopped": "interrupted", "samples": 3},
}


@pytest.fixture
def begin(here):
    """Begins a run below `runs`; gives its folder, still open."""
    opened = []

    def start(name, **options):
        folder = RunFolder(here / "runs" / name)
        opened.append(folder)
        folder.emit(RunStarted(options={**STAR, **options}, versions=versions(), samples=5, scene="{}"))
        return folder

    yield start
    for folder in opened:
        folder.close()


@pytest.fixture
def run(begin):
    """A run that ended in one of the ways of ENDS, or not at all."""

    def make(name, end=None, **options):
        folder = begin(name, **options)
        if end:
            folder.emit(RunEnded(summary=ENDS[end]))
        folder.close()

    return make


def test_every_outcome_by_its_name_the_newest_first(cli, here, begin, run):
    for end in ENDS:
        run(end, end)
    run("cut-off")
    begin("under-way")
    (here / "runs" / "notes").mkdir()
    (here / "runs" / "torn").mkdir()
    (here / "runs" / "torn" / "events.jsonl").write_text("{}\n")
    listed = [(one["folder"], one["outcome"]) for one in cli("runs", "--json").json]
    assert listed == [
        ("runs/under-way", "at work"),
        ("runs/cut-off", "broken off"),
        ("runs/interrupted", "broken off"),
        ("runs/error", "error"),
        ("runs/unsolved", "unsolved"),
        ("runs/solved", "solved"),
        ("runs/torn", "unreadable"),
    ]


def test_a_list_for_people_says_what_and_where(cli, run, monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    run("first", "unsolved", method="cap", task="drawing/arrow")
    run("second", "error")
    shown = cli("runs").stdout
    assert shown.index("error     runs/second") < shown.index("unsolved  runs/first")
    for part in ("drawing/arrow, cap, replay", "1,200 samples", "goal missed", "no key"):
        assert part in shown


DAMAGED = [b"\n", b"no json\n", b'[1]\n{"event": 1}\n', b"\xff\xfe\n", b"[" * 9999 + b"\n"]


@pytest.mark.parametrize("log", DAMAGED)
def test_a_damaged_log_is_unreadable(cli, here, log):
    (here / "runs" / "torn").mkdir(parents=True)
    (here / "runs" / "torn" / "events.jsonl").write_bytes(log)
    done = cli("runs")
    assert (done.code, "unreadable  runs/torn" in done.stdout) == (0, True)


def test_no_name_of_a_folder_is_cut(cli, run, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    long = "20260101-120000-" + "x" * 120
    run(long, "solved")
    run("20260101-120000-drawing-enclose-three-llm3-gaussian-seed0", "solved", task="drawing/enclose-three")
    lines = cli("runs").stdout.splitlines()
    assert any(line.rstrip().endswith(f"runs/{long}") for line in lines)
    assert all(len(line.rstrip()) <= 80 for line in lines if long not in line)


def test_at_most_so_many_runs_are_shown(cli, run):
    for number in range(12):
        run(f"run-{number:02}", "solved")
    assert cli("runs").stdout.count("runs/run-") == 10
    assert "2 older runs not shown: --limit 0 shows all" in cli("runs").stdout
    assert [one["folder"] for one in cli("runs", "--limit", 1, "--json").json] == ["runs/run-11"]
    assert cli("runs", "--limit", 0).stdout.count("runs/run-") == 12


def test_a_suite_is_a_line_and_its_folder_lists_its_runs(cli, here, run):
    run("alone", "solved")
    run("bench-x/runs/episode", "unsolved")
    (here / "runs" / "bench-x" / "episodes.sqlite").touch()
    shown = cli("runs").stdout
    assert "runs/alone" in shown
    assert "episode " not in shown
    assert "suite: runs/bench-x (`proc3s runs runs/bench-x` lists its runs)" in shown
    assert [one["folder"] for one in cli("runs", "runs/bench-x", "--json").json] == [
        "runs/bench-x/runs/episode"
    ]


def test_without_any_run_it_says_how_to_begin(cli, here):
    for command in ("runs", "explain", "report", "replay"):
        done = cli(command)
        assert done.code == 2
        assert "there is no run in runs" in done.stderr
        assert "proc3s run " in done.stderr
    with pytest.raises(proc3s.UsageError, match="there is no run in runs"):
        proc3s.load_run()
    assert cli("runs", "--json").json == []


def test_the_newest_run_is_the_default_and_named_on_stderr(cli, here, run):
    cli("run", "drawing/star", "--out", "runs/older")
    cli("run", "drawing/star", "--seed", 3, "--out", "runs/newer")
    explained = cli("explain")
    assert explained.stdout.startswith("drawing/star, seed 3")
    assert explained.stderr == "proc3s: the newest run, runs/newer\n"
    assert cli("report").stdout == "runs/newer/report.html\n"
    assert cli("replay", "--json").json["seed"] == 3
    assert proc3s.load_run().summary.task == "drawing/star"


def test_latest_leads_to_the_run_that_began_last(cli, here):
    cli("run", "drawing/star", "--out", "runs/older")
    cli("run", "drawing/star", "--seed", 3, "--out", "runs/newer")
    assert (here / "runs" / "latest").resolve().name == "newer"
    explained = cli("explain", "latest").stdout
    assert explained.startswith("drawing/star, seed 3")
    assert explained == cli("explain", "newer").stdout == cli("explain", "runs/latest").stdout
    cli("run", "drawing/star", "--out", "elsewhere/run")
    assert not (here / "elsewhere" / "latest").exists()
    assert newest_run() == newest_run().parent / "newer"
    names = [one["folder"] for one in cli("runs", "--json").json]
    assert names == ["runs/newer", "runs/older"]


@pytest.mark.parametrize("kind", ["file", "folder"])
def test_what_is_called_latest_already_stays(cli, here, kind):
    taken = here / "runs" / "latest"
    taken.parent.mkdir()
    taken.mkdir() if kind == "folder" else taken.write_text("mine")
    assert cli("run", "drawing/star", "--out", "runs/one").code == 0
    assert not taken.is_symlink()
    assert taken.is_dir() == (kind == "folder")
    assert cli("explain").stderr == "proc3s: the newest run, runs/one\n"


def test_a_file_system_without_links_goes_without(here, run, monkeypatch):
    def refuse(*_):
        raise OSError(95, "Operation not supported")

    monkeypatch.setattr("pathlib.Path.symlink_to", refuse)
    run("one", "solved")
    link_latest(here / "runs" / "one")
    assert [path.name for path in (here / "runs").iterdir()] == ["one"]
    assert newest_run().name == "one"


def test_a_run_that_goes_on_by_its_link_keeps_its_folder(cli, here):
    cli("run", "drawing/star", "--out", "runs/one")
    log = here / "runs" / "one" / "events.jsonl"
    lines = log.read_text().splitlines(keepends=True)
    log.write_text("".join(line for line in lines[:-1] if '"round_ended"' not in line))
    assert cli("runs", "--json").json[0]["outcome"] == "broken off"
    done = cli("run", "--resume", "runs/latest", "--json")
    assert (done.code, done.json["run_dir"]) == (0, "runs/one")
    assert (here / "runs" / "latest").resolve().name == "one"
