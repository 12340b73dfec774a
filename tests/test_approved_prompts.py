"""The prompts of the repository are the approved ones, so that a changed template shows in a diff."""

from pathlib import Path

from typer.testing import CliRunner

from proc3s.cli import app

APPROVED = Path(__file__).parent / "prompts"


def test_every_rendering_is_as_approved() -> None:
    result = CliRunner().invoke(app, ["render-prompt", "--check", str(APPROVED)])
    assert result.exit_code == 0, (
        f"approve with: proc3s render-prompt --check tests/prompts --update\n{result.output}"
    )
    assert len(list(APPROVED.rglob("*.md"))) == 66
