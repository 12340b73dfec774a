"""Every example of the docs runs, and prints what the docs say it prints."""

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from provider import Provider

ROOT = Path(__file__).parents[2]
PAGES = sorted((ROOT / "docs").rglob("*.md"))
BLOCK = re.compile(
    r"(?:<!-- (?P<kind>file|exit): (?P<value>\S+) -->\n)?"
    r"^(?P<fence>`{3,})(?P<language>\w*)\n(?P<body>.*?)^(?P=fence)$",
    re.MULTILINE | re.DOTALL,
)


def run(command: str, folder: Path) -> tuple[int, str]:
    environment = {
        **os.environ,
        "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",
        "COLUMNS": "200",
    }
    done = subprocess.run(
        ["bash", "-c", f"{command} 2>&1"],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
    )
    return done.returncode, done.stdout


def as_pattern(lines: list[str]) -> str:
    """`...` stands for anything, on a line of its own also for any number of lines."""
    parts = [
        r"(?:.*\n)*?" if line == "..." else re.escape(line).replace(r"\.\.\.", ".*") + r"\n" for line in lines
    ]
    return "".join(parts)


LOCAL = "localhost:11434"
"""Where the docs say that a model server listens; a test puts one of its own in its place."""


@pytest.fixture
def model(provider: Provider) -> Provider:
    """A model that draws a star whatever it is asked."""
    provider.text = (ROOT / "domains/proc3s_drawing/answers/star.proc3s.md").read_text().split("---\n")[2]
    return provider


def check_console(body: str, expected_exit: int, folder: Path) -> None:
    commands: list[tuple[str, list[str]]] = []
    for line in body.splitlines():
        if line.startswith("$ "):
            commands.append((line[2:], []))
        else:
            commands[-1][1].append(line)
    for number, (command, expected) in enumerate(commands, start=1):
        code, output = run(command, folder)
        assert code == (expected_exit if number == len(commands) else 0), f"{command}\n{output}"
        assert re.fullmatch(as_pattern(expected), output), f"{command}\nprinted\n{output}"


SLOW = (
    "benchmark",
    "first-plan",
    "llm",
    "look-at-a-run",
    "own-domain",
    "own-instruction",
    "own-solver",
    "publish-a-plugin",
    "reading-a-failure",
    "review-prompts",
    "sandbox",
    "screens",
    "steer-the-search",
    "switching-llms",
    "table-top",
    "table-top-task",
    "use-from-python",
    "wrap-a-simulator",
    "write-a-domain",
)
"""Pages whose examples start the program many times, import litellm, simulate an arm, or run tests."""


def _marked(page: Path) -> Any:
    return pytest.param(page, marks=[pytest.mark.slow] if page.stem in SLOW else [], id=page.stem)


@pytest.mark.parametrize("page", [_marked(page) for page in PAGES])
def test_every_example_of_a_page_runs(page: Path, tmp_path: Path, model: Provider) -> None:
    ran = 0
    text = page.read_text(encoding="utf-8").replace(LOCAL, model.root.removeprefix("http://"))
    for block in BLOCK.finditer(text):
        if block["kind"] == "file":
            path = tmp_path / block["value"]
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block["body"], encoding="utf-8")
        elif block["language"] == "console":
            check_console(block["body"], int(block["value"] or 0), tmp_path)
            ran += 1
    assert ran, "the page has no example that runs"


def links(page: Path) -> list[str]:
    return re.findall(r"\]\(([^)#:]+)\)|src=\"([^\":]+)\"", page.read_text(encoding="utf-8"))


@pytest.mark.parametrize("page", [ROOT / "README.md", *PAGES], ids=lambda page: page.stem)
def test_links_lead_somewhere(page: Path) -> None:
    for pair in links(page):
        target = next(filter(None, pair))
        assert (page.parent / target).exists(), target
