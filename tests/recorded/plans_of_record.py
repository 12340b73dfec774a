"""Plans that must stay as they are: `python tests/recorded/plans_of_record.py` writes them anew."""

import json
import tempfile
from pathlib import Path

FILE = Path(__file__).with_name("plans_of_record.json")
QUESTION = ("task", "seed", "llm", "preset", "solver")
ANSWER = ("samples", "evaluations", "plan")


def solved(problem, folder):
    """What a run of a problem came to: samples, evaluations by the world, and the first accepted plan."""
    from typer.testing import CliRunner

    from proc3s.cli import app

    options = ["--improve", "0"]
    options += [part for name in QUESTION[1:] for part in (f"--{name}", str(problem[name]))]
    if problem["llm"] == "recorded":
        options += ["-L", "stale=accept"]  # a prompt may change, what its program comes to may not
    done = CliRunner().invoke(app, ["run", problem["task"], *options, "--json", "--out", str(folder / "run")])
    summary = json.loads(done.stdout)
    assert summary["solved"], summary["error"] or summary["violations"]
    return {name: summary[name] for name in ANSWER}


def main():
    """Solve every problem of the file again and keep what comes of it."""
    lines = []
    for problem in json.loads(FILE.read_text(encoding="utf-8")):
        with tempfile.TemporaryDirectory() as folder:
            asked = {name: problem[name] for name in QUESTION}
            lines.append(json.dumps(asked | solved(problem, Path(folder))))
    FILE.write_text("[\n" + ",\n".join(lines) + "\n]\n", encoding="utf-8")


if __name__ == "__main__":
    main()
