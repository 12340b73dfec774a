"""What only a process of its own can show: imports, seconds, signals, keys."""

import json
import resource
import signal
import subprocess
import sys

import pytest

HEAVY = ("litellm", "pybullet", "matplotlib", "pymunk")
LONG = """
```python
def gen_plan(initial, x):
    return [Action("draw_line", [-1 - x, 1, 2, 2])]

def gen_domain(initial):
    return {"x": ContinuousSampler(0, 1)}
```
"""


@pytest.mark.parametrize(
    "args",
    [
        ["--help"],
        ["run", "--help"],
        ["list"],
        ["list", "tasks"],
        ["show", "drawing"],
        ["plugins"],
        ["schema", "domain"],
        ["render-prompt", "drawing/star"],
        ["render-prompt", "drawing/star", "--method", "cap", "--format", "json"],
    ],
)
def test_nothing_heavy_is_imported(here, args):
    code = (
        "import sys\nfrom proc3s.cli import app\n"
        f"try:\n    app({args!r})\nexcept SystemExit as end:\n    assert not end.code, end.code\n"
        f"print([name for name in {HEAVY!r} if name in sys.modules], file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert done.stderr.splitlines()[-1] == "[]"
    assert done.stdout


def cpu_seconds(code, *args):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, "-c", code, *args], capture_output=True, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def test_help_is_quick():
    """At most two and a half times what the libraries cost that it is declared and printed with."""
    libraries = "import typer.rich_utils, rich.markdown, pydantic, annotated_types"
    command = "from proc3s.cli import main; main()"
    pairs = [(cpu_seconds(command, "--help"), cpu_seconds(libraries)) for _ in range(3)]
    assert min(help_ / imports for help_, imports in pairs) <= 2.5


def test_a_plugin_author_imports_no_engine():
    code = "import sys, proc3s; print('numpy' in sys.modules, 'pydantic' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "False"]


@pytest.mark.slow
def test_no_display_is_needed(shell):
    result = shell("run", "drawing/star", "--json", env={"DISPLAY": "", "MPLBACKEND": "TkAgg"})
    assert result.code == 0, result.stderr


def test_no_key_of_the_environment_reaches_the_folder(shell, here):
    keys = {"OPENAI_API_KEY": "sk-planted", "ANTHROPIC_API_KEY": "sk-planted-too", "HF_TOKEN": "sk-planted-3"}
    result = shell("run", "drawing/star", "--json", "--out", "mine", env=keys)
    assert result.code == 0
    for path in (here / "mine").rglob("*"):
        assert b"sk-planted" not in path.read_bytes()
    assert "sk-planted" not in result.stdout + result.stderr


def test_a_program_cannot_read_the_environment(shell, stub):
    answer = LONG.replace(
        "return [", "raise ValueError(str(vars(__import__('os')).get('environ')))\n    return ["
    )
    result = shell(
        *("run", "drawing/star", "--json", "--llm", stub(answer), "--feedback", 0, "--samples", 3),
        env={"OPENAI_API_KEY": "sk-planted"},
    )
    assert result.code == 1
    assert "sk-planted" not in result.stdout + result.stderr


@pytest.mark.slow
def test_a_provider_that_is_not_there_is_exit_code_3(shell, here):
    result = shell(
        *("run", "drawing/star", "--llm", "openai/nothing", "-L", "api_base=http://127.0.0.1:9/v1", "--json"),
        env={"OPENAI_API_KEY": "sk-planted"},
    )
    assert result.code == 3
    assert result.json["error"].startswith("openai/nothing at http://127.0.0.1:9/v1: nobody answers")
    assert len(result.json["error"].splitlines()) == 1
    assert "Traceback" not in result.stderr
    for path in (here / result.json["run_dir"]).rglob("*"):
        assert b"sk-planted" not in path.read_bytes()


def batches(here, run):
    log = here / run / "events.jsonl"
    return log.read_bytes().count(b'"batch_evaluated"') if log.is_file() else 0


def test_control_c_while_sampling(background, eventually, here, stub, events):
    args = (
        "run",
        "drawing/star",
        "--preset",
        "paper",
        "--samples",
        5_000_000,
        "--llm",
        stub(LONG),
        "--out",
        "mine",
        "--json",
    )
    with background(*args) as process:
        eventually(lambda: batches(here, "mine") >= 3)
        process.send_signal(signal.SIGINT)
        stdout, stderr = process.communicate(timeout=20)
    assert process.returncode == 130, stderr
    assert "Traceback" not in stderr
    assert "interrupted" in stderr
    summary = json.loads(stdout)
    assert (summary["error"], summary["solved"], summary["run_dir"]) == ("interrupted", False, "mine")
    assert json.loads((here / "mine/summary.json").read_text()) == summary
    log = events(here / "mine")
    assert log[-1]["event"] == "run_ended"
    sampled = sum(len(e["accepted"]) for e in log if e["event"] == "batch_evaluated")
    assert summary["samples"] >= sampled > 0


def test_control_c_while_waiting_for_an_answer(background, eventually, here):
    with background("run", "drawing/star", "--llm", "manual:desk", "--out", "mine") as process:
        eventually(lambda: list(here.glob("desk/*.prompt.md")))
        process.send_signal(signal.SIGINT)
        _, stderr = process.communicate(timeout=20)
    assert process.returncode == 130
    assert "Traceback" not in stderr
    assert json.loads((here / "mine/summary.json").read_text())["error"] == "interrupted"


def test_kill_9_while_sampling_leaves_a_folder_that_can_be_read_and_replayed(
    background, eventually, here, stub, cli
):
    from proc3s.runs.reading import read_events

    args = (
        "run",
        "drawing/star",
        "--preset",
        "paper",
        "--samples",
        5_000_000,
        "--llm",
        stub(LONG),
        "--out",
        "mine",
    )
    with background(*args) as process:
        eventually(lambda: batches(here, "mine") >= 3)
        process.kill()
        process.wait(timeout=20)
    log = read_events(here / "mine")
    assert [e["event"] for e in log[:5]] == [
        "run_started",
        "prompt_rendered",
        "answer_received",
        "program_extracted",
        "sketch_loaded",
    ]
    assert sum(e["event"] == "batch_evaluated" for e in log) >= 3
    for name in ("prompt-0.md", "answer-0.md", "program-0.py"):
        assert (here / "mine" / name).read_text()
    assert not (here / "mine/summary.json").exists()
    again = cli("replay", "mine", "--samples", 100, "--json")
    assert (again.code, again.json["samples"]) == (1, 100)
    prompt = cli("render-prompt", "drawing/star", "--preset", "paper", "--diff", "mine")
    assert (prompt.code, prompt.stdout) == (0, "")


@pytest.mark.slow
def test_runs_that_begin_in_the_same_second_have_folders_of_their_own(background):
    from contextlib import ExitStack

    with ExitStack() as stack:
        runs = [stack.enter_context(background("run", "drawing/star", "--json")) for _ in range(4)]
        ended = [(run.communicate(timeout=60), run.returncode) for run in runs]
    assert [code for _, code in ended] == [0] * 4, [err for (_, err), _ in ended]
    assert len({json.loads(out)["run_dir"] for (out, _), _ in ended}) == 4


def test_progress_is_silent_when_nobody_watches(shell, stub):
    result = shell("run", "drawing/star", "--llm", stub(LONG), "--feedback", 0, "--samples", 3000)
    assert result.code == 1
    assert "\x1b" not in result.stdout + result.stderr
    assert "\r" not in result.stderr
