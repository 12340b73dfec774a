"""The benchmark measures what a run would do, compares by seed, and keeps what it has."""

import json
import signal

import numpy as np
import pytest

from proc3s.benchmark.cases import find_cases
from proc3s.benchmark.measurement import PLAIN, STAGES, Measurement, SearchVariant
from proc3s.benchmark.statistics import rows
from proc3s.benchmark.throughput import Bench
from proc3s.plugins.registry import open_registry

REGISTRY = open_registry()
CASES = find_cases(REGISTRY)


def case(label):
    return next(c for c in CASES if c.label == label)


def test_every_drawing_task_has_two_programs():
    tasks = [c.task for c in CASES]
    for task in ("star", "arrow", "letters", "enclosed", "free"):
        assert tasks.count(f"drawing/{task}") >= 2
    assert case("drawing/star.crowd").scene["count"] == "100"


def _marked(label):
    """In a simulator a search takes seconds."""
    return pytest.param(label, marks=[] if label.startswith("drawing/") else [pytest.mark.slow])


@pytest.mark.parametrize("label", [_marked(c.label) for c in CASES])
def test_every_program_can_be_searched(label):
    with Bench(REGISTRY, [SearchVariant("saving", "rejection")], samples=64) as bench:
        plain, saving = bench.search(case(label), 0)
    assert (plain.error, saving.error) == (None, None)
    assert (plain.solved, plain.samples) == (saving.solved, saving.samples)
    assert plain.evaluations == plain.samples
    assert saving.evaluations == saving.samples - sum(saving.rejected_by.values())


def test_strokes_are_ten_lines_with_parameters_of_their_own():
    from proc3s.planning.grounding import open_sketch
    from proc3s.search.influence import influence

    with Bench(REGISTRY, []) as bench:
        strokes = case("drawing/free.strokes")
        with open_sketch(bench._setup(strokes, 0, PLAIN), strokes.program) as opened:
            assert opened.sketch.space.dim == 40
            assert sorted(influence(opened.sketch).values()) == sorted(list(range(10)) * 4)


def test_throughput_takes_every_sample_and_splits_the_time():
    with Bench(REGISTRY, []) as bench:
        plain, screened = bench.throughput(case("drawing/star.open"), 0, 1500)
    for measured in (plain, screened):
        assert measured.samples == 1500
        assert set(measured.cpu) == set(STAGES)
        assert measured.cpu["program"] > 0
        assert measured.cpu["world"] > 0
    assert screened.total < plain.total
    assert screened.cpu["screens"] > plain.cpu["screens"]


def made(way, seed, solved, samples, cpu):
    stages = {"program": cpu, "screens": 0.0, "world": 0.0, "other": 0.0}
    return Measurement("a/b.c", way, seed, solved, samples, samples, {}, stages, wall=1.0)


def test_ratios_pair_seeds():
    measured = [
        *(made("plain", seed, True, 100 * 2**seed, 1.0 * 2**seed) for seed in range(3)),
        *(made("fast", seed, True, 50 * 2**seed, 0.25 * 2**seed) for seed in range(3)),
    ]
    plain, fast = rows(measured)
    assert plain.fewer_samples is None
    assert fast.fewer_samples.model_dump() == pytest.approx(
        {"mean": 2.0, "low": 2.0, "high": 2.0, "seeds": 3, "at_least": False}
    )
    assert fast.faster_per_solution.mean == pytest.approx(4.0)
    assert fast.faster_per_sample.mean == pytest.approx(2.0)
    assert fast.samples == 100
    assert fast.us_per_sample["program"] == pytest.approx(5000)
    assert fast.s_per_solution["total"] == pytest.approx(1.75 / 3)


def test_what_the_plain_path_did_not_solve_is_a_lower_bound():
    measured = [made("plain", 0, False, 1000, 1.0), made("fast", 0, True, 10, 0.1)]
    row = rows(measured)[1]
    assert row.fewer_samples.at_least
    assert str(row.fewer_samples) == "≥100 [100, 100]"
    assert not row.faster_per_sample.at_least


def test_what_a_way_did_not_solve_is_no_ratio():
    row = rows([made("plain", 0, True, 10, 1.0), made("slow", 0, False, 1000, 1.0)])[1]
    assert (row.fewer_samples, row.faster_per_solution, row.s_per_solution) == (None, None, None)
    assert row.solved == 0


def test_intervals_hold_the_mean_and_repeat():
    rng = np.random.default_rng(0)
    measured = []
    for seed in range(8):
        measured += [
            made("plain", seed, True, 100, 1.0),
            made("fast", seed, True, 100, rng.uniform(0.3, 0.7)),
        ]
    one, again = rows(measured)[1].faster_per_solution, rows(measured)[1].faster_per_solution
    assert one == again
    assert one.low < one.mean < one.high


QUICK = ("--tasks", "drawing/star.open", "--seeds", 2, "--samples", 100, "--throughput", 200)


def test_the_command_prints_a_table_and_writes_files(cli, here):
    result = cli("bench", "ccsp", *QUICK, "--solvers", "rejection", "--out", "results")
    assert result.code == 0
    assert "drawing/star.open" in result.stdout
    document = json.loads((here / "results/results.json").read_text())
    assert [(r["case"], r["way"]) for r in document["searches"]] == [
        ("drawing/star.open", "plain"),
        ("drawing/star.open", "rejection"),
    ]
    assert len(document["measurements"]["searches"]) == 4
    table = (here / "results/results.md").read_text()
    assert table.count("| drawing/star.open |") == 4


def test_json_is_one_document_and_jobs_mean_processes(cli, here):
    result = cli("bench", "ccsp", *QUICK, "--solvers", "rejection", "--jobs", 2, "--json")
    document = result.json
    assert result.stderr == ""
    assert document["options"]["executor"] == "processes"
    plain, _, parallel = document["searches"]
    assert [row["way"] for row in document["searches"]] == ["plain", "plain, 2 jobs", "rejection"]
    assert (plain["solved"], plain["samples"]) == (parallel["solved"], parallel["samples"])
    assert len(list(here.glob("runs/*/results.json"))) == 1


@pytest.mark.parametrize(
    ("args", "message"),
    [
        (("spped",), "there is no benchmark 'spped'"),
        (("ccsp", "--tasks", "drawing/stra"), "there is no benchmark program for 'drawing/stra'"),
        (("ccsp", "--solvers", "rejektion"), "there is no solver 'rejektion'; did you mean 'rejection'?"),
        (("ccsp", "--executor", "cloud"), "there is no executor 'cloud'"),
    ],
)
def test_unknown_names_are_one_line(cli, here, args, message):
    result = cli("bench", *args)
    assert result.code == 2
    assert message in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1
    assert not list(here.iterdir())


@pytest.mark.slow
def test_control_c_keeps_what_is_done(background, here):
    with background(
        "bench", "ccsp", "--tasks", "drawing/star.open", "--seeds", 10_000, "--out", "b"
    ) as process:
        for line in process.stderr:
            if "seed 2" in line:
                break
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=30)
    assert process.returncode == 130
    document = json.loads((here / "b/results.json").read_text())
    assert document["error"].startswith("interrupted")
    assert {m["seed"] for m in document["measurements"]["searches"]} >= {0, 1}


def test_a_program_of_no_task_is_named(tmp_path):
    from proc3s import UsageError
    from proc3s.benchmark.cases import _cases_of

    (tmp_path / "bench").mkdir()
    (tmp_path / "bench/stra.open.py").write_text("")
    spec = REGISTRY.domain("drawing").spec.in_folder(tmp_path)
    with pytest.raises(
        UsageError, match=r"stra\.open\.py: domain drawing has no task 'stra'; did you mean 'star'"
    ):
        list(_cases_of(spec))
