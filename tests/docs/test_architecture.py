"""The house keeps its rules, and its picture is that of the code."""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs" / "hooks"))

import architecture  # noqa: E402


def test_imports_go_down_only():
    lint = Path(sys.executable).with_name("lint-imports")
    done = subprocess.run([lint, "--no-cache"], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


def test_the_picture_is_up_to_date():
    assert architecture.PICTURE.read_text(encoding="utf-8") == architecture.svg(), architecture.__doc__


def test_every_room_says_what_it_is_for_and_the_page_knows_it():
    page = (ROOT / "docs" / "explanation" / "architecture.md").read_text(encoding="utf-8")
    rooms = [room for layer in architecture.layers() for room in layer]
    assert all(architecture.sentence(room) for room in rooms)
    told = ("cli", "api", "plugins", "domain", "planning", "prompts", "llm", "sandbox", "search", "feedback")
    assert all(room in rooms and f"`{room}`" in page for room in told)


FOREIGN = re.compile(
    r"\b(pybullet|pymunk|mujoco|litellm|openai|anthropic|table-?top|drawing|ycb|cap|llm3|ur5e|franka)\b",
    re.IGNORECASE,
)


def test_the_core_names_no_simulator_vendor_method_or_domain():
    """Examples in the help of commands do."""
    core = (ROOT / "src" / "proc3s").rglob("*.py")
    named = [
        f"{path}:{number}: {line.strip()}"
        for path in core
        if "cli" not in path.parts
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1)
        if FOREIGN.search(line)
    ]
    assert named == []
